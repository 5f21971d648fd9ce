"""Commands stay in Table 2 and change at the limited rate."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mobnet.control.commands import COMMAND_FIELDS, MOVING, fixed_commands, random_commands
from mobnet.control.parameters import DURATION, FOOT_HEIGHT, STEP_X, STEP_Y, TURN
from mobnet.core.errors import ConfigError

FIXED = {"step_x_m": 0.2, "step_y_m": 0.1, "turn_deg": 10.0, "duration_s": 0.7, "foot_height_m": 0.055}
STEPS = 3000


@pytest.fixture
def settings(full_config: dict[str, Any]) -> dict[str, Any]:
    return full_config["commands"]


@pytest.fixture
def drawn(settings: dict[str, Any]) -> np.ndarray:
    return random_commands(settings, np.random.default_rng(1), STEPS)


def only(settings: dict[str, Any], kind: str) -> np.ndarray:
    """Return commands of one kind of walking."""
    law = {**settings["random"], "kinds": {kind: 1.0}}
    return random_commands({**settings, "random": law}, np.random.default_rng(2), STEPS)


def test_fixed_command_is_repeated_after_steps_in_place() -> None:
    rows = fixed_commands(FIXED, 3)
    assert rows.shape == (4, len(COMMAND_FIELDS))
    np.testing.assert_allclose(rows[-1], [0.2, 0.1, np.deg2rad(10), 0.7, 0.055])
    np.testing.assert_array_equal(rows[:3, :DURATION], 0)
    np.testing.assert_array_equal(rows[:3, DURATION:], np.tile([0.7, 0.055], (3, 1)))


@pytest.mark.parametrize("key", ["step_z_m", "turn_deg"])
def test_unknown_and_missing_fields_are_named(key: str) -> None:
    command = dict(FIXED)
    if command.pop(key, None) is None:
        command[key] = 0.0
    with pytest.raises(ConfigError, match=f"command: key: '{key}' is not accepted"):
        fixed_commands(command, 3)


def test_random_commands_stay_in_table_2(settings: dict[str, Any], drawn: np.ndarray) -> None:
    ranges = {STEP_X: settings["step_x_m"], STEP_Y: settings["step_y_m"], TURN: np.deg2rad(settings["turn_deg"])}
    for column, (low, high) in ranges.items():
        assert drawn[:, column].min() == pytest.approx(low)  # the edges are reached
        assert drawn[:, column].max() == pytest.approx(high)
    assert set(drawn[:, DURATION]) == set(settings["duration_s"])
    assert set(drawn[:, FOOT_HEIGHT]) == set(settings["foot_height_m"])


def test_random_commands_change_at_the_limited_rate(settings: dict[str, Any], drawn: np.ndarray) -> None:
    law = settings["random"]
    slew = [law["slew_step_x_m"], law["slew_step_y_m"], np.deg2rad(law["slew_turn_deg"])]
    assert (np.abs(np.diff(drawn[:, :DURATION], axis=0)).max(axis=0) <= np.array(slew) + 1e-12).all()
    np.testing.assert_array_equal(drawn[: law["in_place_steps"], :DURATION], 0)


def test_duration_and_height_are_held(settings: dict[str, Any], drawn: np.ndarray) -> None:
    low, high = settings["random"]["hold_steps"]
    changes = np.flatnonzero(np.diff(drawn[:, [DURATION, FOOT_HEIGHT]], axis=0).any(axis=1))
    held = np.diff(changes)
    assert held.min() >= low
    assert STEPS / (len(changes) + 1) < 2 * high


@pytest.mark.parametrize("kind", MOVING)
def test_each_kind_moves_only_what_it_says(settings: dict[str, Any], kind: str) -> None:
    rows = only(settings, kind)
    np.testing.assert_array_equal(rows[:, :DURATION].any(axis=0), MOVING[kind])
    if kind in ("forward", "backward"):
        assert (rows[:, STEP_X] * (1 if kind == "forward" else -1) >= 0).all()


def test_every_kind_of_the_configuration_is_known(settings: dict[str, Any]) -> None:
    assert set(settings["random"]["kinds"]) == set(MOVING)
    assert sum(settings["random"]["kinds"].values()) == pytest.approx(1)


def test_same_generator_draws_the_same_commands(settings: dict[str, Any], drawn: np.ndarray) -> None:
    np.testing.assert_array_equal(random_commands(settings, np.random.default_rng(1), STEPS), drawn)
