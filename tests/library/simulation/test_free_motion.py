"""A random motion of any robot stays within its ranges, speeds and torques and clear of itself, and is smooth."""

from dataclasses import replace

import numpy as np
import pytest

from mobnet.core.errors import SimulationError
from mobnet.simulation.free_motion import TableModel, bounds_of, plan_motion, speeds_of, whole_state
from mobnet.simulation.self_collision import Clearance

SECONDS, GRAVITY = 30.0, 9.81
FINE = np.arange(0.0, SECONDS, 0.05)


@pytest.fixture
def planned(imported, settings):
    return plan_motion(imported, settings.free_motion, SECONDS, GRAVITY, np.random.default_rng(3))


def test_a_motion_keeps_to_what_the_robot_can_do(imported, planned, settings):
    section = settings.free_motion
    low, high = bounds_of(imported, section.span_share)
    q, v, a = (planned(FINE, order) for order in range(3))
    assert (q >= low - 1e-9).all()
    assert (q <= high + 1e-9).all()
    assert (np.abs(v) <= speeds_of(imported, section) + 1e-9).all()
    table, states = TableModel(imported, GRAVITY), [whole_state(imported, angles) for angles in q]
    for (place, rate), own, acceleration in zip(states, v, a, strict=True):
        rate[-len(own) :] = own
        torque = np.abs(table.torque(place, rate, acceleration)) / imported.torque_limits
        assert torque.max() < section.torque_share * 1.1  # looked at 7 times in a stretch, not everywhere


def test_a_motion_uses_the_room_that_it_has(imported, planned):
    low, high = bounds_of(imported, 1.0)
    used = np.ptp(planned(FINE), axis=0) / (high - low)
    assert np.median(used) > 0.25
    assert (used > 0.1).all()


def test_a_robot_with_shapes_stays_clear_of_itself(imported, planned, settings):
    states = np.array([whole_state(imported, angles)[0] for angles in planned(FINE)])
    assert Clearance(imported).nearest(states).min() > settings.free_motion.clearance_m / 2


def test_a_motion_begins_at_rest_and_depends_on_its_seed_alone(imported, planned, settings):
    np.testing.assert_allclose(planned(0.0, 1), 0.0, atol=1e-12)
    again, different = (
        plan_motion(imported, settings.free_motion, SECONDS, GRAVITY, np.random.default_rng(seed)) for seed in (3, 4)
    )
    np.testing.assert_array_equal(again(FINE), planned(FINE))
    assert np.abs(different(FINE) - planned(FINE)).max() > 0.5


def test_a_posture_that_no_motor_holds_is_named(arm, settings):
    weak = tuple(joint.model_copy(update={"torque_limit": 1.0}) for joint in arm.joints)
    with pytest.raises(
        SimulationError, match=r"posture is not accepted as a start: J1 takes .* times the accepted share"
    ):
        plan_motion(replace(arm, joints=weak), settings.free_motion, 1.0, GRAVITY, np.random.default_rng(0))
