"""The height of the pelvis at which legs still reach the ground."""

import numpy as np
import pytest

from mobnet.control.kinematics import update
from mobnet.control.phases import move_pelvis, reached_height
from mobnet.simulation.start import place

TICK_S = 0.0005


@pytest.fixture
def standing(walker, robot, stepping):
    """Feet together under a still robot, both on the ground."""
    q, ankles = place(walker, robot)
    update(walker.tree, q, np.zeros(robot.layout.nv), walker.gravity, walker.pose)
    stepping.load, stepping.sole_height, stepping.height = 0.5, ankles[0, 2] + walker.sole[2], q[2]
    stepping.zmp_nominal, stepping.velocity = walker.pose.com[:2], 0.0
    stepping.target = ankles[1, :2]
    stepping.total = 0.8
    return stepping


def test_legs_under_the_hips_leave_the_pelvis_at_its_height(walker, standing):
    wanted = standing.sole_height + walker.par.pelvis_height_m
    for swinging in (0, 1):
        standing.swinging = swinging
        assert reached_height(walker, standing, 0) == pytest.approx(wanted, abs=1e-12)


@pytest.mark.parametrize("away", [0.25, 0.3])
def test_pelvis_sinks_until_the_landing_leg_has_its_reach(walker, standing, away):
    """The still pendulum over its ZMP stays: the hip at its new height is one reach from the target."""
    standing.swinging, standing.t = 1, 0.5
    hip = walker.pose.position[walker.tree.body_of_joint[walker.first[1]]].copy()
    standing.target = hip[:2] + [away, 0.0]
    lowered = reached_height(walker, standing, 0) - walker.pose.position[0, 2]
    assert lowered < 0.0
    span = np.hypot(away, hip[2] + lowered - walker.pose.position[walker.feet[0], 2])
    assert span == pytest.approx(walker.par.leg_reach_m, abs=1e-9)


def test_reach_is_asked_where_the_pendulum_brings_the_hip(walker, standing):
    """A hip that moves towards a far target is over it when the step ends: integrated from (W2) as the reference."""
    standing.swinging, standing.t, standing.velocity = 1, 0.4, [0.5, 0.0]
    place_m, speed, omega = np.array([0.0, 0.0]), np.array([0.5, 0.0]), float(standing.omega)
    for _ in range(4000):
        speed = speed + 1e-4 * omega**2 * place_m
        place_m = place_m + 1e-4 * speed
    hip = walker.pose.position[walker.tree.body_of_joint[walker.first[1]], :2]
    standing.target = hip + place_m
    wanted = standing.sole_height + walker.par.pelvis_height_m
    assert place_m[0] > 0.25
    assert reached_height(walker, standing, 0) == pytest.approx(wanted, abs=1e-9)
    standing.velocity = [0.0, 0.0]
    assert reached_height(walker, standing, 0) < wanted


def test_a_late_foot_is_asked_for_its_reach_where_the_hip_is(walker, standing):
    standing.swinging, standing.t, standing.velocity = 1, standing.total, [0.5, 0.0]
    hip = walker.pose.position[walker.tree.body_of_joint[walker.first[1]], :2]
    standing.target = hip + [0.27, 0.0]
    in_time = reached_height(walker, standing, 0)
    assert in_time < standing.sole_height + walker.par.pelvis_height_m
    standing.t = standing.total + 0.1
    assert reached_height(walker, standing, 0) == in_time


def test_pelvis_sinks_by_a_bounded_depth_and_speed(walker, standing):
    par = walker.par
    standing.swinging, standing.t, standing.target = 1, 0.5, [3.0, 0.0]
    lowest = standing.sole_height + par.pelvis_height_m - par.pelvis_sink_max_m
    assert reached_height(walker, standing, 0) == pytest.approx(lowest, abs=1e-12)
    before = float(standing.height)
    move_pelvis(walker, standing, 0, TICK_S)
    assert before - standing.height == pytest.approx(par.pelvis_height_speed_m_s * TICK_S, rel=1e-9)
    for _ in range(4000):
        move_pelvis(walker, standing, 0, TICK_S)
    assert standing.height == pytest.approx(lowest, abs=1e-6)
