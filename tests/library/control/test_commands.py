"""Commands stay in Table 2 and change at the limited rate."""

from itertools import pairwise
from typing import get_args

import numpy as np
import pytest

from mobnet.control.commands import MOVING, WIDTH, fixed_commands, joystick_law, random_commands
from mobnet.control.steps import DURATION, FOOT_HEIGHT, STEP_X, STEP_Y, TURN
from mobnet.settings.data import FixedCommand, RandomCommands

STEPS = 3000


@pytest.fixture
def commands(settings):
    return settings.commands


@pytest.fixture
def drawn(commands):
    return random_commands(commands, np.random.default_rng(1), STEPS)


def test_fixed_command_is_repeated_after_steps_in_place():
    fixed = FixedCommand(step_x_m=0.2, step_y_m=0.1, turn_deg=10.0, duration_s=0.7, foot_height_m=0.055)
    rows = fixed_commands(fixed, 3)
    assert rows.shape == (4, WIDTH)
    np.testing.assert_allclose(rows[-1], [0.2, 0.1, np.deg2rad(10), 0.7, 0.055])
    np.testing.assert_array_equal(rows[:3, :DURATION], 0)
    np.testing.assert_array_equal(rows[:3, DURATION:], np.tile([0.7, 0.055], (3, 1)))


def test_random_commands_stay_in_table_2(commands, drawn):
    ranges = {STEP_X: commands.step_x_m, STEP_Y: commands.step_y_m, TURN: np.deg2rad(commands.turn_deg)}
    for column, (low, high) in ranges.items():
        assert drawn[:, column].min() == pytest.approx(low)  # the edges are reached
        assert drawn[:, column].max() == pytest.approx(high)
    assert set(drawn[:, DURATION]) == set(commands.duration_s)
    assert set(drawn[:, FOOT_HEIGHT]) == set(commands.foot_height_m)


def test_random_commands_change_at_the_limited_rate(commands, drawn):
    law = commands.random
    slew = np.array([law.slew_step_x_m, law.slew_step_y_m, np.deg2rad(law.slew_turn_deg)])
    assert (np.abs(np.diff(drawn[:, :DURATION], axis=0)).max(axis=0) <= slew + 1e-12).all()
    np.testing.assert_array_equal(drawn[: law.in_place_steps, :DURATION], 0)


def test_duration_and_height_are_held(commands, drawn):
    low, high = commands.random.hold_steps
    changes = np.flatnonzero(np.diff(drawn[:, [DURATION, FOOT_HEIGHT]], axis=0).any(axis=1))
    assert np.diff(changes).min() >= low
    assert STEPS / (len(changes) + 1) < 2 * high


@pytest.mark.parametrize("kind", MOVING)
def test_each_kind_moves_only_what_it_says(commands, kind):
    law = commands.random.model_copy(update={"kinds": {kind: 1.0}})
    rows = random_commands(commands.model_copy(update={"random": law}), np.random.default_rng(2), STEPS)
    np.testing.assert_array_equal(rows[:, :DURATION].any(axis=0), MOVING[kind])
    if kind in ("forward", "backward"):
        assert (rows[:, STEP_X] * (1 if kind == "forward" else -1) >= 0).all()


def test_a_person_with_a_joystick_repeats_few_directions_for_long(commands):
    rows = random_commands(joystick_law(commands), np.random.default_rng(3), STEPS)
    held = {tuple(row) for row, after in pairwise(np.round(rows[:, :DURATION], 9)) if (row == after).all()}
    assert len(held - {(0.0, 0.0, 0.0)}) == 6  # ahead, back, to both sides, and turning both ways
    ends = np.array([commands.step_x_m, commands.step_y_m, np.deg2rad(commands.turn_deg)]).T
    np.testing.assert_allclose([rows[:, :DURATION].min(axis=0), rows[:, :DURATION].max(axis=0)], ends)


def test_every_kind_of_the_configuration_is_known(commands):
    assert set(get_args(get_args(RandomCommands.model_fields["kinds"].annotation)[0])) == set(MOVING)
    assert sum(commands.random.kinds.values()) == pytest.approx(1)
