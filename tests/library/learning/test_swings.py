"""Fine-tuning: a training that begins with a network, and learns from the free swings of a leg alone."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from library_settings import network_of

from mobnet.core.errors import DataError
from mobnet.core.files import WEIGHTS
from mobnet.core.store import read_array
from mobnet.learning.cells import Gru
from mobnet.learning.dataset import load_limb_data
from mobnet.learning.deployed.tensors import GRU_TENSORS
from mobnet.learning.deployed.weights import read_weights
from mobnet.learning.job import TrainingJob
from mobnet.learning.model import LimbNetwork
from mobnet.learning.optimisation import Samples, train_epoch
from mobnet.learning.streams import deal
from mobnet.learning.swings import free_rows, hanging
from mobnet.learning.trainer import Trainer

RATE_HZ, MARGINS = 1000.0, (0.09, 0.03)


def test_a_foot_hangs_between_the_ends_of_its_swing():
    """Two swings; the second begins with a span, the third is too short to be sure of."""
    swing = np.zeros(1000)
    swing[100:400] = swing[500:800] = swing[900:950] = 1
    free = hanging(swing, [(0, 500), (500, 1000)], RATE_HZ, MARGINS)
    assert np.flatnonzero(np.diff(free, prepend=False, append=False)).tolist() == [190, 370, 590, 770]


@pytest.fixture
def walked(tmp_path, made_up, write_pair):
    """A recording in which the left foot swings from 0.5 to 1.0 s and from 2.5 to 3.0 s, the right one never."""
    recording = made_up(0, 4.0)
    swing = np.zeros_like(recording.sensed.swing)
    rows = np.arange(len(swing)) / recording.rate_hz % 2.0
    swing[(rows >= 0.5) & (rows < 1.0), 0] = 1.0
    return write_pair(tmp_path, replace(recording, sensed=replace(recording.sensed, swing=swing)))


def test_a_swing_that_is_shorter_than_its_margins_leaves_nothing_also_at_the_very_beginning():
    """A row before the first one would be counted from the end."""
    swing = np.zeros(40)
    swing[:3] = swing[20:24] = 1.0
    assert not hanging(swing, [(0, 40)], 1000.0, (0.001, 0.01)).any()
    assert not hanging(swing, [(0, 40)], 1000.0, (0.01, 0.001)).any()


def test_free_rows_are_those_of_the_leg_of_the_joints(walked, layout):
    left = free_rows(walked[0], layout, layout.limb("LL"), MARGINS)
    assert left.mean() == pytest.approx(2 * (0.5 - 0.09 - 0.03) / 4.0, abs=0.02)
    assert not free_rows(walked[0], layout, layout.limb("RL"), MARGINS).any()
    with pytest.raises(DataError, match="accepted: joints of one leg"):
        free_rows(walked[0], layout, layout.limb("W"), MARGINS)


def test_the_target_of_a_free_swing_is_the_residual_whatever_the_label_says(walked, settings, layout):
    recording, residual = walked
    limb = network_of(settings, "MOB-Net", "LL")
    data = load_limb_data(layout, limb, "uncertainty", [recording], [residual], margins=MARGINS)
    free = free_rows(recording, layout, layout.limb("LL"), MARGINS)
    np.testing.assert_array_equal(np.isnan(data.targets), np.repeat(~free[:, None], 6, axis=1))
    expected = read_array(residual, [f"r.{joint}" for joint in layout.limb("LL")])[0]
    np.testing.assert_array_equal(data.targets[free], expected[free])


def test_only_the_first_seconds_are_read(small):
    """The second recording is left out whole, and the first one cut within its second segment."""
    training = small.training()
    whole = small.data(training)
    given = small.layout, training.network, training.target, small.recordings, small.residuals
    data = load_limb_data(*given, first_s=3.0)
    rows = round(3.0 * data.rate_hz)
    assert len(data.inputs) == len(data.targets) == rows < len(whole.inputs) // 2
    assert data.segments[-1][1] == rows
    assert data.segments[:-1] == whole.segments[: len(data.segments) - 1]
    np.testing.assert_array_equal(data.inputs, whole.inputs[:rows])
    longer = load_limb_data(*given, first_s=1000.0)
    assert (longer.segments, longer.digest) == (whole.segments, whole.digest)


def test_nothing_is_learned_where_the_target_is_unknown():
    """A horizon without a known target changes no weight; the state runs through it."""
    torch.manual_seed(0)
    inputs = torch.randn(400, 3)
    targets = inputs[:, :2].clone()
    targets[100:300] = torch.nan
    samples, plan = Samples(inputs, targets, partial=True), deal([(0, 400)], 1, 100)
    losses, norms = train_epoch(*fresh(), samples, plan, 100, 1.0)
    assert len(losses) == len(norms) == 2  # of four horizons
    assert torch.isfinite(losses).all()
    known = train_epoch(*fresh(), Samples(inputs[:100], targets[:100]), deal([(0, 100)], 1, 100), 100, 1.0)[0]
    torch.testing.assert_close(losses[:1], known)
    with pytest.raises(DataError, match="no target of the training data is known"):
        train_epoch(*fresh(), Samples(inputs, torch.full_like(targets, torch.nan), partial=True), plan, 100, 1.0)


def fresh():
    """Return a network, always the same, and its optimizer."""
    torch.manual_seed(1)
    network = LimbNetwork(Gru(3, 8), 2, 1e-6)
    return network, torch.optim.Adam(network.parameters(), lr=1e-2)


@pytest.fixture
def trained(small, tmp_path):
    return small.train(small.training(epochs=2), tmp_path / "first") / WEIGHTS


def test_a_fine_tuning_begins_with_weights_and_scales_of_its_network(small, trained, data):
    """And no draw of its own: two seeds begin alike."""
    tensors, _ = read_weights(trained)
    data.inputs[:] += 1.0  # other data, the same scales
    trainers = [Trainer(TrainingJob(small.training(), seed, 1), data, trained) for seed in (0, 1)]
    for trainer in trainers:
        weights = trainer.network.state_dict()
        assert all(np.array_equal(weights[name].numpy(), tensors[name]) for name in GRU_TENSORS)
        np.testing.assert_array_equal(trainer.schedule.scales[0].mean, tensors["input.mean"])
        np.testing.assert_array_equal(trainer.schedule.scales[1].std, tensors["target.std"])
    assert trainers[0].schedule.fingerprint != Trainer(TrainingJob(small.training(), 0, 1), data).schedule.fingerprint


def test_a_network_of_another_size_is_refused(small, trained, data):
    training = small.training()
    larger = training.model_copy(update={"network": training.network.model_copy(update={"hidden": 17})})
    with pytest.raises(DataError, match=r"cell: \('GRU', 16\) is not accepted; accepted: \('GRU', 17\)"):
        Trainer(TrainingJob(larger, 0, 1), data, trained)
    with pytest.raises(DataError, match="joints: "):
        Trainer(TrainingJob(small.training(limb="RL"), 0, 1), small.data(small.training(limb="RL")), trained)


def test_swings_alone_train_and_calibrate_a_network(small, trained, walked, tmp_path):
    training = small.training(epochs=2, labels="swing", batch_size=2, validation_share=0.5)
    files = {"recordings": [walked[0]], "residuals": [walked[1]], "margins": MARGINS}
    tensors, _ = read_weights(small.train(training, tmp_path / "tuned", trained, **files) / WEIGHTS)
    assert all(np.isfinite(tensor).all() for tensor in tensors.values())
