"""Points of any limb's links, where something may push: what a force there does to the joints, and which one is felt.

Of a limb without a side that is likelier than another, forces act along the axes of the point's body, both ways.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mobnet.core.arrays import Array
from mobnet.detection.isolation import name_push
from mobnet.detection.sensitivity import attenuation, smallest_forces, some_rows
from mobnet.detection.watch import LimbSetup
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import carrier_of, point_torque
from mobnet.settings.parts import PointRow

AXES = "xyz"


@dataclass(frozen=True)
class EstimatedPush:
    """The push that explains the torques of a limb best: its point, the body of that, direction and force [N]."""

    point: str
    body: str
    direction: str
    force_n: float


def points_of(robot: RobotDescription, joints: Sequence[str]) -> list[PointRow]:
    """Return the points of a robot that some joints move."""
    return [row for row in robot.points if carrier_of(robot, row.body)[0] in joints]


def axis_torques(nominal: NominalModel, joints: Sequence[str], points: Sequence[PointRow], q: Array) -> Array:
    """Return what 1 N along each axis of the body of each point does to joints (T, 3 points, n) [N m/N] at (T, nq)."""
    columns = nominal.robot.layout.columns(joints)
    found = list[Array]()
    for row in points:
        for axis in range(len(AXES)):
            push = np.zeros((len(q), 6))
            push[:, axis] = 1.0
            found.append(point_torque(nominal, row.body, row.pos, np.eye(3), q, push)[:, columns])
    return np.stack(found, axis=1) if found else np.zeros((len(q), 0, len(columns)))


def axis_forces(setup: LimbSetup, nominal: NominalModel, poses: Array, thresholds: Array) -> dict[str, Array]:
    """Return point -> the least force along each axis of its body that is found in most poses (3,) [N].

    Poses (T, nq) are those in which the limb is watched, thresholds (T, n) [N m] those of its joints there. What no
    joint feels is infinite.
    """
    numbers = setup.detection.sensitivity
    points = points_of(setup.robot, setup.joints)
    picked = some_rows(len(poses), numbers.poses)
    left = attenuation(setup)
    units = axis_torques(nominal, setup.joints, points, np.asarray(poses[picked], dtype=np.float64))
    forces = np.array([smallest_forces(*pair, left) for pair in zip(units, thresholds[picked], strict=True)])
    most = np.quantile(forces, numbers.share, axis=0).reshape(len(points), len(AXES))
    heard = np.abs(units).max(axis=(0, 2), initial=0.0).reshape(most.shape) > 1e-6
    return {row.name: np.where(own, force, np.inf) for row, own, force in zip(points, heard, most, strict=True)}


def felt_push(
    nominal: NominalModel, joints: Sequence[str], q: Array, torque: Array, scale: Array
) -> EstimatedPush | None:
    """Return which push explains torques (n,) [N m] of joints best at a position (nq,); none of a limb without points.

    The scale (n,) [N m] is what the torques are in free motion, such as their thresholds.
    """
    points = points_of(nominal.robot, joints)
    if not points:
        return None
    (units,) = axis_torques(nominal, joints, points, np.asarray(q, dtype=np.float64)[None])
    # A push has a sign, which its two directions tell.
    found = name_push(torque, np.concatenate([units, -units]), np.diag(1.0 / scale))
    sign, place = divmod(found.candidate, len(units))
    row = points[place // len(AXES)]
    return EstimatedPush(row.name, row.body, f"{'+-'[sign]}{AXES[place % len(AXES)]}", found.force_n)
