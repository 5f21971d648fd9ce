"""Reacting footsteps, section 7: away from what pushes (CSP), or back the way the robot came (RSP).

Steps are commands (n, 5) like those of Table 2, the first of them for the step that is being made. World axes; a foot
is its ankle's place x, y [m] and its yaw [rad].
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mobnet.control.geometry import wrap
from mobnet.control.steps import DURATION, STEP_X, STEP_Y, TURN
from mobnet.core.arrays import Array
from mobnet.reaction.numbers import CompliantNumbers, FirstStepNumbers


@dataclass(frozen=True)
class Stance:
    """How the robot stands when it reacts.

    Attributes:
        foot: of the leg that carries it (3,) [m, m, rad].
        side: 1 if that is the left one, else -1.
        swing: place of the other ankle (2,) [m].
        height_m: its height over the stance ankle [m].
        landing_s: time until it should land [s]; infinite if it has not been lifted yet.
    """

    foot: Array
    side: float
    swing: Array
    height_m: float
    landing_s: float

    @property
    def ahead_m(self) -> float:
        """How far the swing foot is ahead of the stance foot [m]."""
        return float(turned(self.swing - self.foot[:2], -self.foot[2])[0])

    def landing_m(self, numbers: FirstStepNumbers) -> float:
        """Return how far ahead of the stance foot the swing foot lands at least [m], less than zero behind it."""
        return -np.inf if np.isinf(self.landing_s) else min(self.ahead_m, -numbers.behind_m)

    def reach_m(self, numbers: FirstStepNumbers) -> float:
        """Return how far the swing foot may be sent elsewhere [m]."""
        if np.isinf(self.landing_s):
            return np.inf
        return max(0.0, min(numbers.height_ratio * self.height_m, numbers.foot_speed_m_s * self.landing_s))

    def clear_m(self, numbers: FirstStepNumbers) -> float:
        """Return how far from where it is the swing foot lands at least [m], as far as the time that is left allows."""
        return max(0.0, min(numbers.clear_m, numbers.foot_speed_m_s * self.landing_s))


def compliant_steps(
    numbers: CompliantNumbers,
    first: FirstStepNumbers,
    stance: Stance,
    direction: Array,
    command: Array,
    spacing_m: float,
) -> Array:
    """Return steps along a direction (2,), Figure 21; duration and foot height are those of a command (5,).

    A foot in the air goes on from where it is, no further than it can be sent, and not too far behind the stance foot;
    but it always lands clear of where it is, which may be where it touched an obstacle.
    """
    rows = np.tile(command, (numbers.steps, 1))
    rows[:, STEP_X], rows[:, STEP_Y] = numbers.step_m * turned(direction, -stance.foot[2])
    rows[:, TURN] = 0.0
    if np.isfinite(stance.landing_s):
        clear = stance.clear_m(first)
        way = max(clear, min(numbers.step_m, stance.reach_m(first)))
        goal = np.append(stance.swing + way * direction, stance.foot[2])
        rows[0] = step_to(goal, stance.foot, stance.side, command, spacing_m)
        rows[0, STEP_X] = max(rows[0, STEP_X], min(stance.ahead_m - clear, stance.landing_m(first)))
    return rows


def rewound_steps(
    kept: Sequence[Array],
    count: int,
    step_m: float,
    first: FirstStepNumbers,
    stance: Stance,
    command: Array,
    spacing_m: float,
) -> Array:
    """Return steps on the last footsteps that are kept, backwards; each foot of `kept` (3,) stood before the next one.

    The swing foot returns towards where it stood last, but no further than it can be sent; the other one to where it
    stood before, and so on. A robot that has made no step yet steps in place.
    """
    rows = list[Array]()
    foot = stance.foot
    side = stance.side
    for goal in list(reversed(kept))[:count]:
        if not rows:
            way = goal[:2] - stance.swing
            length = float(np.hypot(*way))
            share = min(1.0, stance.reach_m(first) / length if length else 1.0)
            goal = np.append(stance.swing + share * way, goal[2])
        row = step_to(goal, foot, side, command, spacing_m)
        # The robot still moves the other way, so that it goes back in shorter steps; a foot may stay where it is.
        least, most = (-step_m, step_m) if rows else (stance.landing_m(first), max(step_m, stance.ahead_m))
        row[STEP_X] = min(max(row[STEP_X], least), most)
        rows.append(row)
        foot = goal
        side = -side
    return np.array(rows) if rows else in_place(command, 1)


def step_to(goal: Array, foot: Array, side: float, command: Array, spacing_m: float) -> Array:
    """Return the command (5,) that brings a swing foot to a goal (3,) beside the stance foot (3,) of a side.

    A command knows outward steps alone: a goal nearer to the stance foot than spacing_m [m] is passed by (W5).
    """
    row = command.copy()
    place = turned(goal[:2] - foot[:2], -foot[2])
    row[STEP_X], row[STEP_Y], row[TURN] = place[0], place[1] + side * spacing_m, wrap(goal[2] - foot[2])
    return row


def in_place(command: Array, count: int) -> Array:
    """Return steps in place with the duration and foot height of a command (5,)."""
    rows = np.tile(command, (count, 1))
    rows[:, :DURATION] = 0.0
    return rows


def turned(vector: Array, yaw: float) -> Array:
    """Return a vector (2,) turned by yaw [rad]."""
    c = np.cos(yaw)
    n = np.sin(yaw)
    return np.array([c * vector[0] - n * vector[1], n * vector[0] + c * vector[1]])
