"""Lanes side by side give what each gives alone, whatever their lengths and wherever a chunk ends."""

import numpy as np
import pytest
import torch

from mobnet.learning.deployed import lanes as lanes_module
from mobnet.learning.deployed.lanes import gru_states, side_by_side

LENGTHS = (300, 1200, 1, 700, 1200)
INPUTS, HIDDEN = 5, 24


def recordings(seed=0):
    rng = np.random.default_rng(seed)
    return [rng.normal(size=(length, INPUTS)).astype(np.float32) for length in LENGTHS]


def summed(state, x):
    """Advance a state (1, B, n_in) that adds up what it sees: exact in whatever order lanes are."""
    sums = state + np.cumsum(x, axis=0, dtype=np.float64)
    return sums[-1:], sums


@pytest.mark.parametrize("chunk", [1, 7, 500, 5000])
def test_every_lane_starts_afresh_and_ends_where_it_ends(chunk, monkeypatch):
    monkeypatch.setattr(lanes_module, "CHUNK", chunk)
    given = recordings()
    found = side_by_side(given, np.zeros((1, len(given), INPUTS)), summed)
    for x, output in zip(given, found, strict=True):
        np.testing.assert_allclose(output, np.cumsum(x, axis=0, dtype=np.float64), rtol=1e-12, atol=1e-12)


def test_states_are_those_of_torchs_gru_and_hardly_depend_on_the_other_lanes():
    torch.manual_seed(0)
    module = torch.nn.GRU(INPUTS, HIDDEN)
    weights = [tensor.detach().numpy() for tensor in module.parameters()]

    def advance(state, x):
        return gru_states(weights, state, x)

    given = recordings()
    together = side_by_side(given, np.zeros((1, len(given), HIDDEN), np.float32), advance)
    for x, found in zip(given, together, strict=True):
        (alone,) = side_by_side([x], np.zeros((1, 1, HIDDEN), np.float32), advance)
        with torch.no_grad():
            expected = module(torch.from_numpy(x)[:, None])[0][:, 0].numpy()
        np.testing.assert_allclose(found, alone, rtol=0, atol=2e-6)
        np.testing.assert_allclose(found, expected, rtol=0, atol=2e-6)
