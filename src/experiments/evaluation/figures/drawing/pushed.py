"""A robot that is pushed, on its ground with its shadow, and the force as an arrow. Drawing only."""

from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrow
from numpy.typing import NDArray

from experiments.evaluation.figures.drawing.ground import draw_ground, draw_shadow
from experiments.evaluation.figures.drawing.robot import lowest, point_at, solids_of
from experiments.evaluation.figures.drawing.solids import draw_solids
from mobnet.core.arrays import Array
from mobnet.robot.description import RobotDescription

PUSH, FELT = "#C1121F", "#E07A5F"  # the arrow, and a link that a detector names
ARROW_M_N, WIDTH_M = 0.0024, 0.022  # length of an arrow for each newton, and width of its shaft
BESIDE_M = 0.12  # from the arrow's end to the middle of its text
LEAST_N = 8.0  # of a force that has an arrow
FLOOR_M = 0.62  # radius of the floor


def standing(robot: RobotDescription, q: NDArray[Any]) -> Array:
    """Return a position q (nq,) [m, -, rad] with the robot's lowest point on the ground: the sensed height drifts."""
    placed = np.array(q, dtype=np.float64)
    placed[2] -= lowest(robot, placed)
    return placed


def draw_pushed(
    axis: Axes, robot: RobotDescription, q: Array, centre: Array, view: Array, *, point: str, force: Array, felt: str
) -> None:
    """Draw a robot at a position q (nq,) [m, -, rad] and a force (3,) [N] at a point of it into axes in metres.

    The floor is about `centre` (3,) [m]; the link of the point `felt`, if it is not empty, has a colour of its own.
    """
    bodies = {row.name: row.body for row in robot.points}
    solids = [
        replace(solid, colour=FELT) if felt and solid.shape.body == bodies[felt] else solid
        for solid in solids_of(robot, q)
    ]
    draw_ground(axis, centre, FLOOR_M, view)
    draw_shadow(axis, solids, view)
    draw_solids(axis, solids, view)
    if np.linalg.norm(force) > LEAST_N:
        draw_force(axis, point_at(robot, q, point), force, view)


def draw_force(axis: Axes, place: Array, force: Array, view: Array, beside_m: float = BESIDE_M) -> None:
    """Draw a force (3,) [N] at a place (3,) [m] as an arrow that ends there, with its size so far behind [m]."""
    (x, y) = view[:2] @ place
    (from_x, from_y) = view[:2] @ (place - ARROW_M_N * force)
    arrow = FancyArrow(
        from_x,
        from_y,
        x - from_x,
        y - from_y,
        width=WIDTH_M,
        head_width=3.2 * WIDTH_M,
        head_length=3.6 * WIDTH_M,
        length_includes_head=True,
        facecolor=PUSH,
        edgecolor="white",
        linewidth=0.8,
        zorder=6,
    )
    axis.add_patch(arrow)
    beside = (np.array([from_x, from_y]) - (x, y)) / max(float(np.hypot(x - from_x, y - from_y)), WIDTH_M)
    text_x, text_y = np.array([from_x, from_y]) + beside_m * beside
    size = f"{np.linalg.norm(force):.0f} N"
    axis.text(text_x, text_y, size, color=PUSH, ha="center", va="center", fontweight="bold", zorder=6)
