"""Walking commands, one row a step: one command repeated, or ones over Table 2 by a law, in place of a person."""

import numpy as np

from mobnet.control.steps import DURATION, FOOT_HEIGHT, STEP_X
from mobnet.core.arrays import Array
from mobnet.settings.data import Commands, FixedCommand

WIDTH = FOOT_HEIGHT + 1  # columns of a command
MOVING = {  # which of step x, step y and turn a kind of walking uses
    "omnidirectional": (True, True, True),
    "forward": (True, False, False),
    "backward": (True, False, False),
    "turn": (False, False, True),
    "sideways": (False, True, False),
}


def fixed_commands(command: FixedCommand, in_place_steps: int) -> Array:
    """Return the rows (n, 5) of one command repeated, after a few steps in place [m, m, rad, s, m]."""
    turn = np.deg2rad(command.turn_deg)
    row = np.array([command.step_x_m, command.step_y_m, turn, command.duration_s, command.foot_height_m])
    rows = np.tile(row, (in_place_steps + 1, 1))
    rows[:in_place_steps, :DURATION] = 0.0
    return rows


def random_commands(settings: Commands, rng: np.random.Generator, steps: int) -> Array:
    """Draw commands (steps, 5) over Table 2 [m, m, rad, s, m], held for some steps and changed at a limited rate.

    The edges of the ranges are drawn often: networks are asked about them (a straight walk at full step length) and
    extrapolate badly.
    """
    law = settings.random
    slew = np.array([law.slew_step_x_m, law.slew_step_y_m, np.deg2rad(law.slew_turn_deg)])
    rows = np.zeros((steps, WIDTH))
    goal = np.zeros(WIDTH)
    left = 0
    current = np.zeros(DURATION)
    for k in range(steps):
        if left == 0:
            goal = _draw_goal(settings, rng)
            left = int(rng.integers(law.hold_steps[0], law.hold_steps[1] + 1))
        left -= 1
        if k >= law.in_place_steps:
            current = current + np.clip(goal[:DURATION] - current, -slew, slew)
        rows[k, :DURATION] = current
        rows[k, DURATION:] = goal[DURATION:]
    return rows


def joystick_law(settings: Commands) -> Commands:
    """Return the ranges of Table 2 with the law of a person who aims at no variety."""
    return settings.model_copy(update={"random": settings.joystick})


def uniform_law(settings: Commands) -> Commands:
    """Return the ranges of Table 2 with a law that draws every component evenly over its range."""
    law = settings.random.model_copy(update={"kinds": {"omnidirectional": 1.0}, "edge_probability": 0.0})
    return settings.model_copy(update={"random": law})


def _draw_goal(settings: Commands, rng: np.random.Generator) -> Array:
    """Draw one command (5,) to hold."""
    law = settings.random
    kind = str(rng.choice(list(law.kinds), p=list(law.kinds.values())))
    low, high = np.array([settings.step_x_m, settings.step_y_m, np.deg2rad(settings.turn_deg)]).T
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
    drawn = np.where(rng.random(DURATION) < law.edge_probability, edges, drawn)
    goal = np.zeros(WIDTH)
    goal[:DURATION] = np.where(MOVING[kind], drawn, 0.0)
    goal[DURATION] = rng.choice(settings.duration_s)
    goal[FOOT_HEIGHT] = rng.choice(settings.foot_height_m)
    return goal
