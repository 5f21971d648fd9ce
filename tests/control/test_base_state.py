"""The filter of the base's velocity converges to what the standing feet say, and integrates in the air."""

import numpy as np
import pytest

from mobnet.control.base_state import update_base
from mobnet.control.kinematics import update
from mobnet.control.walker import Walker
from mobnet.robot.description import RobotDescription

TICK_S = 0.0005
DRIFT = np.array([0.1, -0.05, 0.02])  # error of the base velocity at the start [m/s]


def run(walker: Walker, q: np.ndarray, v: np.ndarray, loads: list[float], acc: np.ndarray, seconds: float) -> None:
    """Advance the filter; the joints stand still."""
    for _ in range(round(seconds / TICK_S)):
        update(walker.tree, q, v, walker.gravity, walker.pose)
        update_base(walker, np.array(loads), acc, TICK_S, q, v)


@pytest.fixture
def standing(robot: RobotDescription) -> tuple[np.ndarray, np.ndarray]:
    q, v = np.zeros(robot.layout.nq), np.zeros(robot.layout.nv)
    q[3:7] = [np.cos(0.4), 0, 0, np.sin(0.4)]
    v[:3] = DRIFT
    return q, v


@pytest.mark.parametrize("loads", [[500.0, 500.0], [900.0, 0.0]])
def test_error_decays_with_the_time_constant_on_loaded_feet(walker: Walker, standing: tuple, loads: list) -> None:
    """The reference is the closed form of a first-order decay."""
    q, v = standing
    run(walker, q, v, loads, np.array([0, 0, walker.gravity]), 0.5)
    left = np.exp(-0.5 / walker.par.base_time_constant_s)
    np.testing.assert_allclose(v[:3], DRIFT * left, rtol=2e-3)
    np.testing.assert_allclose(q[:3], DRIFT * walker.par.base_time_constant_s * (1 - left), rtol=2e-3)


@pytest.mark.parametrize("loads", [[0.0, 0.0], [-30.0, -1.0]])
def test_free_fall_is_integrated_without_feet(walker: Walker, standing: tuple, loads: list) -> None:
    """The closed form is -g t."""
    q, v = standing
    run(walker, q, v, loads, np.zeros(3), 0.2)
    np.testing.assert_allclose(v[:3], DRIFT + [0, 0, -walker.gravity * 0.2], atol=1e-10)


def test_acceleration_is_turned_into_the_world(walker: Walker, standing: tuple) -> None:
    """The closed form is the rotated acceleration times t."""
    q, v = standing
    run(walker, q, v, [0.0, 0.0], np.array([1.0, 0, walker.gravity]), 0.1)
    np.testing.assert_allclose(v[:3] - DRIFT, [0.1 * np.cos(0.8), 0.1 * np.sin(0.8), 0], atol=1e-10)


def test_the_loaded_foot_decides(walker: Walker, standing: tuple) -> None:
    """A swinging leg that carries nothing does not enter."""
    q, v = standing
    v[:3] = 0
    v[6 + walker.first[1] + 2] = 3.0  # right hip pitch [rad/s]
    run(walker, q, v, [900.0, 0.0], np.array([0, 0, walker.gravity]), 0.01)
    np.testing.assert_allclose(v[:3], 0, atol=1e-12)


def test_foot_that_rolls_about_its_sole_s_centre_counts_as_still(walker: Walker, standing: tuple) -> None:
    """The ankle of such a foot moves; the sole's centre has zero velocity."""
    q, v = standing
    v[:] = 0
    update(walker.tree, q, v, walker.gravity, walker.pose)
    foot, rolling = walker.feet[0], np.array([0.5, -0.8, 0.2])
    walker.pose.omega[foot] = rolling
    walker.pose.velocity[foot] = -np.cross(rolling, walker.pose.rotation[foot] @ walker.sole)
    update_base(walker, np.array([900.0, 0.0]), np.array([0, 0, walker.gravity]), TICK_S, q, v)
    np.testing.assert_allclose(v, 0, atol=1e-14)
