"""A robot at a position as a picture: where its solids and its points are. Drawing only."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from experiments.evaluation.figures.drawing.solids import Solid, draw_solids
from mobnet.control.kinematics import empty_pose, tree_of, update
from mobnet.core.arrays import Array
from mobnet.core.joints import N_VIRTUAL
from mobnet.robot.description import RobotDescription


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


def place_of(robot: RobotDescription, q: NDArray[Any], name: str) -> Array:
    """Return where a point of the robot is (3,) [m] at a position q (nq,) [m, -, rad]."""
    row = next(row for row in robot.points if row.name == name)
    rotation, position = poses_of(robot, q)
    return position[row.body] + rotation[row.body] @ np.asarray(row.pos)


def lowest(robot: RobotDescription, q: NDArray[Any]) -> float:
    """Return the height of a robot's lowest point at a position q (nq,) [m]."""
    return min(solid.lowest for solid in solids_of(robot, q))
