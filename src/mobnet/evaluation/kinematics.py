"""Where feet and hands are, from recorded joint positions and the nominal model."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from mobnet.core.joints import N_VIRTUAL
from mobnet.robot.description import SIDES
from mobnet.robot.frames import POSITION, QUATERNION, to_pinocchio
from mobnet.robot.nominal import NominalModel

Array = NDArray[np.float64]


def ankle_places(nominal: NominalModel, q: NDArray[Any]) -> tuple[Array, Array]:
    """Return the ankles' positions (T, 2, 3) [m] in world and the feet's yaw (T, 2) [rad], left and then right.

    Args:
        nominal: the model; its masses do not matter here.
        q: generalized positions (T, nq) [m], [-], [rad].
    """
    robot, model, data = nominal.robot, nominal.model, nominal.data
    joints = [model.getJointId(robot.layout.limb(robot.feet[side].limb)[-1]) for side in SIDES]
    position, yaw = np.zeros((len(q), len(SIDES), 3)), np.zeros((len(q), len(SIDES)))
    for row, posture in enumerate(to_pinocchio(q)):
        pin.forwardKinematics(model, data, posture)
        for side, joint in enumerate(joints):
            place = data.oMi[joint]
            position[row, side] = place.translation
            yaw[row, side] = np.arctan2(place.rotation[1, 0], place.rotation[0, 0])
    return position, yaw


def hand_speeds(nominal: NominalModel, q: NDArray[Any], v: NDArray[Any]) -> Array:
    """Return the speed of both hands against the pelvis (T, 2) [m/s], left and then right.

    Args:
        nominal: the model.
        q: generalized positions (T, nq) [m], [-], [rad].
        v: generalized velocities (T, nv) [m/s], [rad/s].
    """
    robot, model, data = nominal.robot, nominal.model, nominal.data
    points = {point.name: point for point in robot.points}
    hands = [points[f"{side}_hand"] for side in SIDES]
    carrier = {joint.body: joint.id for joint in robot.joints}
    joints = [model.getJointId(carrier[hand.body]) for hand in hands]
    posture, velocity = to_pinocchio(q), np.array(v, dtype=np.float64)
    posture[:, POSITION], posture[:, QUATERNION] = 0.0, (0.0, 0.0, 0.0, 1.0)
    velocity[:, :N_VIRTUAL] = 0.0
    twist = np.zeros((len(q), len(hands), 6))
    for row in range(len(q)):
        pin.forwardKinematics(model, data, posture[row], velocity[row])
        for side, joint in enumerate(joints):
            twist[row, side] = data.v[joint].vector
    arm = np.array([hand.pos for hand in hands])
    return np.linalg.norm(twist[..., :3] + np.cross(twist[..., 3:], arm), axis=-1)
