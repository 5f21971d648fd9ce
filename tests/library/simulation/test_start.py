"""Starts: feet on the ground, weight over the nominal ZMP, and a sway that repeats."""

import numpy as np
import pytest

from mobnet.control.kinematics import update
from mobnet.control.steps import DURATION
from mobnet.simulation.start import CLEARANCE_M, place, raise_start, start_standing, start_walking, turn


@pytest.fixture
def simulator(simulate):
    return simulate("checks_place", "ideal")


def test_feet_stand_level_side_by_side_just_over_the_ground(simulator):
    walker, robot = simulator.walker, simulator.robot
    q, ankles = place(walker, robot)
    update(walker.tree, q, np.zeros(39), walker.gravity, walker.pose)
    for k, side in enumerate((1, -1)):
        foot = walker.feet[k]
        np.testing.assert_allclose(walker.pose.position[foot], ankles[k], atol=1e-10)
        np.testing.assert_allclose(walker.pose.rotation[foot], np.eye(3), atol=1e-12)
        assert ankles[k, 1] == side * walker.par.foot_spacing_m / 2
    assert ankles[0, 2] + robot.sole.height == pytest.approx(CLEARANCE_M, abs=1e-15)
    assert walker.pose.com[0] == pytest.approx(ankles[0, 0] + walker.par.zmp_offset_x_m, abs=1e-9)


def test_feet_do_not_move_while_the_pelvis_sways(simulator):
    walker = simulator.walker
    q, v = start_walking(walker, simulator.robot, simulator.state, simulator.commands[0])
    update(walker.tree, q, v, walker.gravity, walker.pose)
    assert v[1] > 0.1
    np.testing.assert_allclose(walker.pose.velocity[walker.feet], 0, atol=1e-10)
    np.testing.assert_allclose(walker.pose.omega[walker.feet], 0, atol=1e-10)


def test_pendulum_that_starts_so_returns_after_two_steps(simulator):
    """The ZMP stands a step on the left foot, then on the right one: a linear inverted pendulum's motion."""
    walker, state, command = simulator.walker, simulator.state, simulator.commands[0]
    _, v = start_walking(walker, simulator.robot, state, command)
    update(walker.tree, *place(walker, simulator.robot)[:1], np.zeros(39), walker.gravity, walker.pose)
    height = walker.pose.com[2] - CLEARANCE_M
    omega, y, speed = np.sqrt(walker.gravity / height), 0.0, v[1]
    middle = []
    grown, swung = (f(omega * command[DURATION]) for f in (np.cosh, np.sinh))
    for side in (1, -1):
        zmp = side * walker.par.foot_spacing_m / 2
        y, speed = zmp + (y - zmp) * grown + speed / omega * swung, (y - zmp) * omega * swung + speed * grown
        middle.append((y, speed))
    np.testing.assert_allclose(middle, [(0, -v[1]), (0, v[1])], atol=1e-9)


def test_start_is_amid_double_support_of_the_left_foot(simulator):
    walker, state, command = simulator.walker, simulator.state, simulator.commands[0]
    state.integral[:], state.steps = 9.0, 7  # of an episode before
    start_walking(walker, simulator.robot, state, command)
    assert (state.side, state.swinging, state.standing, state.steps) == (1.0, 0, 0, 0)
    assert state.t == pytest.approx(walker.par.double_support_share * command[DURATION] / 2)
    assert not state.integral.any()
    assert state.total == state.commanded == command[DURATION]


def test_standing_start_is_at_rest(simulator):
    _, v = start_standing(simulator.walker, simulator.robot, simulator.state, simulator.commands[0])
    assert not v.any()
    assert simulator.state.standing == 1


@pytest.mark.parametrize("begin", [start_walking, start_standing])
def test_moving_upper_body_starts_at_the_reference_and_its_velocity(simulator, begin):
    walker = simulator.walker
    rng = np.random.default_rng(0)
    walker.posture[:] = simulator.robot.posture.angle + rng.uniform(-0.2, 0.2, len(walker.posture))
    walker.posture_rate[:] = rng.normal(size=len(walker.posture))
    q, v = begin(walker, simulator.robot, simulator.state, simulator.commands[0])
    np.testing.assert_array_equal(q[7 + walker.upper :], walker.posture)
    np.testing.assert_array_equal(v[6 + walker.upper :], walker.posture_rate)


@pytest.mark.parametrize("yaw", [-3.0, -0.4, 0.0, 2.2])
def test_turned_and_raised_start_is_the_same_start_elsewhere(simulator, yaw):
    """Feet, centre of mass and their velocities are those of the start at the origin, rotated, moved and lifted."""
    walker, s, where, height = simulator.walker, simulator.state, np.array([0.7, -0.3]), 0.012
    q, v = start_walking(walker, simulator.robot, s, simulator.commands[0])
    c, n = np.cos(yaw), np.sin(yaw)
    rotation, shift = np.array([[c, -n, 0], [n, c, 0], [0, 0, 1]]), np.array([*where, height])
    update(walker.tree, q, v, walker.gravity, walker.pose)
    points = np.vstack([walker.pose.position, walker.pose.com, s.old_ankle])
    speeds, sway, pelvis = walker.pose.velocity.copy(), s.velocity.copy(), s.height
    turn(s, q, v, yaw, where)
    raise_start(s, q, height)
    update(walker.tree, q, v, walker.gravity, walker.pose)
    moved = np.vstack([walker.pose.position, walker.pose.com, s.old_ankle])
    np.testing.assert_allclose(moved, points @ rotation.T + shift, atol=1e-12)
    np.testing.assert_allclose(walker.pose.velocity, speeds @ rotation.T, atol=1e-12)
    np.testing.assert_allclose(s.velocity, rotation[:2, :2] @ sway, atol=1e-15)
    assert s.height == pytest.approx(pelvis + height, abs=1e-15)
    assert s.yaw == s.yaw_start == s.old_yaw == s.stance_yaw == yaw


@pytest.mark.sim
def test_steps_in_place_stay_in_place(simulate, run):
    simulator = simulate("flat_place", "ideal")
    log = run(simulator, 6.0)
    assert log.done == 6000
    moved = np.abs(log["q"][:, :2] - log["q"][0, :2]).max(axis=0)
    assert moved[0] < 0.05
    assert moved[1] < 0.12
