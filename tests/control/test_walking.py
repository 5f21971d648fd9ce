"""One tick of the controller: events of the step, and symmetries of the whole."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from mobnet.control.parameters import DURATION, State, empty_state
from mobnet.control.walking import Walker, foot_yaw, make_walker, vertical_force, walk
from mobnet.robot.description import RobotDescription
from mobnet.simulation.start import start_standing, start_walking

TICK_S, WEIGHT_N = 0.0005, 900.0
COMMANDS = np.array([[0.1, 0.0, 0.1, 0.8, 0.05], [0.2, -0.05, 0.2, 0.6, 0.05]])
RIGHT = 1


class Walk:
    """The controller, called with a body that stays where it is."""

    def __init__(self, walker: Walker, robot: RobotDescription) -> None:
        self.walker, self.s = walker, empty_state()
        self.q, self.v = start_walking(walker, robot, self.s, COMMANDS[0])
        self.v[:] = 0
        self.wrenches, self.tau = np.zeros((2, 6)), np.zeros(robot.layout.nu)
        self.wrenches[0, 2] = WEIGHT_N

    def tick(self) -> None:
        """Advance by one tick."""
        walk(self.walker, self.s, self.q, self.v, self.wrenches, COMMANDS, TICK_S, self.tau)

    def to(self, t: float) -> None:
        """Advance until the step's time is t [s]."""
        while self.s.t < t - 1e-12:
            self.tick()


@pytest.fixture
def walking(walker: Walker, robot: RobotDescription) -> Walk:
    return Walk(walker, robot)


@pytest.fixture
def swinging(walking: Walk) -> Walk:
    """Amid the first step, the right foot in the air; its duration is held."""
    walking.to(0.7 * COMMANDS[0, DURATION])
    assert walking.s.swinging == 1
    return walking


def test_foot_leaves_at_the_end_of_double_support(walking: Walk) -> None:
    end = walking.walker.par.double_support_share * COMMANDS[0, DURATION]
    walking.to(end - 2 * TICK_S)
    assert walking.s.swinging == 0
    walking.to(end + 2 * TICK_S)
    assert walking.s.swinging == 1
    np.testing.assert_allclose(walking.s.lift, walking.walker.pose.position[walking.walker.feet[RIGHT]])


def test_contact_early_in_the_swing_is_ignored(walking: Walk) -> None:
    walking.to(0.3 * COMMANDS[0, DURATION])
    walking.wrenches[RIGHT, 2] = WEIGHT_N
    walking.tick()
    assert (walking.s.steps, walking.s.side) == (0, 1.0)


def test_early_contact_swaps_the_feet_and_waits_for_the_schedule(swinging: Walk) -> None:
    swinging.wrenches[RIGHT, 2] = 1.1 * swinging.walker.par.touch_force_n
    left, remaining = swinging.walker.pose.position[swinging.walker.feet[0]].copy(), swinging.s.total - swinging.s.t
    swinging.tick()
    s = swinging.s
    assert (s.steps, s.side, s.swinging) == (1, -1.0, 0)
    assert s.t == pytest.approx(-min(remaining - TICK_S, swinging.walker.par.early_max_s), abs=1e-3)
    np.testing.assert_allclose(s.old_ankle, left, atol=1e-12)
    np.testing.assert_array_equal(s.command, COMMANDS[1])
    assert s.total == s.commanded == COMMANDS[1, DURATION]
    assert s.load[RIGHT] == 0.0  # all weight stays on the old foot while it waits


def test_light_contact_does_not_end_the_step(swinging: Walk) -> None:
    swinging.wrenches[RIGHT, 2] = 0.9 * swinging.walker.par.touch_force_n
    swinging.tick()
    assert swinging.s.steps == 0


def test_late_foot_keeps_going_down_and_lands_without_waiting(swinging: Walk) -> None:
    swinging.to(swinging.s.total)
    before = swinging.s.foot[2]
    swinging.to(swinging.s.total + 0.5 * swinging.walker.par.late_max_s)
    assert swinging.s.swinging == 1
    assert swinging.s.foot[2] < before
    swinging.wrenches[RIGHT, 2] = WEIGHT_N
    swinging.tick()
    assert (swinging.s.steps, swinging.s.t) == (1, 0.0)


def test_missed_contact_ends_the_step_at_the_latest(swinging: Walk) -> None:
    while swinging.s.steps == 0:
        latest = swinging.s.t - swinging.s.total
        swinging.tick()
    assert latest == pytest.approx(swinging.walker.par.late_max_s, abs=2 * TICK_S)
    assert (swinging.s.side, swinging.s.t) == (-1.0, 0.0)


def test_last_command_is_repeated(walking: Walk) -> None:
    walking.s.steps = 10
    walking.to(0.7 * COMMANDS[0, DURATION])
    walking.wrenches[RIGHT, 2] = WEIGHT_N
    walking.tick()
    np.testing.assert_array_equal(walking.s.command, COMMANDS[-1])


def disturbed(walk: Walk, seed: int) -> None:
    """Move body, rates and sensors off the nominal motion, less than makes the foothold run at its largest speed.

    That speed is limited along each world axis, the one thing in the controller that knows where north is.
    """
    rng = np.random.default_rng(seed)
    walk.q[7:] += rng.normal(0, 0.01, len(walk.q) - 7)
    walk.q[3:7] += rng.normal(0, 0.005, 4)
    walk.q[3:7] /= np.linalg.norm(walk.q[3:7])
    walk.v += rng.normal(0, 0.02, len(walk.v))
    walk.wrenches += rng.normal(0, 5, (2, 6))


@pytest.mark.parametrize("seconds", [0.1, 0.3, 0.6])
@pytest.mark.parametrize("yaw", [0.0, 0.7, np.pi - 0.01])
def test_torques_are_invariant_to_where_the_robot_is_and_looks(
    walking: Walk, robot: RobotDescription, turned: Callable, seconds: float, yaw: float
) -> None:
    walking.to(seconds)
    disturbed(walking, 0)
    image = Walk(make_walker(robot, walking.walker.par, 1.0, walking.walker.gravity), robot)
    image.q, image.v, image.s = turned(walking.q, walking.v, walking.s, yaw, np.array([0.6, -1.2]))
    image.wrenches = walking.wrenches
    for _ in range(10):
        walking.tick()
        image.tick()
        np.testing.assert_allclose(image.tau, walking.tau, atol=1e-7)


@pytest.mark.parametrize("seconds", [0.1, 0.6])
def test_mirrored_state_gives_mirrored_torques(
    walking: Walk, robot: RobotDescription, mirrored: Callable, seconds: float
) -> None:
    """Up to the table's own asymmetry, which moves the centre of mass a little."""
    walking.to(seconds)
    image = Walk(make_walker(robot, walking.walker.par, 1.0, walking.walker.gravity), robot)
    image.q, image.v, image.s = mirrored(walking.q, walking.v, walking.s)
    image.wrenches = walking.wrenches[::-1] * [1, -1, 1, -1, 1, -1]
    walking.tick()
    walk(image.walker, image.s, image.q, image.v, image.wrenches, COMMANDS * [1, -1, -1, 1, 1], TICK_S, image.tau)
    expected = mirrored(np.concatenate([np.zeros(7), walking.tau]), np.zeros(39), walking.s)[0][7:]
    np.testing.assert_allclose(image.tau, expected, atol=0.2)


def test_wrench_is_moved_from_the_sensor_to_the_ankle(walking: Walk) -> None:
    rng = np.random.default_rng(0)
    walking.wrenches = rng.normal(size=(2, 6))
    walking.tick()
    for k in range(2):
        force, moment = walking.wrenches[k, :3], walking.wrenches[k, 3:]
        expected = [*force, *(moment + np.cross(walking.walker.sensor, force))]
        np.testing.assert_allclose(walking.walker.wrench[k], expected, atol=1e-14)
        turned = walking.walker.pose.rotation[walking.walker.feet[k]] @ force
        assert vertical_force(walking.walker, k) == pytest.approx(turned[2], abs=1e-14)


def test_foot_yaw_is_the_heading_of_its_x_axis(walker: Walker, random_pose: Callable) -> None:
    random_pose(3)
    heading = walker.pose.rotation[walker.feet[0]][:, 0]
    assert foot_yaw(walker.pose, walker.feet[0]) == pytest.approx(np.arctan2(heading[1], heading[0]), abs=1e-15)


def test_standing_never_steps(walker: Walker, robot: RobotDescription) -> None:
    stand = Walk(walker, robot)
    stand.q, stand.v = start_standing(walker, robot, stand.s, COMMANDS[0])
    for _ in range(2000):
        stand.tick()
    s: State = stand.s
    assert (s.t, s.steps, s.swinging) == (0.0, 0, 0)
    np.testing.assert_allclose(s.load, 0.5, atol=0.05)
