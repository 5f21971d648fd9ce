"""Ground force, foothold and step duration: their limits, and what they do without an error."""

import numpy as np
import pytest

from mobnet.control.balance import adapt_duration, adapt_foothold, ground_force, measure_dcm
from mobnet.control.footsteps import decay, plan_steps, reference
from mobnet.control.geometry import to_yaw_frame

ANKLE = np.array([0.2, 0.1, 0.158])
TICK_S, GRAVITY = 0.0005, 9.81


@pytest.fixture
def swinging(par, stepping):
    """On the reference, in the middle of the swing, the target on its foothold."""
    s = stepping
    plan_steps(par, s, ANKLE)
    s.swinging, s.t = 1, 0.4
    reference(s, double_support(par, s))
    s.dcm = s.dcm_reference
    s.target, s.lift = s.next_ankle, [*s.next_ankle, 0.158]  # no way to go
    return s


def double_support(par, s):
    """Return how long both feet stand [s]."""
    return par.double_support_share * s.commanded


def leftwards(s):
    """Return the direction (2,) to the left of the stance foot."""
    return np.array([-np.sin(s.stance_yaw), np.cos(s.stance_yaw)])


def test_dcm_converges_to_com_plus_velocity_over_omega(walker, stepping, random_pose):
    random_pose(0)
    pose, par = walker.pose, walker.par
    pose.com[2], stepping.sole_height = 0.9, 0.05
    for _ in range(400):
        measure_dcm(par, stepping, pose, GRAVITY)
    assert stepping.omega == pytest.approx(np.sqrt(GRAVITY / 0.85), rel=1e-12)
    turning = np.array([pose.spin[1], -pose.spin[0]]) / (pose.weight[0] * 0.85)
    expected = pose.com[:2] + (pose.com_velocity[:2] + turning) / stepping.omega
    np.testing.assert_allclose(stepping.dcm, expected, atol=1e-9)
    pose.com[2] = -1.0
    measure_dcm(par, stepping, pose, GRAVITY)
    assert np.isfinite(stepping.omega)  # while the robot lies


def test_no_error_means_the_nominal_zmp_and_the_weight(walker, swinging, random_pose):
    """A zero DCM error moves no ZMP; the force is the pendulum's closed form."""
    random_pose(1)
    pose, mass = walker.pose, walker.pose.weight[0]
    swinging.height_rate = pose.com_velocity[2]
    ground_force(walker.par, swinging, pose, ANKLE, GRAVITY, np.zeros(3))
    np.testing.assert_allclose(swinging.zmp, swinging.zmp_nominal, atol=1e-15)
    assert swinging.force[2] == pytest.approx(mass * GRAVITY, rel=1e-12)
    np.testing.assert_allclose(swinging.force[:2] / mass, swinging.omega**2 * (pose.com[:2] - swinging.zmp), rtol=1e-12)


@pytest.mark.parametrize("error", [(0.3, 0.2), (-0.3, -0.2), (0.0, 1.0)])
def test_zmp_stays_on_the_sole(walker, swinging, random_pose, error):
    random_pose(1)
    par, local = walker.par, np.zeros(2)
    swinging.dcm = swinging.dcm_reference + np.array(error)
    ground_force(par, swinging, walker.pose, ANKLE, GRAVITY, np.zeros(3))
    to_yaw_frame(swinging.zmp - ANKLE[:2], swinging.stance_yaw, local)
    assert par.sole_x_m[0] - 1e-12 <= local[0] <= par.sole_x_m[1] + 1e-12
    assert abs(local[1]) <= par.sole_y_m + 1e-12


@pytest.mark.parametrize("standing", [0, 1])
def test_zmp_shift_on_two_feet_is_bounded(walker, swinging, random_pose, standing):
    random_pose(1)
    swinging.swinging, swinging.standing = 0, standing
    local, par = np.zeros(2), walker.par
    swinging.dcm = swinging.dcm_reference + 1.0
    ground_force(par, swinging, walker.pose, ANKLE, GRAVITY, np.zeros(3))
    to_yaw_frame(swinging.zmp - swinging.zmp_nominal, swinging.stance_yaw, local)
    bound = par.stand_shift_m if standing else par.double_support_shift_m
    assert (np.abs(local) <= np.array(bound) + 1e-12).all()


def test_foothold_stays_without_an_error(par, swinging):
    adapt_foothold(par, swinging, ANKLE, TICK_S, np.zeros(3))
    np.testing.assert_allclose(swinging.target, swinging.next_ankle, atol=1e-15)
    np.testing.assert_allclose(swinging.target_velocity, 0, atol=1e-12)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("error", [(2.0, 2.0), (-2.0, -2.0), (0.05, -0.02)])
def test_foothold_keeps_its_reach_and_speed(par, swinging, error, side):
    swinging.side = side
    plan_steps(par, swinging, ANKLE)
    swinging.target = swinging.next_ankle
    swinging.error = error
    for _ in range(3000):
        before = swinging.target.copy()
        adapt_foothold(par, swinging, ANKLE, TICK_S, np.zeros(3))
        moved = swinging.target - before
        assert (np.abs(moved) <= par.foothold_speed_m_s * TICK_S + 1e-15).all()
        np.testing.assert_allclose(moved, swinging.target_velocity * TICK_S, atol=1e-12)
    local = np.zeros(2)
    to_yaw_frame(swinging.target - ANKLE[:2], swinging.stance_yaw, local)
    assert abs(local[0]) <= par.foothold_x_max_m + 1e-9
    assert par.foothold_y_m[0] - 1e-9 <= -side * local[1] <= par.foothold_y_m[1] + 1e-9


def test_foothold_is_frozen_just_before_landing_and_free_when_late(par, swinging):
    swinging.error = (0.2, 0.0)
    swinging.t = swinging.total - par.foothold_freeze_s / 2
    adapt_foothold(par, swinging, ANKLE, TICK_S, np.zeros(3))
    np.testing.assert_array_equal(swinging.target_velocity, 0)
    swinging.t = swinging.total + TICK_S
    adapt_foothold(par, swinging, ANKLE, TICK_S, np.zeros(3))
    assert swinging.target_velocity.any()


@pytest.mark.parametrize("band_m", [None, 0.0])
def test_duration_stays_without_an_error(par, swinging, band_m):
    """A zero DCM error changes no duration, also without a dead band."""
    own = par.copy()
    own.timing_band_m = par.timing_band_m if band_m is None else band_m
    adapt_duration(own, swinging, double_support(par, swinging), TICK_S, np.zeros(3))
    assert swinging.total == pytest.approx(swinging.commanded, abs=0.0 if band_m is None else 1e-12)


@pytest.mark.parametrize("ahead_s", [-0.05, 0.0, 0.05])
def test_duration_of_a_shifted_reference_is_exact(par, swinging, ahead_s):
    """Without dead band and ankle, a DCM that is `ahead_s` ahead of its reference ends the step that much sooner."""
    free = par.copy()
    free.timing_band_m = free.timing_ankle_m = 0.0
    now = swinging.t
    swinging.t = now + ahead_s
    reference(swinging, double_support(par, swinging))
    swinging.t, swinging.dcm = now, swinging.dcm_reference
    for _ in range(1000):
        adapt_duration(free, swinging, double_support(par, swinging), TICK_S, np.zeros(3))
    assert swinging.total == pytest.approx(swinging.commanded - ahead_s, abs=1e-9)


@pytest.mark.parametrize("lateral", [-0.3, -0.06, -0.03, 0.03, 0.06, 0.3])
def test_duration_keeps_its_limits_and_rate(par, swinging, lateral):
    swinging.dcm = swinging.dcm_reference + lateral * leftwards(swinging)
    for t in np.arange(0.2, 1.2, TICK_S):
        swinging.t, before = t, swinging.total
        adapt_duration(par, swinging, double_support(par, swinging), TICK_S, np.zeros(3))
        assert abs(swinging.total - before) <= par.timing_rate * TICK_S + 1e-15
        shortest = max(par.step_min_s, swinging.commanded - par.step_shorter_max_s)
        assert shortest <= swinging.total <= swinging.commanded + par.step_longer_max_s


def test_a_long_step_is_shortened_by_a_bounded_time(par, swinging):
    swinging.commanded = swinging.total = par.step_min_s + 2 * par.step_shorter_max_s
    swinging.t = 0.2
    swinging.dcm = swinging.dcm_reference - 0.3 * swinging.side * leftwards(swinging)
    for _ in range(4000):
        adapt_duration(par, swinging, double_support(par, swinging), TICK_S, np.zeros(3))
    assert swinging.total == pytest.approx(par.step_min_s + par.step_shorter_max_s, abs=1e-9)


def test_a_step_that_should_have_ended_ends_as_soon_as_it_may(par, swinging):
    swinging.t = 0.5
    swinging.dcm = swinging.dcm_reference - 0.3 * swinging.side * leftwards(swinging)
    for _ in range(4000):
        adapt_duration(par, swinging, double_support(par, swinging), TICK_S, np.zeros(3))
    frozen = max(par.timing_soonest_s, par.timing_freeze_s)
    assert swinging.total == pytest.approx(swinging.t + frozen, abs=par.timing_rate * TICK_S)


@pytest.mark.parametrize("error", [0.02, 0.035, 0.06])
def test_the_ankle_takes_of_a_lateral_error_what_is_beyond_the_band_and_no_more_than_it_can(par, swinging, error):
    """(W18), of what is left of the error."""
    outwards, middle = -swinging.side * leftwards(swinging), 0.5 * double_support(par, swinging)
    swinging.t = 0.2
    reference(swinging, double_support(par, swinging))
    swinging.dcm = swinging.dcm_reference + error * outwards
    end, now = (outwards @ (dcm - swinging.plan[0, :2]) for dcm in (swinging.dcm_end, swinging.dcm))
    ankle = min(par.timing_ankle_m, error - par.timing_band_m)
    expected = swinging.t - middle + np.log((end - ankle) / (now - ankle)) / swinging.omega
    for _ in range(4000):
        adapt_duration(par, swinging, double_support(par, swinging), TICK_S, np.zeros(3))
    assert swinging.total == pytest.approx(expected, abs=1e-9)


def test_dcm_that_runs_ahead_shortens_the_step(par, swinging):
    """The lateral DCM nearer to the swing side than planned is sooner where the next foot wants it."""
    durations = []
    for ahead in (-0.04, 0.0, 0.04):
        s = swinging.copy()
        s.dcm = s.dcm_reference - ahead * s.side * leftwards(s)
        adapt_duration(par, s, double_support(par, s), TICK_S, np.zeros(3))
        durations.append(s.total)
    assert durations[0] > durations[1] > durations[2]


def test_far_foothold_is_not_reached_faster_than_the_swing_limit(par, swinging):
    swinging.lift[0] -= 0.6
    swinging.dcm = swinging.dcm_reference - swinging.side * 0.1 * leftwards(swinging)
    adapt_duration(par, swinging, double_support(par, swinging), TICK_S, np.zeros(3))
    assert swinging.total == swinging.commanded


@pytest.mark.parametrize("reacting", [0, 1])
@pytest.mark.parametrize("away", [(-1.0, 0.0), (0.6, -0.8)])
@pytest.mark.parametrize("share", [(-1.0, 0.0), (-1.0, 0.5), (1.0, 0.5), (1.0, 0.0)])
def test_while_reacting_a_foothold_moves_away_from_the_force_alone(par, swinging, away, share, reacting):
    """An error into the obstacle moves no foothold there; one away from it, or across, does as ever."""
    free = par.copy()
    free.foothold_band_m = 0.0  # so that foothold and error have one direction
    away = np.array(away)
    across = np.array([-away[1], away[0]])
    swinging.reacting, swinging.away = reacting, away
    swinging.error = 0.006 * (share[0] * away + share[1] * across)  # small enough for the speed of a foothold
    adapt_foothold(free, swinging, ANKLE, TICK_S, np.zeros(3))
    moved = swinging.target - swinging.next_ankle
    length = par.foothold_gain * 0.006 / decay(swinging.omega, swinging.total - swinging.t)
    goes = max(share[0], 0.0) if reacting else share[0]
    assert moved @ away == pytest.approx(length * goes, abs=1e-12)
    assert moved @ across == pytest.approx(length * share[1], abs=1e-12)


def test_a_force_without_a_direction_keeps_no_foothold_from_moving(par, swinging):
    swinging.error = (0.1, 0.05)
    reacting = swinging.copy()
    reacting.reacting = 1
    for s in (swinging, reacting):
        adapt_foothold(par, s, ANKLE, TICK_S, np.zeros(3))
    np.testing.assert_allclose(reacting.target, swinging.target, atol=1e-15)
    assert (reacting.target != reacting.next_ankle).all()
