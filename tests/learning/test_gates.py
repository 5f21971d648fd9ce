"""One step of the gates: tanh and the two number formats; test_gru.py compares whole steps with torch's."""

import numpy as np
import pytest
import torch

from mobnet.learning.gates import rational_tanh, read, write
from mobnet.learning.gru import memory

VALUES = torch.tensor([0.0, -0.0, 1.0, 1.00390625, 1.01171875, -3.14159, 3e-39, 65504.0, torch.inf, -torch.inf])


def test_tanh_is_within_a_few_roundings() -> None:
    x = np.linspace(-12, 12, 100_001).astype(np.float32)
    y = np.array([rational_tanh(value) for value in x])
    np.testing.assert_allclose(y, np.tanh(x.astype(np.float64)), rtol=1e-6, atol=1e-7)
    assert np.isnan(rational_tanh(np.float32(np.nan)))


@pytest.mark.parametrize("precision", [torch.float32, torch.bfloat16])
def test_numbers_are_rounded_as_torch_rounds_them(precision: torch.dtype) -> None:
    """Halves between two bfloat16 numbers, 1.00390625 and 1.01171875, go to the even one."""
    values = torch.cat([VALUES, torch.randn(1000, generator=torch.Generator().manual_seed(0))])
    rounded = torch.empty(len(values), dtype=precision)
    array = memory(rounded)
    for j, value in enumerate(values.numpy()):
        write(array, j, value)
    assert torch.equal(rounded, values.to(precision))
    assert np.array_equal([read(array, j) for j in range(len(values))], rounded.float().numpy())


def test_nan_is_kept() -> None:
    array = memory(torch.zeros(1, dtype=torch.bfloat16))
    write(array, 0, np.float32(np.nan))
    assert np.isnan(read(array, 0))
