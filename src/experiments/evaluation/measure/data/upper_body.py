"""How the upper body moved in recordings: hand speeds and the joint ranges visited."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from experiments.evaluation.measure.data.steps import Array
from mobnet.core.columns import recording_columns
from mobnet.core.joints import N_VIRTUAL, NQ_BASE
from mobnet.core.store import read_array
from mobnet.robot.description import SIDES, RobotDescription
from mobnet.robot.frames import POSITION, QUATERNION, to_pinocchio
from mobnet.robot.nominal import NominalModel

LIMBS = ("W", "LA", "RA")


def hand_speeds(nominal: NominalModel, q: NDArray[Any], v: NDArray[Any]) -> Array:
    """Return the speed of both hands against the pelvis (T, 2) [m/s], left and then right.

    Generalized positions are (T, nq) [m], [-], [rad], velocities (T, nv) [m/s], [rad/s].
    """
    robot = nominal.robot
    model = nominal.model
    data = nominal.data
    points = {point.name: point for point in robot.points}
    hands = [points[f"{side}_hand"] for side in SIDES]
    carrier = {joint.body: joint.id for joint in robot.joints}
    joints = [model.getJointId(carrier[hand.body]) for hand in hands]
    posture = to_pinocchio(q)
    velocity = np.array(v, dtype=np.float64)
    # A pelvis at rest in the origin: what remains is the motion against it.
    posture[:, POSITION] = 0.0
    posture[:, QUATERNION] = (0.0, 0.0, 0.0, 1.0)
    velocity[:, :N_VIRTUAL] = 0.0
    twist = np.zeros((len(q), len(hands), 6))
    for row in range(len(q)):
        pin.forwardKinematics(model, data, posture[row], velocity[row])
        for side, joint in enumerate(joints):
            twist[row, side] = data.v[joint].vector
    arm = np.array([hand.pos for hand in hands])
    return np.linalg.norm(twist[..., :3] + np.cross(twist[..., 3:], arm), axis=-1)


def upper_body(every: int, stems: Sequence[Path], nominal: NominalModel) -> Iterator[tuple[str, str, float, str]]:
    """Yield quantity, part, value and unit: hand speeds against the pelvis [m/s] and joint ranges visited [rad].

    Every `every`-th sample of the recordings is looked at.
    """
    layout = nominal.robot.layout
    columns = recording_columns(layout)
    names: list[str] = []
    for field in ("q", "v"):
        names += [name for name, _, _ in columns[field]]
    speeds = []
    lows = []
    highs = []
    for stem in stems:
        q, v = np.split(read_array(stem, names)[0][::every], [layout.nq], axis=1)
        speeds.append(hand_speeds(nominal, q, v))
        lows.append(q[:, NQ_BASE:].min(axis=0))
        highs.append(q[:, NQ_BASE:].max(axis=0))
    speed = np.concatenate(speeds)
    for k, side in enumerate(SIDES):
        yield "mean hand speed", side, float(speed[:, k].mean()), "m/s"
        yield "largest hand speed", side, float(speed[:, k].max()), "m/s"
    yield from joint_ranges(nominal.robot, np.min(lows, axis=0), np.max(highs, axis=0))


def joint_ranges(
    robot: RobotDescription, low: NDArray[Any], high: NDArray[Any]
) -> Iterator[tuple[str, str, float, str]]:
    """Yield what joints above the legs visit of the range between their limits, limb by limb and joint by joint.

    Low and high are the smallest and largest positions (nu,) [rad].
    """
    bounds = np.array([joint.range for joint in robot.joints])
    share = (high - low) / (bounds[:, 1] - bounds[:, 0])
    for limb in LIMBS:
        columns = [robot.layout.actuated.index(joint) for joint in robot.layout.limb(limb)]
        yield "joint range visited", f"limb {limb}", float(share[columns].mean()), "-"
        for k in columns:
            joint = robot.layout.actuated[k]
            yield "joint range visited", joint, float(share[k]), "-"
            yield "smallest position", joint, float(low[k]), "rad"
            yield "largest position", joint, float(high[k]), "rad"
            yield "lower limit", joint, float(bounds[k, 0]), "rad"
            yield "upper limit", joint, float(bounds[k, 1]), "rad"
