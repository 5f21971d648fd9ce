"""A robot at a position as a picture: where its solids and its points are. Drawing only."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from experiments.evaluation.figures.drawing.solids import Solid, draw_solids
from experiments.records.course import StoredCourse
from mobnet.control.kinematics import empty_pose, tree_of, update
from mobnet.core.arrays import Array
from mobnet.core.joints import N_VIRTUAL
from mobnet.formats.parts import ShapeRow
from mobnet.robot.description import RobotDescription
from mobnet.settings.data import Obstacle, ObstaclePart

PAD, OPACITY = "#E3B7A0", 0.55  # of obstacles, through which a leg that touches them is seen
FORCE = "#D55E00"
ARROW_M_N = 0.002  # length of an arrow for each newton
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


def projection(azimuth_deg: float, elevation_deg: float) -> Array:
    """Return the axes of a picture (3, 3) in the robot's: right, up, and towards the eye."""
    a, e = np.deg2rad([azimuth_deg, elevation_deg])
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return np.stack([right, np.cross(towards, right), towards])


def draw_robot(axis: Axes, robot: RobotDescription, q: NDArray[Any], view: Array) -> None:
    """Draw a robot at a position q (nq,) [m, -, rad] into axes in metres; the view is that of `projection`."""
    draw_solids(axis, solids_of(robot, q), view)


def solids_of(robot: RobotDescription, q: NDArray[Any]) -> list[Solid]:
    """Return the solids of a robot at a position q (nq,) [m, -, rad]."""
    rotation, position = poses_of(robot, q)
    return [
        Solid(shape, rotation[shape.body], position[shape.body], robot.tones[shape.tone][:3]) for shape in robot.shapes
    ]


def poses_of(robot: RobotDescription, q: NDArray[Any]) -> tuple[dict[str, Array], dict[str, Array]]:
    """Return the orientation (3, 3) and the origin (3,) [m] of each body at a position q (nq,) [m, -, rad]."""
    tree = tree_of(robot, 1.0)
    pose = empty_pose(tree)
    names = [body.name for body in robot.bodies]
    update(tree, np.asarray(q, dtype=np.float64), np.zeros(N_VIRTUAL + len(tree.body_of_joint)), 0.0, pose)
    return dict(zip(names, pose.rotation, strict=True)), dict(zip(names, pose.position, strict=True))


def point_at(robot: RobotDescription, q: NDArray[Any], name: str) -> Array:
    """Return where a point of the robot is (3,) [m] at a position q (nq,) [m, -, rad]."""
    row = next(row for row in robot.points if row.name == name)
    rotation, position = poses_of(robot, q)
    return position[row.body] + rotation[row.body] @ np.asarray(row.pos)


def lowest(robot: RobotDescription, q: NDArray[Any]) -> float:
    """Return the height of a robot's lowest point at a position q (nq,) [m]."""
    return min(solid.lowest for solid in solids_of(robot, q))


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
        shape = {"size": part.size, "pos": part.pos}
    else:
        reach = part.size[1] * np.array(AXES[part.axis])
        shape = {"size": part.size[:1], "segment": (*(np.array(part.pos) - reach), *(np.array(part.pos) + reach))}
    return Solid(ShapeRow.model_construct(**{**like, **shape}), np.eye(3), np.asarray(place), PAD, OPACITY)
