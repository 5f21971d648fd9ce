"""Reacting steps: where they land, how far the first one may go, and when they go back on kept footsteps."""

from dataclasses import replace

import numpy as np
import pytest

from mobnet.control.steps import DURATION, STEP_X, STEP_Y, TURN
from mobnet.formats.plain import as_plain
from mobnet.reaction.footsteps import Stance, compliant_steps, in_place, rewound_steps, step_to
from mobnet.reaction.numbers import CompliantNumbers, FirstStepNumbers

SPACING_M = 0.2
COMMAND = np.array([0.15, 0.0, 0.0, 0.7, 0.05])
LEFT, RIGHT = 1.0, -1.0
FAR = FirstStepNumbers(
    height_ratio=2.0, foot_speed_m_s=1.0, behind_m=1.0, clear_m=0.0
)  # twice as far as the foot is high, wherever it lands
NOWHERE = FirstStepNumbers(height_ratio=0.0, foot_speed_m_s=1.0, behind_m=1.0, clear_m=0.0)


def stance(side=LEFT, foot=(0.0, 0.0, 0.0), swing=(-0.05, -0.2), height_m=0.04, landing_s=0.3):
    return Stance(np.array(foot), side, np.array(swing), height_m, landing_s)


def landing(foot, side, row):
    """Return where a command brings the swing foot (3,), by (W5) of the controller's plan."""
    outward = row[STEP_Y] if row[STEP_Y] * side < 0.0 else 0.0
    x, y = row[STEP_X], -side * SPACING_M + outward
    c, n = np.cos(foot[2]), np.sin(foot[2])
    return np.array([foot[0] + c * x - n * y, foot[1] + n * x + c * y, foot[2] + row[TURN]])


@pytest.mark.parametrize("yaw", [0.0, 0.8, -2.5])
@pytest.mark.parametrize("side", [LEFT, RIGHT])
def test_a_step_to_a_goal_lands_there(yaw, side):
    foot, goal = np.array([1.0, -2.0, yaw]), np.array([0.0, 0.0, yaw + 0.1])
    c, n = np.cos(yaw), np.sin(yaw)
    goal[:2] = foot[:2] + np.array([c * -0.07 - n * -side * 0.26, n * -0.07 + c * -side * 0.26])
    assert landing(foot, side, step_to(goal, foot, side, COMMAND, SPACING_M)) == pytest.approx(goal)


def test_a_foot_in_the_air_is_sent_back_by_its_height_and_by_the_time_that_is_left(settings):
    first = as_plain(settings.reaction.first_step, FirstStepNumbers)
    low, late = stance(height_m=0.01), stance(height_m=1.0, landing_s=0.02)
    assert low.reach_m(first) == pytest.approx(first.height_ratio * 0.01)
    assert late.reach_m(first) == pytest.approx(first.foot_speed_m_s * 0.02)
    assert stance(height_m=-0.01).reach_m(first) == 0.0
    assert stance(landing_s=np.inf, height_m=0.0).reach_m(first) == np.inf


def test_a_swing_foot_is_ahead_along_the_stance_foot():
    yaw = 0.8
    forwards, left = np.array([np.cos(yaw), np.sin(yaw)]), np.array([-np.sin(yaw), np.cos(yaw)])
    foot = np.array([1.0, -2.0, yaw])
    turned = stance(foot=foot, swing=foot[:2] + 0.07 * forwards - 0.2 * left)
    assert turned.ahead_m == pytest.approx(0.07)


def test_compliant_steps_go_along_the_direction(settings):
    numbers, back = as_plain(settings.reaction.compliant, CompliantNumbers), np.array([-1.0, 0.0])
    rows = compliant_steps(numbers, FAR, stance(height_m=0.02), back, COMMAND, SPACING_M)
    assert len(rows) == numbers.steps == 3  # "three reactive footsteps"
    assert rows[0, STEP_X] == pytest.approx(-0.05 - 0.04)  # from where the foot is
    assert rows[1:, STEP_X] == pytest.approx(-numbers.step_m)
    assert rows[:, DURATION:] == pytest.approx(np.tile(COMMAND[DURATION:], (3, 1)))
    assert not rows[:, TURN].any()


@pytest.mark.parametrize(("ahead_m", "lands_m"), [(0.1, 0.02), (0.0, -0.05), (-0.1, -0.1)])
def test_a_foot_lands_no_further_behind_the_stance_foot_than_it_may_or_is_already(settings, ahead_m, lands_m):
    first, now = replace(FAR, behind_m=0.05), stance(swing=(ahead_m, -0.2))
    rows = compliant_steps(
        as_plain(settings.reaction.compliant, CompliantNumbers), first, now, np.array([-1.0, 0.0]), COMMAND, SPACING_M
    )
    assert rows[0, STEP_X] == pytest.approx(lands_m)


@pytest.mark.parametrize(("ahead_m", "height_m", "landing_s", "lands_m"), [
    (-0.1, 0.05, 0.3, -0.15),  # behind the stance foot: clear of where it is
    (-0.1, 0.0, 0.3, -0.15),  # also a low one
    (-0.1, 0.05, 0.02, -0.12),  # as far as the time allows
    (0.02, 0.05, 0.3, -0.03),
    (0.08, 0.05, 0.3, 0.0),  # clear of it, and no further behind the stance foot
])  # fmt: skip
def test_a_foot_lands_clear_of_where_it_is(settings, ahead_m, height_m, landing_s, lands_m):
    first = replace(FAR, behind_m=0.0, clear_m=0.05)
    now = stance(swing=(ahead_m, -0.2), height_m=height_m, landing_s=landing_s)
    rows = compliant_steps(
        as_plain(settings.reaction.compliant, CompliantNumbers), first, now, np.array([-1.0, 0.0]), COMMAND, SPACING_M
    )
    assert rows[0, STEP_X] == pytest.approx(lands_m)
    assert rows[0, STEP_Y] == pytest.approx(0.0)


def test_a_foot_that_stands_makes_a_whole_step_from_the_stance_foot(settings):
    numbers, behind = (
        as_plain(settings.reaction.compliant, CompliantNumbers),
        stance(swing=(-0.15, -0.2), landing_s=np.inf),
    )
    rows = compliant_steps(numbers, FAR, behind, np.array([-1.0, 0.0]), COMMAND, SPACING_M)
    assert rows[:, STEP_X] == pytest.approx(-numbers.step_m)


def test_compliant_steps_are_told_in_the_frame_of_the_stance_foot(settings):
    turned = stance(foot=(0.0, 0.0, np.pi / 2), swing=(0.2, 0.0))
    rows = compliant_steps(
        as_plain(settings.reaction.compliant, CompliantNumbers),
        NOWHERE,
        turned,
        np.array([-1.0, 0.0]),
        COMMAND,
        SPACING_M,
    )
    assert rows[1:, STEP_Y] == pytest.approx(settings.reaction.compliant.step_m)  # world -x is to its left
    assert rows[1:, STEP_X] == pytest.approx(0.0, abs=1e-12)


def walked(steps=5):
    """Return the feet of a straight walk (3,), left and right in turn, and the stance at its end, on the left foot."""
    feet = [np.array([0.08 * k, -0.1 if k % 2 else 0.1, 0.0]) for k in range(steps)]
    return feet[:-1], stance(LEFT, feet[-1], feet[-2][:2], 0.03, 0.4)


def test_rewinding_goes_back_on_the_footsteps():
    kept, now = walked()
    rows = rewound_steps(kept, 3, 0.2, FAR, now, COMMAND, SPACING_M)
    foot, side = now.foot, now.side
    for row, goal in zip(rows, reversed(kept[-3:]), strict=True):
        foot = landing(foot, side, row)
        assert foot == pytest.approx(goal)
        side = -side


def test_a_foot_that_could_be_sent_further_goes_no_further_than_where_it_stood():
    kept, now = walked()
    near = stance(LEFT, now.foot, now.swing + [0.02, 0.0], 0.03, 0.4)
    assert near.reach_m(FAR) > 0.05
    rows = rewound_steps(kept, 1, 0.2, FAR, near, COMMAND, SPACING_M)
    assert landing(near.foot, near.side, rows[0]) == pytest.approx(kept[-1])


def test_rewinding_ends_with_the_footsteps_that_are_kept():
    kept, now = walked(3)
    assert len(rewound_steps(kept, 9, 0.2, FAR, now, COMMAND, SPACING_M)) == 2
    in_place = rewound_steps([], 9, 0.2, FAR, now, COMMAND, SPACING_M)
    assert len(in_place) == 1
    assert not in_place[:, :DURATION].any()


def test_steps_back_are_no_longer_than_the_robot_can_turn_round_in():
    kept, now = walked()
    rows = rewound_steps(kept, 4, 0.05, FAR, now, COMMAND, SPACING_M)
    assert rows[0, STEP_X] == pytest.approx(-0.08)  # where it is
    assert rows[1:, STEP_X].min() == pytest.approx(-0.05)
    ahead = stance(LEFT, now.foot, now.foot[:2] + [0.15, -0.2], 0.01, 0.1)
    assert rewound_steps(kept, 4, 0.05, NOWHERE, ahead, COMMAND, SPACING_M)[0, STEP_X] == pytest.approx(0.15)  # stays


def test_steps_in_place_have_no_length():
    rows = in_place(COMMAND, 2)
    assert not rows[:, :DURATION].any()
    assert (rows[:, DURATION:] == COMMAND[DURATION:]).all()
