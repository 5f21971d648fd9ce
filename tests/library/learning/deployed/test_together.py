"""GRU networks in one call, beside networks of other kinds."""

import numpy as np
import pytest
from made_weights import weights

from mobnet.formats.network import NetworkCell
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.learning.deployed.loading import deployed
from mobnet.learning.features import signal_names, signals

SAMPLES = 2000
# cell, inputs, joints: numbers of units and inputs that no vector register divides, as those of Table 1
MADE = {
    "first": (NetworkCell(cell="GRU", hidden=150), 30, 6),
    "other": (NetworkCell(cell="LSTM", hidden=16), 20, 2),
    "wide": (NetworkCell(cell="GRU", hidden=200), 74, 8),
    "same": (NetworkCell(cell="constant"), 9, 2),
    "small": (NetworkCell(cell="GRU", hidden=13), 5, 3),
}


def networks_of(kinds, layout):
    """Return networks with random weights, each with random inputs of the robot."""
    names, made, draw = signal_names(layout), [], np.random.default_rng(1)
    for seed, kind in enumerate(kinds):
        tensors, note = weights(*MADE[kind], seed)
        inputs = [names[k] for k in draw.permutation(len(names))[: len(note.inputs)]]
        made.append(deployed(tensors, note.model_copy(update={"inputs": inputs})))
    return made


@pytest.mark.parametrize("kinds", [("first", "wide", "small"), tuple(MADE), ("same",), ("small",)])
def test_together_networks_predict_to_the_bit_what_each_predicts_by_itself(kinds, layout, made_up):
    sensed = made_up(3, SAMPLES / 1000.0).sensed
    x, where = signals(sensed), signal_names(layout)
    networks = networks_of(kinds, layout)
    columns = [[where.index(name) for name in network.input_names] for network in networks]
    together = LimbNetworks(networks, layout)
    state, states = together.init(), [network.init() for network in networks]
    for k in range(SAMPLES):
        state, found = together.step(state, sensed[k])
        means, stds = [], []
        for i, network in enumerate(networks):
            states[i], expected = network.step(states[i], x[k][columns[i]])
            means.append(expected.mean)
            stds.append(expected.std)
        np.testing.assert_array_equal(found.mean, np.concatenate(means))
        np.testing.assert_array_equal(found.std, np.concatenate(stds))
    assert found.mean.dtype == found.std.dtype == np.float32
    assert np.ptp(found.mean) > 0.0


def test_a_step_leaves_the_state_that_it_gets(layout, made_up):
    """An estimator's state is explicit: the same sample from the same state gives the same."""
    sensed = made_up(3, 0.01).sensed
    together = LimbNetworks(networks_of(tuple(MADE), layout), layout)
    state, _ = together.step(together.init(), sensed[0])
    first = together.step(state, sensed[1])[1].mean.copy()
    together.step(together.step(state, sensed[2])[0], sensed[3])
    np.testing.assert_array_equal(together.step(state, sensed[1])[1].mean, first)
