"""Points of any limb's links, where something may push: what a force there does to the joints, and which one is felt.

Of a limb without a side that is likelier than another, forces act along the axes of the point's body, both ways.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.detection.detector import GateSignal, run_over
from mobnet.detection.leg import unit_torques
from mobnet.detection.watch import LegSetup, LimbSetup
from mobnet.formats.parts import PointRow
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import carrier_of, point_torque

AXES = "xyz"


# Section 5.4 takes thresholds for an indirect estimate of what a detector can feel. This is that estimate: the torques
# of a push of 1 N follow from the pose, and what the filters leave of a short one from the filters
# (docs/notes/detection.md).
def found_forces(setup: LegSetup, poses: Array, thresholds: Array) -> dict[str, float]:
    """Return point of the leg -> the force [N] that a short collision must have there, in most poses of a swing.

    Poses (T, nq) [m, -, rad] are those in which the leg is watched, thresholds (T, 6) [N m] those of its joints there.
    """
    numbers = setup.detection.sensitivity
    robot = setup.robot
    points = [row.name for row in robot.points if row.name.startswith(f"{setup.side}_") and row.name.count("_") == 2]
    picked = some_rows(len(poses), numbers.poses)
    left = attenuation(setup)
    units = [unit_torques(robot, setup.gate.leg, q, points, setup.inward) for q in poses[picked]]
    forces = [smallest_forces(*pair, left) for pair in zip(units, thresholds[picked], strict=True)]
    return dict(zip(points, np.quantile(forces, numbers.share, axis=0).tolist(), strict=True))


def some_rows(count: int, most: int) -> NDArray[np.intp]:
    """Return rows of poses (k,), evenly apart: neighbours differ little, and a few hundred have the same quantile."""
    return np.linspace(0, count - 1, min(most, count)).astype(np.intp)


def smallest_forces(units: Array, thresholds: Array, attenuation: float) -> Array:
    """Return the least force of each of k pushes that brings a joint over its threshold (k,) [N], (D12).

    Units (k, 6) are as in `name_push`, thresholds (6,) those of the joints [N m]; of a push that lasts as long as a
    collision, filters leave the share `attenuation`.
    """
    # The joint that crosses first counts. The floor is for joints that the push does not load.
    return (thresholds / (attenuation * np.maximum(np.abs(units), 1e-9))).min(axis=1)


def attenuation(setup: LimbSetup) -> float:
    """Return what the filters leave of the peak of a half-sine of a collision's length [-]."""
    count = round(setup.detection.sensitivity.contact_s * setup.rate_hz)
    # (D11): the low-pass is highest only after the peak of the force, so that the run goes on beyond its end.
    hit = np.sin(np.pi * np.arange(2 * count) / count)[:, None] * (np.arange(2 * count) < count)[:, None]
    always = GateSignal(np.ones(len(hit), dtype=bool), np.zeros(len(hit)))
    return float(run_over(setup.chain(np.ones((1, 1))), np.ascontiguousarray(hit), always).ratio.max())


# A force F at a point turns the joints above it by F g, where g (6,) is known of each point and direction. Of all
# candidates that one is taken whose g explains most of the estimated torque, in units of what this does in free
# walking.
class IsolatedPush(NamedTuple):
    """The candidate that explains a torque best, counted from 0, and its force [N]."""

    candidate: int
    force_n: float


def name_push(torque: NDArray[Any], units: Array, whitening: Array) -> IsolatedPush:
    """Return which of k pushes explains the torque of the joints (6,) [N m].

    Units (k, 6) are the torques of 1 N of each [N m/N]; the whitening (6, 6) is that of the torque in free walking. A
    push cannot pull; where none explains anything, the first one has a force of zero.
    """
    # (D10): least squares of one unknown, the force. Whitened, as an error of 5 N m says nothing at a hip that is wrong
    # by as much in every step, and everything at an ankle.
    seen = whitening @ torque
    expected = units @ whitening.T
    sizes = np.maximum((expected**2).sum(axis=1), 1e-12)
    # A push cannot pull: the best force of a candidate that explains the torque with the wrong sign is zero.
    forces = np.maximum(expected @ seen / sizes, 0.0)
    best = int(np.argmax(forces**2 * sizes))
    return IsolatedPush(best, float(forces[best]))


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
    torques = list[Array]()
    for row in points:
        for axis in range(len(AXES)):
            push = np.zeros((len(q), 6))
            push[:, axis] = 1.0
            torques.append(point_torque(nominal, row.body, row.pos, np.eye(3), q, push)[:, columns])
    return np.stack(torques, axis=1) if torques else np.zeros((len(q), 0, len(columns)))


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
    return {
        row.name: np.where(of_point, force, np.inf) for row, of_point, force in zip(points, heard, most, strict=True)
    }


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
    push = name_push(torque, np.concatenate([units, -units]), np.diag(1.0 / scale))
    sign, place = divmod(push.candidate, len(units))
    row = points[place // len(AXES)]
    return EstimatedPush(row.name, row.body, f"{'+-'[sign]}{AXES[place % len(AXES)]}", push.force_n)
