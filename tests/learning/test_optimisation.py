"""An epoch with carried state is what the robot will run."""

from __future__ import annotations

import numpy as np
import pytest
import torch

from mobnet.learning.cells import Gru
from mobnet.learning.loss import gaussian_loss
from mobnet.learning.model import LimbNetwork
from mobnet.learning.optimisation import Samples, train_epoch, validate
from mobnet.learning.streams import deal, epoch_plan

HORIZON = 10


@pytest.fixture
def network() -> LimbNetwork:
    torch.manual_seed(0)
    return LimbNetwork(Gru(3, 8), 2, 1e-6)


@pytest.fixture
def samples() -> Samples:
    generator = torch.Generator().manual_seed(0)
    inputs = torch.randn(600, 3, generator=generator)
    return Samples(inputs, inputs[:, :2] - inputs[:, 1:])


def test_validation_in_horizons_equals_one_run_through_each_stream(network: LimbNetwork, samples: Samples) -> None:
    """Horizon by horizon and in one run are equivalent."""
    streams = [(0, 200), (200, 400), (400, 600)]
    loss, rmse = validate(network, samples, deal(streams, 3, HORIZON), HORIZON)
    x, target = (tensor.view(3, 200, -1).transpose(0, 1) for tensor in (samples.inputs, samples.targets))
    with torch.no_grad():
        mean, std, _ = network(x, network.fresh_state(3))
    assert loss == pytest.approx(float(gaussian_loss(mean, std, target)), rel=1e-5)
    torch.testing.assert_close(rmse, (mean - target).square().mean(dim=(0, 1)).sqrt())


def test_a_lane_that_enters_a_stream_forgets(network: LimbNetwork, samples: Samples) -> None:
    one_lane, _ = validate(network, samples, deal([(0, 300), (300, 600)], 1, HORIZON), HORIZON)
    two_lanes, _ = validate(network, samples, deal([(0, 300), (300, 600)], 2, HORIZON), HORIZON)
    carried, _ = validate(network, samples, deal([(0, 600)], 1, HORIZON), HORIZON)
    assert one_lane == pytest.approx(two_lanes, rel=1e-5)
    assert carried != pytest.approx(two_lanes, rel=1e-5)


def test_training_lowers_the_loss(network: LimbNetwork, samples: Samples) -> None:
    optimizer = torch.optim.Adam(network.parameters(), lr=1e-2)
    rng = np.random.default_rng(0)
    losses = [
        train_epoch(network, optimizer, samples, epoch_plan([(0, 600)], 100, HORIZON, 4, rng), HORIZON, 1.0)[0]
        for _ in range(20)
    ]
    assert losses[-1] < losses[0] - 0.3


def test_a_clip_of_zero_stops_learning(network: LimbNetwork, samples: Samples) -> None:
    optimizer = torch.optim.SGD(network.parameters(), lr=1.0)
    before = network.head.weight.detach().clone()
    _, norm = train_epoch(network, optimizer, samples, deal([(0, 600)], 4, HORIZON), HORIZON, 0.0)
    assert norm > 0
    assert torch.equal(before, network.head.weight)
