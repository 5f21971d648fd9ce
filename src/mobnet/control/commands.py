"""Walking commands, one row a step: one command repeated, or random ones over Table 2 in place of a joystick."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.control.parameters import DURATION, FOOT_HEIGHT, STEP_X, TURN
from mobnet.core.errors import ConfigError, not_accepted

Array = NDArray[np.float64]
COMMAND_FIELDS = ("step_x_m", "step_y_m", "turn_deg", "duration_s", "foot_height_m")
MOVING = {  # which of step x, step y and turn a kind of walking uses
    "omnidirectional": (True, True, True),
    "forward": (True, False, False),
    "backward": (True, False, False),
    "turn": (False, False, True),
    "sideways": (False, True, False),
}


def fixed_commands(command: Mapping[str, float], in_place_steps: int) -> Array:
    """Return the rows (n, 5) of one command repeated, after a few steps in place [m, m, rad, s, m].

    Raises:
        ConfigError: a field is missing or unknown.
    """
    for key in set(command) ^ set(COMMAND_FIELDS):
        raise ConfigError(not_accepted("command: key", key, COMMAND_FIELDS))
    row = np.array([float(command[name]) for name in COMMAND_FIELDS])
    row[TURN] = np.deg2rad(row[TURN])
    rows = np.tile(row, (in_place_steps + 1, 1))
    rows[:in_place_steps, :DURATION] = 0.0
    return rows


def random_commands(settings: Mapping[str, Any], rng: np.random.Generator, steps: int) -> Array:
    """Draw commands (steps, 5) over Table 2 [m, m, rad, s, m], held for some steps and changed at a limited rate.

    The edges of the ranges are drawn often: networks are asked about them (a straight walk at full step length) and
    extrapolate badly.
    """
    ranges = _ranges(settings)
    law = settings["random"]
    slew = np.array([law["slew_step_x_m"], law["slew_step_y_m"], np.deg2rad(law["slew_turn_deg"])])
    rows, goal, left = np.zeros((steps, len(COMMAND_FIELDS))), np.zeros(len(COMMAND_FIELDS)), 0
    current = np.zeros(DURATION)
    for k in range(steps):
        if left == 0:
            goal = _draw_goal(settings, ranges, rng)
            left = int(rng.integers(law["hold_steps"][0], law["hold_steps"][1] + 1))
        left -= 1
        if k >= law["in_place_steps"]:
            current = current + np.clip(goal[:DURATION] - current, -slew, slew)
        rows[k, :DURATION] = current
        rows[k, DURATION:] = goal[DURATION:]
    return rows


def _ranges(settings: Mapping[str, Any]) -> Array:
    """Return lower and upper bounds (3, 2) of step x, step y [m] and turn [rad]."""
    return np.array([settings["step_x_m"], settings["step_y_m"], np.deg2rad(settings["turn_deg"])])


def _draw_goal(settings: Mapping[str, Any], ranges: Array, rng: np.random.Generator) -> Array:
    """Draw one command (5,) to hold."""
    law = settings["random"]
    kinds = list(law["kinds"])
    kind = str(rng.choice(kinds, p=[law["kinds"][name] for name in kinds]))
    low, high = ranges[:, 0].copy(), ranges[:, 1].copy()
    if kind == "forward":
        low[STEP_X] = 0.0
    if kind == "backward":
        high[STEP_X] = 0.0
    drawn = rng.uniform(low, high)
    edges = np.where(rng.random(DURATION) < 0.5, low, high)
    if kind == "forward":
        edges[STEP_X] = high[STEP_X]
    if kind == "backward":
        edges[STEP_X] = low[STEP_X]
    drawn = np.where(rng.random(DURATION) < law["edge_probability"], edges, drawn)
    goal = np.zeros(len(COMMAND_FIELDS))
    goal[:DURATION] = np.where(MOVING[kind], drawn, 0.0)
    goal[DURATION], goal[FOOT_HEIGHT] = rng.choice(settings["duration_s"]), rng.choice(settings["foot_height_m"])
    return goal
