"""A robot and what it walks into as pictures, with the force of the obstacle as an arrow. Drawing only."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes

from experiments.evaluation.figures.drawing.robot import solids_of
from experiments.evaluation.figures.drawing.solids import Solid, draw_solids
from mobnet.core.arrays import Array
from mobnet.core.course import StoredCourse
from mobnet.robot.description import RobotDescription
from mobnet.settings.data import Obstacle, ObstaclePart
from mobnet.settings.parts import ShapeRow

PAD = "#E3B7A0"
FORCE = "#D55E00"
ARROW_M_N = 0.002  # length of an arrow for each newton
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def draw_scene(
    axis: Axes, robot: RobotDescription, obstacles: Mapping[str, Obstacle], course: StoredCourse, k: int, view: Array
) -> None:
    """Draw a sample of a walk into axes in metres: robot, obstacles, ground, and an arrow to where they touch."""
    draw_solids(axis, [*solids_of(robot, course.q[k]), *obstacle_solids(obstacles, course)], view)
    axis.axhline(0.0, color="0.6", linewidth=0.6, zorder=0)
    if course.point[k].any():
        draw_force(axis, course.point[k], course.force[k], view)


def draw_force(axis: Axes, point: Array, force: Array, view: Array) -> None:
    """Draw a force (3,) [N] at a point (3,) [m] as an arrow that ends there."""
    (x, y, _), (from_x, from_y, _) = ((view @ place).tolist() for place in (point, point - ARROW_M_N * force))
    draw_arrow(axis, (from_x, from_y), (x, y))


def draw_arrow(axis: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    """Draw the arrow of a force from one place of the picture to another [m]."""
    look = {"arrowstyle": "-|>", "color": FORCE, "linewidth": 1.6, "shrinkA": 0.0, "shrinkB": 0.0}
    axis.annotate("", end, start, zorder=5, arrowprops=look)


def obstacle_solids(obstacles: Mapping[str, Obstacle], course: StoredCourse) -> list[Solid]:
    """Return the solids of the obstacles of a walk, where they stood."""
    places = course.note["obstacles"]
    return [solid_of(part, place) for name, place in places.items() for part in obstacles[name].parts]


def solid_of(part: ObstaclePart, place: Sequence[float]) -> Solid:
    """Return a part of an obstacle at its place (3,) [m]."""
    like = {"name": "part", "body": "world", "type": part.type, "tone": "", "pos": (0.0, 0.0, 0.0), "segment": None}
    if part.type == "box":
        own = {"size": part.size, "pos": part.pos}
    else:
        reach = part.size[1] * np.array(AXES[part.axis])
        own = {"size": part.size[:1], "segment": (*(np.array(part.pos) - reach), *(np.array(part.pos) + reach))}
    return Solid(ShapeRow.model_construct(**{**like, **own}), np.eye(3), np.asarray(place), PAD)
