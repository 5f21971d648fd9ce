"""Feed-forward of the uncertainty torque: on the leg that swings, against what the model gets wrong."""

import numpy as np
import pytest
from library_settings import library_settings, walk_settings

from mobnet.core.estimator import Estimate
from mobnet.formats.plain import as_plain
from mobnet.reaction.feed_forward import FeedForward, swing_error
from mobnet.reaction.handler import Handler
from mobnet.reaction.loop import columns_of, walk_with
from mobnet.reaction.numbers import ReactionNumbers
from mobnet.simulation.simulator import Simulator

pytestmark = pytest.mark.sim


class Knows:
    """An estimator that takes the same torque for what the model gets wrong at every sample."""

    def __init__(self, layout, torque_nm):
        self.joints, self.torque = layout.names, torque_nm

    def init(self):
        return None

    def step(self, state, sample):
        zero = np.zeros(len(self.joints))
        return None, Estimate(zero, uncertainty=np.full(len(self.joints), self.torque))


@pytest.fixture
def simulator():
    """A robot that walks with force sensors on the plant of section 5.1."""
    simulator = Simulator(walk_settings(library_settings(), "walk_test", "sensor_noise"), 1)
    simulator.start()
    return simulator


def walked(simulator, samples=1500):
    """Return what is recorded of a walk, and the errors of the leg that swings."""
    rows = np.zeros((samples, simulator.width), np.float32)
    errors = np.full((samples, 6), np.nan, np.float32)
    for k in range(samples):
        simulator.run(rows[k : k + 1])
        swing_error(simulator.state, simulator.walker.first, simulator.plant.qpos, errors[k])
    return fields(simulator, rows), errors


def fields(simulator, rows):
    return {name: rows[:, columns] for name, columns in columns_of(simulator.robot.layout).items()}


def test_motors_of_the_leg_that_swings_make_up_for_a_share_of_the_torque(simulator, robot, settings):
    layout = simulator.robot.layout
    handler = Handler(
        robot, as_plain(settings.reaction, ReactionNumbers), settings.walking.foot_spacing_m, {}, "compliant"
    )
    course = walk_with(simulator, Knows(layout, 4.0), handler, 1500, 1500, 1.0, 0.03, feed_forward=0.5)
    seen = fields(simulator, course.rows)
    legs = {side: [layout.actuated.index(joint) for joint in layout.limb(limb)] for side, limb in layout.legs.items()}
    above = [k for k in range(layout.nu) if k not in legs["left"] + legs["right"]]
    for foot, side in enumerate(("left", "right")):
        swings = seen["swing"][:, foot] == 1.0
        assert 100 < swings.sum() < 1400
        added = seen["tau_random"][:, legs[side]]
        assert added[swings].min() == added[swings][5:-5].max() == -2.0
        assert added[~swings].any(axis=1).sum() < 10  # samples within which a swing begins or ends
    assert not seen["tau_random"][:, above].any()
    assert course.power.min() >= 0.0
    assert 10.0 < course.power.mean() < 1000.0


def test_the_error_of_the_leg_that_swings_is_known_while_one_swings(simulator):
    seen, errors = walked(simulator)
    swings = seen["swing"].any(axis=1)
    assert np.isfinite(errors[swings]).all()
    assert np.isnan(errors[~swings]).all()
    assert 0.0 < np.nanmax(np.abs(errors)) < 0.2


def test_a_torque_that_pulls_at_the_leg_is_taken_off_its_error():
    """Joints that something pulls at with -6 N m follow better when the motors make up for it."""
    found = []
    for share in (0.0, 1.0):
        simulator = Simulator(walk_settings(library_settings(), "walk_test", "sensor_noise"), 1)
        simulator.start()
        layout = simulator.robot.layout
        fed = FeedForward.of(simulator, layout.names, share)
        fed.feed(np.full(layout.nv, -6.0))
        fed.torque[:12] -= 6.0  # what pulls acts where the motors do
        _, errors = walked(simulator)
        found.append(np.sqrt(np.nanmean(errors**2)))
    assert found[1] < found[0]
