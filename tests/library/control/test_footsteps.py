"""Footholds and the DCM: the plan against the integrated motion xidot = w (xi - z)."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mobnet.control.footsteps import decay, plan_steps, reference
from mobnet.control.steps import DURATION, STEP_X, STEP_Y, TURN

ANKLE = np.array([0.2, 0.1, 0.158])


@pytest.fixture
def planned(par, stepping):
    stepping.zmp_old = stepping.old_ankle[:2] + par.zmp_offset_x_m * np.array([np.cos(0.2), np.sin(0.2)])
    plan_steps(par, stepping, ANKLE)
    return stepping


def test_decay_is_one_for_past_times():
    assert decay(3.0, -1.0) == 1.0
    assert decay(3.0, 0.5) == pytest.approx(np.exp(-1.5), rel=1e-15)


def test_dcm_runs_from_its_planned_end_to_the_midpoint_of_the_last_feet(planned):
    """The reference is the closed form of the DCM over a ZMP that stands still."""
    dcm = np.array(planned.dcm_end)
    for k in (1, 2, 3):  # the ZMP stays on plan[k] for a step
        z = planned.plan[k]
        dcm = z + (dcm - z) * np.exp(planned.omega * planned.commanded)
    np.testing.assert_allclose(dcm, (planned.plan[3] + planned.plan[4]) / 2, atol=1e-10)


def test_reference_solves_the_dcm_equation_for_the_nominal_zmp(par, planned):
    double_support = par.double_support_share * planned.commanded
    end = planned.total + double_support / 2

    def rate(t, dcm):
        planned.t = t
        reference(planned, double_support)
        zmp = planned.zmp_nominal if t >= 0 else planned.zmp_old
        return planned.omega * (dcm - zmp)

    planned.t = -0.05
    reference(planned, double_support)
    dcm = np.array(planned.dcm_reference)
    for start, stop in ((-0.05, 0.0), (0.0, double_support), (double_support, end)):
        dcm = solve_ivp(rate, (start, stop), dcm, rtol=1e-11, atol=1e-13).y[:, -1]
        planned.t = stop
        reference(planned, double_support)
        np.testing.assert_allclose(planned.dcm_reference, dcm, atol=1e-8)
    np.testing.assert_allclose(planned.dcm_reference, planned.dcm_end, atol=1e-12)


@pytest.mark.parametrize("share", [0.0, 1.0])
def test_reference_and_zmp_are_continuous(par, planned, share):
    double_support = par.double_support_share * planned.commanded
    values = []
    for t in (share * double_support - 1e-9, share * double_support + 1e-9):
        planned.t = t
        reference(planned, double_support)
        values.append(np.concatenate([planned.dcm_reference, planned.zmp_nominal]))
    np.testing.assert_allclose(values[0], values[1], atol=1e-7)


def test_zmp_goes_from_the_old_to_the_new_foot(par, planned):
    double_support = par.double_support_share * planned.commanded
    for t, zmp in ((0.0, planned.zmp_old), (double_support, planned.plan[0]), (0.5, planned.plan[0])):
        planned.t = t
        reference(planned, double_support)
        np.testing.assert_allclose(planned.zmp_nominal, zmp, atol=1e-15)


def test_next_foothold_is_the_command_in_the_stance_foot_s_frame(par, planned):
    turned = planned.stance_yaw
    apart = planned.next_ankle - ANKLE[:2]
    forward = apart @ [np.cos(turned), np.sin(turned)]
    left = apart @ [-np.sin(turned), np.cos(turned)]
    assert forward == pytest.approx(planned.command[STEP_X], abs=1e-14)
    assert left == pytest.approx(-par.foot_spacing_m, abs=1e-14)  # a right foot does not step to the left
    assert planned.next_yaw == pytest.approx(turned + planned.command[TURN], abs=1e-14)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("step_y", [-0.1, 0.1])
def test_only_an_outer_foot_steps_sideways(par, stepping, side, step_y):
    stepping.side, stepping.stance_yaw = side, 0.0
    stepping.command[STEP_X] = stepping.command[TURN] = 0.0
    stepping.command[STEP_Y] = step_y
    plan_steps(par, stepping, ANKLE)
    outer = step_y * side < 0
    apart = stepping.next_ankle[1] - ANKLE[1]
    assert apart == pytest.approx(-side * par.foot_spacing_m + outer * step_y, abs=1e-14)
    assert abs(apart) >= par.foot_spacing_m - 1e-14


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("turn", [-0.35, 0.35])
def test_toes_turn_in_less_than_out(par, stepping, side, turn):
    stepping.side, stepping.command[TURN] = side, turn
    plan_steps(par, stepping, ANKLE)
    inwards = turn * side > 0  # left stance: the right foot turns its toes to the left
    expected = np.sign(turn) * par.toe_in_max_rad if inwards else turn
    assert stepping.next_yaw - stepping.stance_yaw == pytest.approx(expected, abs=1e-14)


def test_plan_is_symmetric_under_reflection(par, stepping):
    image = stepping.copy()
    mirror = np.array([1.0, -1.0])
    image.side, image.stance_yaw = -stepping.side, -stepping.stance_yaw
    image.command = stepping.command * [1, -1, -1, 1, 1]
    plan_steps(par, stepping, ANKLE)
    plan_steps(par, image, ANKLE * [1, -1, 1])
    np.testing.assert_allclose(image.plan, stepping.plan * mirror, atol=1e-15)
    np.testing.assert_allclose(image.dcm_end, stepping.dcm_end * mirror, atol=1e-15)


def test_steps_in_place_repeat_after_two(par, stepping):
    stepping.command[:DURATION] = 0.0
    plan_steps(par, stepping, ANKLE)
    np.testing.assert_allclose(stepping.plan[2:4], stepping.plan[:2], atol=1e-14)
