"""The fast GRU computes what torch's does, forward and back."""

from __future__ import annotations

import numpy as np
import pytest
import torch
from torch import Tensor, nn

from mobnet.learning.gru import rational_tanh, run_gru

STEPS, LANES, INPUTS, HIDDEN = 50, 5, 30, 24


@pytest.fixture
def cell() -> nn.GRU:
    torch.manual_seed(0)
    return nn.GRU(INPUTS, HIDDEN)


@pytest.fixture
def stretch() -> tuple[Tensor, Tensor]:
    generator = torch.Generator().manual_seed(1)
    return torch.randn(STEPS, LANES, INPUTS, generator=generator), torch.randn(1, LANES, HIDDEN, generator=generator)


def test_tanh_is_within_a_few_roundings() -> None:
    x = np.linspace(-12, 12, 100_001).astype(np.float32)
    y = np.array([rational_tanh(value) for value in x])
    np.testing.assert_allclose(y, np.tanh(x.astype(np.float64)), rtol=1e-6, atol=1e-7)
    assert np.isnan(rational_tanh(np.float32(np.nan)))


def test_states_are_those_of_torch(cell: nn.GRU, stretch: tuple[Tensor, Tensor]) -> None:
    """Torch's own GRU is the reference."""
    states, last = run_gru(cell, *stretch)
    expected, expected_last = cell(*stretch)
    torch.testing.assert_close(states, expected, rtol=1e-5, atol=2e-6)
    torch.testing.assert_close(last, expected_last, rtol=1e-5, atol=2e-6)


def test_gradients_are_those_of_torch(cell: nn.GRU, stretch: tuple[Tensor, Tensor]) -> None:
    """Torch's own GRU is the reference."""
    weight = torch.randn(STEPS, LANES, HIDDEN, generator=torch.Generator().manual_seed(2))
    gradients = []
    for run in (lambda: run_gru(cell, *stretch), lambda: cell(*stretch)):
        cell.zero_grad()
        (run()[0] * weight).sum().backward()
        gradients.append([parameter.grad.clone() for parameter in cell.parameters()])
    for ours, theirs in zip(*gradients, strict=True):
        torch.testing.assert_close(ours, theirs, rtol=1e-4, atol=1e-5 * float(theirs.abs().max()))


def test_back_propagation_is_truncated_at_the_given_state(cell: nn.GRU, stretch: tuple[Tensor, Tensor]) -> None:
    x, state = stretch
    first, carried = run_gru(cell, x[:25], state)
    second, _ = run_gru(cell, x[25:], carried)
    whole, _ = run_gru(cell, x, state)
    torch.testing.assert_close(torch.cat([first, second]), whole)
    second.sum().backward()
    assert all(parameter.grad is not None for parameter in cell.parameters())


def test_nan_is_not_swallowed(cell: nn.GRU, stretch: tuple[Tensor, Tensor]) -> None:
    x, state = stretch
    x[3, 1, 0] = torch.nan
    states, _ = run_gru(cell, x, state)
    assert torch.isnan(states[3:, 1]).all()
    assert torch.isfinite(states[:, 0]).all()


def test_given_tensors_are_left_alone(cell: nn.GRU, stretch: tuple[Tensor, Tensor]) -> None:
    before = [tensor.clone() for tensor in (*stretch, *cell.parameters())]
    run_gru(cell, *stretch)[0].sum().backward()
    assert all(torch.equal(a, b) for a, b in zip(before, (*stretch, *cell.parameters()), strict=True))
