"""Torques of a force at a point of a robot, by Pinocchio's Jacobian of the link."""

from collections.abc import Sequence

import numpy as np
import pinocchio as pin

from mobnet.core.arrays import Array
from mobnet.detection.surface import carried_by
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel


def pushed(robot: RobotDescription, q: Array, body: str, point: Sequence[float], force: Sequence[float]) -> Array:
    """Return the torque (nv,) of a force (3,) [N] in the axes of a body at its point (3,) [m]."""
    nominal, carrier = NominalModel(robot), carried_by(robot, body)
    own, place = carrier.axes @ np.asarray(force), carrier.origin + carrier.axes @ np.asarray(point)
    joint = nominal.model.getJointId(carrier.joint)
    jacobian = pin.computeJointJacobian(nominal.model, nominal.data, nominal.positions(q), joint)
    return jacobian.T @ np.concatenate([own, np.cross(place, own)])
