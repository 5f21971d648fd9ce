"""The filter of the base's velocity converges to what the sole that rests says, and integrates in between."""

import numpy as np
import pytest

from mobnet.control.base_state import update_base
from mobnet.control.kinematics import update

TICK_S = 0.0005
DRIFT = np.array([0.1, -0.05, 0.02])  # error of the base velocity at the start [m/s]


def run(walker, q, v, acc, seconds):
    for _ in range(round(seconds / TICK_S)):
        update(walker.tree, q, v, walker.gravity, walker.pose)
        update_base(walker, acc, TICK_S, q, v)


@pytest.fixture
def standing(robot):
    q, v = np.zeros(robot.layout.nq), np.zeros(robot.layout.nv)
    q[3:7] = [np.cos(0.4), 0, 0, np.sin(0.4)]
    return q, v


def test_error_decays_with_the_time_constant(walker, standing):
    """The reference is the closed form of a first-order decay; both soles say the same of a robot that stands."""
    q, v = standing
    v[:3] = DRIFT
    run(walker, q, v, np.array([0, 0, walker.gravity]), 0.5)
    left = np.exp(-0.5 / walker.par.base_time_constant_s)
    np.testing.assert_allclose(v[:3], DRIFT * left, rtol=2e-3)
    np.testing.assert_allclose(q[:3], DRIFT * walker.par.base_time_constant_s * (1 - left), rtol=2e-3)


def test_acceleration_is_turned_into_the_world(walker, standing):
    """The closed form is the rotated acceleration, which is held back with the time constant."""
    q, v = standing
    run(walker, q, v, np.array([1.0, 0, walker.gravity]), 0.1)
    time_constant = walker.par.base_time_constant_s
    speed = time_constant * (1 - np.exp(-0.1 / time_constant))
    np.testing.assert_allclose(v[:3], [speed * np.cos(0.8), speed * np.sin(0.8), 0], rtol=1e-3, atol=1e-12)


@pytest.mark.parametrize("moving", [0, 1])
@pytest.mark.parametrize("speed", [0.3, 3.0])
def test_the_sole_that_rests_decides(walker, standing, moving, speed):
    """A leg that swings hardly enters, from either side: its share is the fourth power of the ratio of speeds."""
    q, v = standing
    v[6 + walker.first[moving] + 2] = speed  # hip pitch [rad/s]; the sole moves by 0.86 m for each radian
    run(walker, q, v, np.array([0, 0, walker.gravity]), 0.1)
    share = (walker.par.base_still_speed_m_s / (0.86 * speed)) ** 4
    assert np.abs(v[:3]).max() < 1.1 * share * 0.86 * speed * 0.1 / walker.par.base_time_constant_s


def test_a_base_that_is_far_off_finds_back_while_a_leg_swings(walker, standing):
    """The foot that rests seems to move then, and the other one nearer to rest; later steps bring it back."""
    q, v = standing
    hips = 6 + walker.first + 2
    v[:3] = [0.3, 0.0, 0.0]
    for k in range(8):
        v[hips] = np.array([1.5, 0.0]) if k % 2 else np.array([0.0, -1.5])  # [rad/s]
        run(walker, q, v, np.array([0, 0, walker.gravity]), 0.7)
    assert np.abs(v[:3]).max() < 0.01


def test_foot_that_rolls_about_its_sole_s_centre_counts_as_still(walker, standing):
    """The ankle of such a foot moves; the sole's centre has zero velocity."""
    q, v = standing
    update(walker.tree, q, v, walker.gravity, walker.pose)
    foot, rolling = walker.feet[0], np.array([0.5, -0.8, 0.2])
    walker.pose.omega[foot] = rolling
    walker.pose.velocity[foot] = -np.cross(rolling, walker.pose.rotation[foot] @ walker.sole)
    update_base(walker, np.array([0, 0, walker.gravity]), TICK_S, q, v)
    np.testing.assert_allclose(v, 0, atol=1e-14)
