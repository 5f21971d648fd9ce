"""The number format of products follows the setting, the CPU and the device."""

import pytest
import torch

from mobnet.learning.precision import PRECISIONS, UNITS, precision_name, precision_of

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
