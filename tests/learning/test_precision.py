"""The number format of products: who gets which, and what a product of either is."""

from __future__ import annotations

import pytest
import torch

from mobnet.core.errors import ConfigError
from mobnet.learning.precision import PRECISIONS, UNITS, memory, precision_name, precision_of, product

CPU, GPU = torch.device("cpu"), torch.device("cuda")


def pretend(monkeypatch: pytest.MonkeyPatch, unit: str | None) -> None:
    """Let this machine's CPU have one unit, or none."""
    monkeypatch.setattr(torch.cpu, "get_capabilities", lambda: {name: name == unit for name in (*UNITS, "avx2")})


@pytest.mark.parametrize("unit", UNITS)
def test_auto_is_bfloat16_where_the_cpu_computes_in_it(monkeypatch: pytest.MonkeyPatch, unit: str) -> None:
    pretend(monkeypatch, unit)
    assert precision_of("auto", CPU) == torch.bfloat16


def test_auto_is_float32_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    pretend(monkeypatch, None)
    assert precision_of("auto", CPU) == torch.float32
    monkeypatch.setattr(torch.cpu, "get_capabilities", dict)  # a CPU of another kind tells other things
    assert precision_of("auto", CPU) == torch.float32


@pytest.mark.parametrize("name", PRECISIONS)
def test_a_named_format_is_that_format_on_any_cpu(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    for unit in (*UNITS, None):
        pretend(monkeypatch, unit)
        assert precision_name(precision_of(name, CPU)) == name


@pytest.mark.parametrize("setting", ["auto", *PRECISIONS])
def test_a_gpu_computes_in_float32(setting: str) -> None:
    assert precision_of(setting, GPU) == torch.float32


def test_error_names_the_accepted_ones() -> None:
    with pytest.raises(ConfigError, match=r"half.*auto, bfloat16, float32"):
        precision_of("half", CPU)


@pytest.mark.parametrize("precision", PRECISIONS.values())
def test_products_are_those_of_the_rounded_factors(precision: torch.dtype) -> None:
    generator = torch.Generator().manual_seed(0)
    a, b = (torch.randn(shape, generator=generator).to(precision) for shape in ((7, 40), (5, 40)))
    expected = (a.double() @ b.double().T).float()
    found, given = product(a, b.T), torch.empty(7, 5, dtype=precision)
    product(a, b.T, out=given)
    unit = torch.finfo(precision).eps
    assert found.dtype == precision
    assert torch.equal(found, given)
    torch.testing.assert_close(found.float(), expected, rtol=unit, atol=10 * torch.finfo(torch.float32).eps)


@pytest.mark.parametrize("precision", PRECISIONS.values())
def test_memory_is_the_tensors_own(precision: torch.dtype) -> None:
    tensor = torch.ones(3, dtype=precision)
    memory(tensor)[1] = 0
    assert tensor.tolist() == [1.0, 0.0, 1.0]
