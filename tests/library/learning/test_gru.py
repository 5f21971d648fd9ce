"""The fast GRU computes what torch's does, forward and back, in float32 and, within its rounding, in bfloat16."""

import pytest
import torch
from torch import nn

from mobnet.learning.gru import run_gru

STEPS, LANES, INPUTS, HIDDEN = 50, 5, 30, 24


@pytest.fixture
def cell():
    torch.manual_seed(0)
    return nn.GRU(INPUTS, HIDDEN)


@pytest.fixture
def stretch():
    generator = torch.Generator().manual_seed(1)
    return torch.randn(STEPS, LANES, INPUTS, generator=generator), torch.randn(1, LANES, HIDDEN, generator=generator)


@pytest.fixture(params=[torch.float32, torch.bfloat16], ids=["float32", "bfloat16"])
def precision(request):
    return request.param


def run(cell, stretch, precision):
    with torch.autocast("cpu", precision, enabled=precision != torch.float32):
        return run_gru(cell, *stretch)


def outcome(cell, states):
    """Return the states and the gradients of some loss of them."""
    weight = torch.randn(states.shape, generator=torch.Generator().manual_seed(2))
    cell.zero_grad()
    (states * weight.to(states.device)).sum().backward()
    # Copies: a cell that moves to a GPU takes its gradients along.
    return [states.detach().cpu(), *(parameter.grad.cpu().clone() for parameter in cell.parameters())]


def distance(found, expected):
    """Return the norm of a difference over that of what is expected."""
    return float((found - expected).norm() / expected.norm())


def test_states_are_those_of_torch(cell, stretch):
    states, last = run_gru(cell, *stretch)
    expected, expected_last = cell(*stretch)
    torch.testing.assert_close(states, expected, rtol=1e-5, atol=2e-6)
    torch.testing.assert_close(last, expected_last, rtol=1e-5, atol=2e-6)


def test_gradients_are_those_of_torch(cell, stretch):
    found, expected = (outcome(cell, states) for states in (run_gru(cell, *stretch)[0], cell(*stretch)[0]))
    for ours, theirs in zip(found[1:], expected[1:], strict=True):
        torch.testing.assert_close(ours, theirs, rtol=1e-4, atol=1e-5 * float(theirs.abs().max()))


def test_bfloat16_is_within_its_rounding_of_float32(cell, stretch):
    """What enters a product is rounded by at most 1/256 of it; half of that is left in the gradients.

    Inputs, gates and states stay exact: rounded too, as by torch's own autocast, they put states off by .4 %.
    """
    found, expected = (outcome(cell, run(cell, stretch, p)[0]) for p in (torch.bfloat16, torch.float32))
    assert 1e-5 < distance(found[0], expected[0]) < 0.0015
    torch.testing.assert_close(found[0], expected[0], rtol=0, atol=0.01)
    assert all(1e-5 < distance(ours, theirs) < 0.005 for ours, theirs in zip(found[1:], expected[1:], strict=True))


def test_states_keep_more_than_the_products_have(cell, stretch):
    """A gate that is almost shut lets a state move by less than bfloat16 resolves; the state has to keep that."""
    states, last = run(cell, stretch, torch.bfloat16)
    assert states.dtype == last.dtype == torch.float32
    with torch.no_grad():
        cell.bias_ih_l0[HIDDEN : 2 * HIDDEN] = 12.0  # update gate: 6e-6 is let through
        states, _ = run(cell, stretch, torch.bfloat16)
        expected, _ = run(cell, stretch, torch.float32)
    moved, expected = states[-1] - stretch[1][0], expected[-1] - stretch[1][0]
    assert distance(moved, expected) < 0.05


def test_back_propagation_is_truncated_at_the_given_state(cell, stretch, precision):
    x, state = stretch
    first, carried = run(cell, (x[:25], state), precision)
    second, _ = run(cell, (x[25:], carried), precision)
    whole, _ = run(cell, stretch, precision)
    torch.testing.assert_close(torch.cat([first, second]), whole)
    second.sum().backward()
    assert all(parameter.grad is not None for parameter in cell.parameters())


def test_nan_is_not_swallowed(cell, stretch, precision):
    x, state = stretch
    x[3, 1, 0] = torch.nan
    states, _ = run(cell, (x, state), precision)
    assert torch.isnan(states[3:, 1]).all()
    assert torch.isfinite(states[:, 0]).all()


def test_given_tensors_are_left_alone(cell, stretch, precision):
    before = [tensor.clone() for tensor in (*stretch, *cell.parameters())]
    run(cell, stretch, precision)[0].sum().backward()
    assert all(torch.equal(a, b) for a, b in zip(before, (*stretch, *cell.parameters()), strict=True))


def test_the_way_back_can_be_gone_twice(cell, stretch, precision):
    """Nothing kept for it is overwritten."""
    loss = run(cell, stretch, precision)[0].square().sum()
    first = torch.autograd.grad(loss, list(cell.parameters()), retain_graph=True)
    second = torch.autograd.grad(loss, list(cell.parameters()))
    assert all(torch.equal(a, b) for a, b in zip(first, second, strict=True))


@pytest.mark.gpu
@pytest.mark.skipif(not torch.cuda.is_available(), reason="no GPU here")
def test_a_gpu_is_within_the_same_bound(cell, stretch):
    """cuDNN may compute the products in TF32, with three bits more than bfloat16."""
    expected = outcome(cell, run_gru(cell, *stretch)[0])
    states, _ = run_gru(cell.cuda(), *(tensor.cuda() for tensor in stretch))
    assert all(distance(a, b) < 0.005 for a, b in zip(outcome(cell, states), expected, strict=True))
