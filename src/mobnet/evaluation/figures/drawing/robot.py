"""A robot at a position as a picture: where its solids and its points are. Drawing only."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from mobnet.control.kinematics import empty_pose, tree_of, update
from mobnet.core.arrays import Array
from mobnet.core.joints import N_VIRTUAL
from mobnet.evaluation.figures.drawing.solids import Solid, draw_solids
from mobnet.robot.description import RobotDescription
from mobnet.settings.parts import ShapeRow

RINGS, POINTS = 7, 14  # of a round solid


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
    pose, names = empty_pose(tree), [body.name for body in robot.bodies]
    update(tree, np.asarray(q, dtype=np.float64), np.zeros(N_VIRTUAL + len(tree.body_of_joint)), 0.0, pose)
    return dict(zip(names, pose.rotation, strict=True)), dict(zip(names, pose.position, strict=True))


def place_of(robot: RobotDescription, q: NDArray[Any], name: str) -> Array:
    """Return where a point of the robot is (3,) [m] at a position q (nq,) [m, -, rad]."""
    row = next(row for row in robot.points if row.name == name)
    rotation, position = poses_of(robot, q)
    return position[row.body] + rotation[row.body] @ np.asarray(row.pos)


def lowest(robot: RobotDescription, q: NDArray[Any]) -> float:
    """Return the height of a robot's lowest point at a position q (nq,) [m]."""
    return min(float(points[:, 2].min()) for points in surfaces_of(robot, q))


def surfaces_of(robot: RobotDescription, q: NDArray[Any]) -> list[Array]:
    """Return points on the surface of each solid of a robot at a position q (nq,), (n, 3) each [m]."""
    return [surface_of(solid.shape) @ solid.rotation.T + solid.position for solid in solids_of(robot, q)]


def surface_of(shape: ShapeRow) -> Array:
    """Return points on the surface of a solid (n, 3) [m], axes of its body."""
    size = shape.size
    if shape.segment is not None:
        start, end = np.reshape(shape.segment, (2, 3))
        ball = size[0] * _sphere() if shape.type == "capsule" else size[0] * _ring(end - start)
        return np.concatenate([start + ball, end + ball])
    if shape.type == "box":
        signs = np.array(np.meshgrid(*[(-1.0, 1.0)] * 3)).reshape(3, -1).T
        return np.asarray(shape.pos) + signs * size
    scale = np.asarray(size if len(size) == 3 else [size[0]] * 3)
    return np.asarray(shape.pos) + _sphere() * scale


def hull_of(points: Array) -> Array:
    """Return the corners of the convex hull of points (n, 2) in order (k, 2)."""
    from scipy.spatial import ConvexHull  # here, as it takes a second to import

    return points[ConvexHull(points).vertices]


def _sphere() -> Array:
    """Return points of a unit sphere (n, 3)."""
    up, around = np.meshgrid(np.linspace(0.0, np.pi, RINGS), np.linspace(0.0, 2 * np.pi, POINTS, endpoint=False))
    return np.stack([np.sin(up) * np.cos(around), np.sin(up) * np.sin(around), np.cos(up)], axis=-1).reshape(-1, 3)


def _ring(axis: Array) -> Array:
    """Return points of a unit circle about an axis (n, 3)."""
    along = axis / np.linalg.norm(axis)
    first = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    first = np.asarray(first / np.linalg.norm(first), dtype=np.float64)
    second, angle = np.cross(along, first), np.linspace(0.0, 2 * np.pi, POINTS, endpoint=False)[:, None]
    return np.asarray(np.cos(angle) * first + np.sin(angle) * second, dtype=np.float64)
