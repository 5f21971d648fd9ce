"""An epoch with carried state is what the robot will run."""

import copy

import numpy as np
import pytest
import torch

from mobnet.formats.network import SIZES, NetworkCell
from mobnet.learning.cells import Gru
from mobnet.learning.losses import gaussian_loss
from mobnet.learning.model import LimbNetwork, build_network
from mobnet.learning.optimisation import LAST_STEP, SEQUENCES, Samples, train_epoch, validate
from mobnet.learning.streams import deal, epoch_plan, window_plan

HORIZON = 10


@pytest.fixture
def network():
    torch.manual_seed(0)
    return LimbNetwork(Gru(3, 8), 2, 1e-6)


@pytest.fixture
def samples():
    generator = torch.Generator().manual_seed(0)
    inputs = torch.randn(600, 3, generator=generator)
    return Samples(inputs, inputs[:, :2] - inputs[:, 1:])


def test_validation_in_horizons_equals_one_run_through_each_stream(network, samples):
    """Horizon by horizon and in one run are equivalent."""
    streams = [(0, 200), (200, 400), (400, 600)]
    loss, rmse = validate(network, samples, deal(streams, 3, HORIZON), HORIZON)
    x, target = (tensor.view(3, 200, -1).transpose(0, 1) for tensor in (samples.inputs, samples.targets))
    with torch.no_grad():
        mean, std, _ = network(x, network.fresh_state(3))
    assert loss == pytest.approx(float(gaussian_loss(mean, std, target)), rel=1e-5)
    torch.testing.assert_close(rmse, (mean - target).square().mean(dim=(0, 1)).sqrt())


def test_a_lane_that_enters_a_stream_forgets(network, samples):
    one_lane, _ = validate(network, samples, deal([(0, 300), (300, 600)], 1, HORIZON), HORIZON)
    two_lanes, _ = validate(network, samples, deal([(0, 300), (300, 600)], 2, HORIZON), HORIZON)
    carried, _ = validate(network, samples, deal([(0, 600)], 1, HORIZON), HORIZON)
    assert one_lane == pytest.approx(two_lanes, rel=1e-5)
    assert carried != pytest.approx(two_lanes, rel=1e-5)


@pytest.mark.parametrize("kind", ["GRU", "TCN", "MLP", "LSTM", "constant"])
def test_every_cell_learns_on_streams(kind, samples):
    sizes = {"hidden": 8, "window_steps": 4, "kernel_steps": 2, "dilations": (1, 2), "dropout": 0.1, "head": 8}
    cell = NetworkCell(cell=kind, **{name: sizes[name] for name in SIZES[kind]})
    network = build_network(cell, 3, 2, 1e-6, seed=0)
    samples.targets.add_(1.0)  # what even a constant can learn
    optimizer = torch.optim.Adam(network.parameters(), lr=1e-2)
    plan = epoch_plan([(0, 600)], 100, HORIZON, 4, np.random.default_rng(0))
    losses = [train_epoch(network, optimizer, samples, plan, HORIZON, 1.0)[0].mean() for _ in range(20)]
    assert losses[-1] < losses[0] - 0.3


def test_windows_are_scored_at_their_last_step_from_a_zero_state(network, samples):
    """Each window run by itself is the reference."""
    plan = window_plan([(0, 600)], 100, HORIZON, 5, np.random.default_rng(0))
    loss, rmse = validate(network, samples, plan, HORIZON, LAST_STEP)
    with torch.no_grad():
        runs = [network(samples.inputs[a : a + HORIZON, None], network.fresh_state(1)) for a in plan.rows.ravel()]
    mean, std = (torch.stack([run[i][-1, 0] for run in runs]) for i in (0, 1))
    target = samples.targets[torch.from_numpy(plan.rows.ravel() + HORIZON - 1)]
    assert loss == pytest.approx(float(gaussian_loss(mean, std, target)), rel=1e-5)
    torch.testing.assert_close(rmse, (mean - target).square().mean(dim=0).sqrt())


@pytest.mark.parametrize("sequences", SEQUENCES)
def test_steps_outside_the_loss_teach_nothing(sequences, network, samples):
    """Targets of a window's first steps do not matter to training on windows, and do to training on streams."""
    plan_of, scored = SEQUENCES[sequences]
    plan = plan_of([(0, 600)], 100, HORIZON, 1, np.random.default_rng(0), HORIZON)
    weights = []
    for change in (0.0, 5.0):
        learner, targets, first = copy.deepcopy(network), samples.targets.clone(), int(plan.rows[0, 0])
        targets[first : first + HORIZON - 1] += change
        optimizer = torch.optim.SGD(learner.parameters(), lr=1.0)
        train_epoch(learner, optimizer, Samples(samples.inputs, targets), plan, HORIZON, 1.0, scored)
        weights.append(learner.head.weight.detach())
    assert not torch.equal(weights[0], network.head.weight)
    assert torch.equal(*weights) == (sequences == "windows")


def test_a_clip_of_zero_stops_learning(network, samples):
    optimizer = torch.optim.SGD(network.parameters(), lr=1.0)
    before = network.head.weight.detach().clone()
    _, norms = train_epoch(network, optimizer, samples, deal([(0, 600)], 4, HORIZON), HORIZON, 0.0)
    assert norms.min() > 0
    assert torch.equal(before, network.head.weight)
