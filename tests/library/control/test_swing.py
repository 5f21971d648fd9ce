"""The swing foot: where it starts and ends, and that its velocity is the derivative of its position."""

import numpy as np
import pytest

from mobnet.control.steps import FOOT_HEIGHT
from mobnet.control.swing import swing_foot, swing_height, turn_back

DOUBLE_SUPPORT, SPAN, GROUND = 0.13, 0.67, 0.158
STEP = 1e-6


@pytest.fixture
def swinging(stepping):
    stepping.lift = [0.0, -0.1, 0.163]
    stepping.lift_yaw, stepping.lift_roll, stepping.lift_pitch, stepping.next_yaw = 0.1, 0.05, -0.04, 0.4
    stepping.target = [0.3, -0.12]
    stepping.swinging = 1
    stepping.total = DOUBLE_SUPPORT + SPAN
    return stepping


def at(par, s, t):
    """Return a copy of the state with the swing foot at time t [s]."""
    moved = s.copy()
    moved.t = t
    swing_foot(par, moved, DOUBLE_SUPPORT, GROUND)
    return moved


def test_starts_where_the_foot_left(par, swinging):
    s = at(par, swinging, DOUBLE_SUPPORT)
    np.testing.assert_allclose(s.foot, swinging.lift, atol=1e-15)
    np.testing.assert_allclose(s.foot_velocity, 0.0, atol=1e-12)


def test_ends_over_the_foothold_level_and_descending(par, swinging):
    s = at(par, swinging, swinging.total)
    np.testing.assert_allclose(s.foot, [*swinging.target, GROUND], atol=1e-12)
    np.testing.assert_allclose(s.foot_velocity, [0.0, 0.0, -par.descent_speed_m_s], atol=1e-12)
    yaw = np.arctan2(s.foot_rotation[1, 0], s.foot_rotation[0, 0])
    assert yaw == pytest.approx(swinging.next_yaw, abs=1e-12)
    assert s.foot_rotation[2, 2] == pytest.approx(1, abs=1e-12)


@pytest.mark.parametrize("slope", [(0.05, 0.0), (0.0, 0.05), (-0.03, 0.04)])
@pytest.mark.parametrize("yaw", [0.0, 0.4, -2.0, 3.0])
def test_sole_lands_along_the_slope(par, swinging, slope, yaw):
    swinging.slope, swinging.next_yaw = slope, yaw
    normal = at(par, swinging, swinging.total).foot_rotation[:, 2]
    np.testing.assert_allclose(-normal[:2] / normal[2], slope, atol=2e-4)


def test_foot_leaves_as_it_stood_whatever_the_slope(par, swinging):
    level, sloping = swinging.copy(), swinging.copy()
    sloping.slope = [0.05, -0.02]
    here, there = (at(par, s, DOUBLE_SUPPORT).foot_rotation for s in (level, sloping))
    np.testing.assert_array_equal(there, here)


@pytest.mark.parametrize("rise_m", [-0.03, 0.0, 0.03])
def test_apex_is_the_commanded_height_over_the_higher_foot(par, swinging, rise_m):
    ground = swinging.lift[2] + rise_m
    height, rate = swing_height(par, swinging, ground, SPAN, par.swing_apex)
    assert height == pytest.approx(swinging.lift[2] + max(rise_m, 0.0) + swinging.command[FOOT_HEIGHT], abs=1e-14)
    assert rate == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("t", [0.2, 0.3, 0.44, 0.6, 0.75, 0.82, 0.85])
def test_velocity_is_the_derivative_of_the_position(par, swinging, t):
    difference = (at(par, swinging, t + STEP).foot - at(par, swinging, t - STEP).foot) / (2 * STEP)
    s = at(par, swinging, t)
    np.testing.assert_allclose(s.foot_velocity, difference, atol=1e-6)
    turned = [np.arctan2(m[1, 0], m[0, 0]) for m in (at(par, swinging, t + d).foot_rotation for d in (-STEP, STEP))]
    assert s.foot_yaw_rate == pytest.approx((turned[1] - turned[0]) / (2 * STEP), abs=1e-6)


def test_moving_target_enters_the_velocity(par, swinging):
    swinging.target_velocity = [0.5, -0.2]
    moved = swinging.copy()
    moved.target = swinging.target + STEP * swinging.target_velocity
    t = 0.5
    difference = (at(par, moved, t + STEP).foot - at(par, swinging, t).foot)[:2] / STEP
    np.testing.assert_allclose(at(par, swinging, t).foot_velocity[:2], difference, atol=1e-5)


def test_position_and_velocity_are_continuous_at_the_apex_and_the_end(par, swinging):
    for u in (par.swing_apex, 1.0):
        before, after = (swing_height(par, swinging, GROUND, SPAN, u + d) for d in (-1e-9, 1e-9))
        np.testing.assert_allclose(before, after, atol=1e-6)


def test_late_foot_goes_down_to_the_depth_and_no_further(par, swinging):
    heights = [swing_height(par, swinging, GROUND, SPAN, u)[0] for u in np.linspace(1.0, 1.5, 100)]
    assert (np.diff(heights) <= 0).all()
    assert heights[-1] == pytest.approx(GROUND - par.descent_depth_m, abs=1e-15)
    assert min(heights) == heights[-1]


@pytest.mark.parametrize("t", [0.2, 0.35, 0.5])
def test_a_foot_that_turns_back_begins_at_its_own_place_and_goes_straight_to_the_foothold(par, swinging, t):
    held = np.array([0.05, -0.11])  # by an obstacle, behind where the foot should be
    swinging.t, swinging.turns_back = t, 1
    swinging.next_ankle = [-0.02, -0.1]
    turn_back(par, swinging, DOUBLE_SUPPORT, np.array([*held, 0.2]))
    s = at(par, swinging, t)
    np.testing.assert_allclose(s.foot[:2], held, atol=1e-12)
    assert s.foot_velocity[0] < 0.0
    assert swinging.turns_back == 0
    way = np.array([at(par, swinging, late).foot[:2] for late in np.linspace(t, swinging.total, 20)])
    assert (np.diff(way[:, 0]) <= 1e-12).all()
    np.testing.assert_allclose(way[-1], swinging.next_ankle, atol=1e-12)


def test_a_foot_turns_back_once_and_only_while_there_is_a_way_left(par, swinging):
    def turned(t, turns_back):
        s = swinging.copy()
        s.t, s.turns_back, s.next_ankle = t, turns_back, [-0.02, -0.1]
        turn_back(par, s, DOUBLE_SUPPORT, np.array([0.05, -0.11, 0.2]))
        return (s.lift != swinging.lift).any() and (s.target != swinging.target).any()

    assert turned(0.35, 1)
    assert not turned(0.35, 0)
    assert not turned(swinging.total - 0.01, 1)
