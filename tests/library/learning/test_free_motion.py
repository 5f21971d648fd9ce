"""A network learns from motion without walking: on an arm with friction its error is below half of the observer's."""

import numpy as np
import pytest
from library_settings import ROOT, training_of

from mobnet.estimation.observer import RobotObserver
from mobnet.formats.loading import load_section
from mobnet.formats.robot import RobotTable
from mobnet.kernel.low_pass import filter_in_place
from mobnet.learning.dataset import LimbData
from mobnet.learning.deployed.loading import load_network
from mobnet.learning.features import limb_inputs
from mobnet.learning.job import TrainingJob
from mobnet.learning.train import train_on
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel
from mobnet.simulation.free_run import Numbers, record_motion

LIMB, EVERY = "ARM", 10  # a sample of ten is learned from
TRAIN_S, TEST_S, EPOCHS = 120.0, 10.0, 60
BEGIN = 50  # samples after which network and observer have forgotten that they began


@pytest.fixture
def panda():
    return load_section(ROOT / "configs" / "robots" / "panda.yaml", RobotTable)


@pytest.fixture
def moved(panda, settings):
    """A function (seconds, seed, pushed) -> inputs, residual and true external torque behind the same low-pass."""
    robot, numbers = describe(panda), Numbers(settings.free_motion, settings.plant, settings.rates)
    inputs = limb_inputs(robot.layout, panda.networks[LIMB])

    def make(seconds, seed, pushed):
        log = record_motion(robot, numbers, seconds, seed, ideal=False, pushed=pushed)
        observer = RobotObserver(NominalModel(robot), settings.observer.gain_hz, log.rate_hz, "sample")
        external = filter_in_place(log.truth.tau_ext.copy(), observer.pole)
        found = inputs(log.sensed), observer.residual(log.sensed), external
        return [values[::EVERY].astype(np.float32) for values in found]

    return make


def test_the_error_of_a_network_is_less_than_half_of_the_observers(panda, moved, settings, tmp_path):
    """It learns from free motion, where the residual is the label, and is tried on another motion with pushes."""
    x, residual, _ = moved(TRAIN_S, 1, pushed=False)
    training, limb = training_of(settings, "MOB-Net", "LL"), panda.networks[LIMB]
    network = training.network.model_copy(update={**vars(limb), "hidden": 32, "horizon_steps": 25})
    learning = training.learning.model_copy(update={"stream_s": 1.0, "coarse": (), "batch_size": 16})
    update = {"network": network, "learning": learning, "limb": LIMB, "epochs": EPOCHS, "epoch_samples": None}
    joints, names = panda.layout.limb(LIMB), limb_inputs(panda.layout, limb).names
    data = LimbData(x, residual, ((0, len(x)),), names, joints, settings.rates.data_hz / EVERY)
    train_on(data, TrainingJob(training.model_copy(update=update), 0, 1), tmp_path / "out", tmp_path / "state")

    x, residual, truth = moved(TEST_S, 2, pushed=True)
    estimate = residual - load_network(tmp_path / "out").run_all([x])[0].mean
    zero, observer, learned = (
        np.sqrt(np.square((values - truth)[BEGIN:]).mean(axis=0)) for values in (0 * truth, residual, estimate)
    )
    assert zero.max() > 1.0  # something does push
    assert learned.mean() < 0.5 * observer.mean()
    assert (learned < 0.75 * observer).all()
