"""One tick of the controller: events of the step, and symmetries of the whole."""

import numpy as np
import pytest

from mobnet.control.geometry import yaw_roll_pitch_matrix
from mobnet.control.parameters import empty_state
from mobnet.control.phases import correct_load, feel_slope
from mobnet.control.steps import DURATION
from mobnet.control.walker import foot_yaw, vertical_force
from mobnet.control.walking import walk
from mobnet.simulation.start import start_standing, start_walking

TICK_S, WEIGHT_N = 0.0005, 900.0
COMMANDS = np.array([[0.1, 0.0, 0.1, 0.8, 0.05], [0.2, -0.05, 0.2, 0.6, 0.05]])
RIGHT = 1


class Walk:
    """The controller, called with a body that stays where it is."""

    def __init__(self, walker, robot):
        self.walker, self.s = walker, empty_state()
        self.q, self.v = start_walking(walker, robot, self.s, COMMANDS[0])
        self.v[:] = 0
        self.wrenches, self.tau = np.zeros((2, 6)), np.zeros(robot.layout.nu)
        self.wrenches[0, 2] = WEIGHT_N

    def tick(self):
        walk(self.walker, self.s, self.q, self.v, self.wrenches, COMMANDS, TICK_S, self.tau)

    def land(self, force_n=WEIGHT_N):
        """Advance by one tick with a vertical force on the right foot."""
        self.wrenches[RIGHT, 2] = force_n
        self.tick()

    def to(self, t):
        """Advance until the step's time is t [s]."""
        while self.s.t < t - 1e-12:
            self.tick()


@pytest.fixture
def walking(walker, robot):
    return Walk(walker, robot)


@pytest.fixture
def swinging(walking):
    """Amid the first step, the right foot in the air; its duration is held."""
    walking.to(0.7 * COMMANDS[0, DURATION])
    assert walking.s.swinging == 1
    return walking


def test_foot_leaves_at_the_end_of_double_support(walking):
    end = walking.walker.par.double_support_share * COMMANDS[0, DURATION]
    walking.to(end - 2 * TICK_S)
    assert walking.s.swinging == 0
    walking.to(end + 2 * TICK_S)
    assert walking.s.swinging == 1
    np.testing.assert_allclose(walking.s.lift, walking.walker.pose.position[walking.walker.feet[RIGHT]])


@pytest.mark.parametrize(("share", "touches"), [(0.3, 10.0), (0.7, 0.9)])
def test_contact_early_in_the_swing_or_light_is_ignored(walking, share, touches):
    walking.to(share * COMMANDS[0, DURATION])
    walking.land(touches * walking.walker.par.touch_force_n)
    assert (walking.s.steps, walking.s.side) == (0, 1.0)


def test_early_contact_swaps_the_feet_and_waits_for_the_schedule(swinging):
    left, remaining = swinging.walker.pose.position[swinging.walker.feet[0]].copy(), swinging.s.total - swinging.s.t
    swinging.land(1.1 * swinging.walker.par.touch_force_n)
    s = swinging.s
    assert (s.steps, s.side, s.swinging) == (1, -1.0, 0)
    assert s.t == pytest.approx(-min(remaining - TICK_S, swinging.walker.par.early_max_s), abs=1e-3)
    np.testing.assert_allclose(s.old_ankle, left, atol=1e-12)
    np.testing.assert_array_equal(s.command, COMMANDS[1])
    assert s.total == s.commanded == COMMANDS[1, DURATION]
    assert s.load[RIGHT] == 0.0  # all weight stays on the old foot while it waits


def test_late_foot_keeps_going_down_and_lands_without_waiting(swinging):
    swinging.to(swinging.s.total)
    before = swinging.s.foot[2]
    swinging.to(swinging.s.total + 0.5 * swinging.walker.par.late_max_s)
    assert swinging.s.swinging == 1
    assert swinging.s.foot[2] < before
    swinging.land()
    assert (swinging.s.steps, swinging.s.t) == (1, 0.0)


def test_missed_contact_ends_the_step_at_the_latest(swinging):
    while swinging.s.steps == 0:
        latest = swinging.s.t - swinging.s.total
        swinging.tick()
    assert latest == pytest.approx(swinging.walker.par.late_max_s, abs=2 * TICK_S)
    assert (swinging.s.side, swinging.s.t) == (-1.0, 0.0)


def test_last_command_is_repeated(walking):
    walking.s.steps = 10
    walking.to(0.7 * COMMANDS[0, DURATION])
    walking.land()
    np.testing.assert_array_equal(walking.s.command, COMMANDS[-1])


@pytest.mark.parametrize(("share", "stumbles"), [(0.99, False), (1.01, True)])
@pytest.mark.parametrize("way", [(1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.6, 0.8, 0.0), (0.0, 0.0, 1.0)])
def test_only_the_step_after_a_stumble_is_in_place(swinging, share, stumbles, way):
    """Step and turn are zero where the DCM error (x, y) is large or the pelvis has sunk: knees at their limits
    straighten only in place. The command's duration and foot height stay, and later steps are as commanded."""
    par = swinging.walker.par
    swinging.s.error = share * par.stumble_m * np.array(way[:2])
    if way[2]:
        swinging.s.height = swinging.q[2] + share * par.stumble_sunk_m
    swinging.land()
    expected = COMMANDS[1].copy()
    expected[:DURATION] *= not stumbles
    np.testing.assert_array_equal(swinging.s.command, expected)
    assert swinging.s.total == COMMANDS[1, DURATION]
    swinging.s.swinging, swinging.s.t = 1, swinging.s.total
    swinging.s.error, swinging.s.height = [0.0, 0.0], swinging.q[2]
    swinging.wrenches[0, 2] = WEIGHT_N
    swinging.tick()
    np.testing.assert_array_equal(swinging.s.command, COMMANDS[-1])


@pytest.mark.parametrize("lacks", [-120.0, 0.0, 200.0])
def test_load_error_converges_to_what_a_foot_lacks_of_its_share(walker, stepping, lacks):
    load_feet(walker, stepping, lacks)
    for _ in range(200):
        correct_load(walker, stepping)
    np.testing.assert_allclose(stepping.load_error, [lacks, -lacks], atol=1e-6)


def test_load_error_decays_to_zero_while_one_foot_swings(walker, stepping):
    load_feet(walker, stepping, 200.0)
    stepping.load_error, stepping.swinging = [200.0, -200.0], 1
    correct_load(walker, stepping)
    np.testing.assert_allclose(stepping.load_error, np.array([200.0, -200.0]) * (1 - walker.par.load_filter))
    for _ in range(300):
        correct_load(walker, stepping)
    np.testing.assert_allclose(stepping.load_error, 0.0, atol=1e-9)


def load_feet(walker, s, lacks):
    """Let both feet be level, 0.6 and 0.4 of 900 N wanted on them; the left one has less by `lacks` [N]."""
    s.load, s.force, s.swinging = [0.6, 0.4], [30.0, -20.0, WEIGHT_N], 0
    walker.pose.rotation[walker.feet] = np.eye(3)
    walker.wrench[:] = 0.0
    walker.wrench[:, 2] = 0.6 * WEIGHT_N - lacks, 0.4 * WEIGHT_N + lacks


@pytest.mark.parametrize("yaw", [0.0, 0.9, -2.5])
def test_felt_slope_converges_to_the_foot_s_and_takes_a_time_constant(par, yaw):
    s, foot, slope = empty_state(), np.zeros((3, 3)), np.array([0.04, -0.03])
    c, n = np.cos(yaw), np.sin(yaw)
    roll, pitch = np.arctan(slope @ [-n, c]), -np.arctan(slope @ [c, n])
    yaw_roll_pitch_matrix(yaw, roll, pitch, foot)
    ticks = round(1.0 / (par.slope_rate_hz * TICK_S))
    for _ in range(ticks):
        feel_slope(par, s, foot, TICK_S)
    np.testing.assert_allclose(s.slope, slope * (1 - np.exp(-1)), rtol=5e-3)
    for _ in range(20 * ticks):
        feel_slope(par, s, foot, TICK_S)
    np.testing.assert_allclose(s.slope, slope, rtol=3e-3)


def test_felt_slope_stays_within_its_bound_under_a_foot_that_tips(par):
    s, foot = empty_state(), np.zeros((3, 3))
    yaw_roll_pitch_matrix(0.3, 0.5, -0.6, foot)
    for _ in range(20_000):
        feel_slope(par, s, foot, TICK_S)
        assert np.abs(s.slope).max() <= par.slope_max
    assert np.abs(s.slope).max() == par.slope_max


@pytest.mark.parametrize("slope", [(0.0, 0.0), (0.05, 0.0), (-0.02, 0.04)])
def test_foot_comes_down_where_the_slope_puts_the_ground(swinging, slope):
    """At the end of its swing the ankle is over the foothold as high as a plane of that slope through the other."""
    swinging.to(swinging.s.total - 3 * TICK_S)
    s, stance = swinging.s, swinging.walker.pose.position[swinging.walker.feet[0]]
    s.slope = slope
    swinging.to(s.total)
    s.slope = slope
    before = s.total
    s.t = before - TICK_S
    swinging.tick()
    expected = stance[2] + np.dot(s.slope, s.target - stance[:2])
    assert s.foot[2] == pytest.approx(expected, abs=1e-3)


def disturbed(walk, seed):
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
def test_torques_are_invariant_to_where_the_robot_is_and_looks(walking, make, robot, turned, seconds, yaw):
    walking.to(seconds)
    disturbed(walking, 0)
    image = Walk(make(), robot)
    image.q, image.v, image.s = turned(walking.q, walking.v, walking.s, yaw, np.array([0.6, -1.2]))
    image.wrenches = walking.wrenches
    for _ in range(10):
        walking.tick()
        image.tick()
        np.testing.assert_allclose(image.tau, walking.tau, atol=1e-7)


@pytest.mark.parametrize("seconds", [0.1, 0.6])
def test_mirrored_state_gives_mirrored_torques(walking, make, robot, mirrored, seconds):
    """Up to the table's own asymmetry, which moves the centre of mass a little."""
    walking.to(seconds)
    image = Walk(make(), robot)
    image.q, image.v, image.s = mirrored(walking.q, walking.v, walking.s)
    image.wrenches = walking.wrenches[::-1] * [1, -1, 1, -1, 1, -1]
    walking.tick()
    walk(image.walker, image.s, image.q, image.v, image.wrenches, COMMANDS * [1, -1, -1, 1, 1], TICK_S, image.tau)
    expected = mirrored(np.concatenate([np.zeros(7), walking.tau]), np.zeros(39), walking.s)[0][7:]
    np.testing.assert_allclose(image.tau, expected, atol=0.2)


def test_wrench_is_moved_from_the_sensor_to_the_ankle(walking):
    rng = np.random.default_rng(0)
    walking.wrenches = rng.normal(size=(2, 6))
    walking.tick()
    for k in range(2):
        force, moment = walking.wrenches[k, :3], walking.wrenches[k, 3:]
        expected = [*force, *(moment + np.cross(walking.walker.sensor, force))]
        np.testing.assert_allclose(walking.walker.wrench[k], expected, atol=1e-14)
        turned = walking.walker.pose.rotation[walking.walker.feet[k]] @ force
        assert vertical_force(walking.walker, k) == pytest.approx(turned[2], abs=1e-14)


def test_foot_yaw_is_the_heading_of_its_x_axis(walker, random_pose):
    random_pose(3)
    heading = walker.pose.rotation[walker.feet[0]][:, 0]
    assert foot_yaw(walker.pose, walker.feet[0]) == pytest.approx(np.arctan2(heading[1], heading[0]), abs=1e-15)


def test_standing_never_steps(walker, robot):
    stand = Walk(walker, robot)
    stand.q, stand.v = start_standing(walker, robot, stand.s, COMMANDS[0])
    for _ in range(2000):
        stand.tick()
    s = stand.s
    assert (s.t, s.steps, s.swinging) == (0.0, 0, 0)
    np.testing.assert_allclose(s.load, 0.5, atol=0.05)
