"""From a wrench at a foot's sensor to the generalized external torque, tau_e = J^T F of (2)."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from mobnet.core.arrays import Array, rows_of
from mobnet.core.compiled import compiled
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.robot.linkage import Linkage, turn, turn_base
from mobnet.robot.nominal import NominalModel
from mobnet.robot.triples import add, cross, dot, out_of, product, vector


def foot_jacobian(nominal: NominalModel, q: NDArray[Any], side: str) -> Array:
    """Return J_foot (6, nv) of (2): velocity of the foot's sensor, linear [m/s] then angular [rad/s], foot axes.

    The position is q (nq,); the masses of the model do not matter.

    Raises:
        ConfigError: the side is unknown.
    """
    frame = _frame(nominal, side)
    return pin.computeFrameJacobian(nominal.model, nominal.data, nominal.positions(q), frame, pin.ReferenceFrame.LOCAL)


def foot_torque(nominal: NominalModel, q: NDArray[Any], side: str, wrench: NDArray[Any]) -> Array:
    """Return J_foot^T F of (2), (T, nv) or (nv,) [N] and [N m]; positions are (..., nq).

    The wrench (..., 6) is the force [N] and moment [N m] on the foot, in foot axes, about the sensor.

    Raises:
        ConfigError: the side is unknown.
        DataError: positions or wrenches do not fit the model or each other.
    """
    return feet_torque(nominal, q, {side: wrench})


def feet_torque(nominal: NominalModel, q: NDArray[Any], wrenches: Mapping[str, NDArray[Any]]) -> Array:
    """Return the sum of J^T F over the feet, (T, nv) or (nv,) [N] and [N m]: the training label of section 4.2.3.

    Positions are (..., nq), wrenches side -> (..., 6) [N] and [N m] as in `foot_torque`.

    Raises:
        ConfigError: a side is unknown.
        DataError: positions or wrenches do not fit the model or each other.
    """
    model, samples = nominal.model, np.shape(q)[:-1]
    tau, positions = np.zeros((*samples, model.nv)), rows_of("q", q, samples, model.nq)
    for side, wrench in wrenches.items():
        frame, loads = model.frames[_frame(nominal, side)], rows_of(f"the {side} wrench", wrench, samples, 6)
        link = len(nominal.linkage.links) - model.njoints + frame.parentJoint
        axes, point = np.ascontiguousarray(frame.placement.rotation), np.array(frame.placement.translation)
        _pull(nominal.linkage, link, axes, point, positions, loads, tau.reshape(-1, model.nv))
    return tau


@compiled(allocating=True)
def _pull(linkage: Linkage, link: int, axes: Array, point: Array, q: Array, wrench: Array, tau: Array) -> None:
    """Add J^T F of wrenches (T, 6) at a point of a link, in the axes of its sensor (3, 3), to tau (T, nv).

    A joint takes the share of the moment about its axis and passes the wrench on to its parent.
    """
    rotation, floating = np.empty((3, 3, 1)), tau.shape[1] >= len(linkage.links)
    for row in range(len(q)):
        force, k = product(axes, vector(wrench[row])), link
        moment = add(product(axes, vector(wrench[row, 3:])), cross(vector(point), force))
        while k > 0:
            carrier, column = linkage.links[k], k - len(linkage.links)
            tau[row, column] += dot(vector(carrier.axis), moment)
            turn(carrier, math.cos(q[row, column]), math.sin(q[row, column]), rotation, 0)
            force = out_of(rotation, 0, force)
            moment = add(out_of(rotation, 0, moment), cross(vector(carrier.offset), force))
            k = carrier.parent
        if floating:
            turn_base(q[row], rotation, 0)
            force = out_of(rotation, 0, force)
            for i in range(3):
                tau[row, i] += force[i]
                tau[row, 3 + i] += moment[i]


def _frame(nominal: NominalModel, side: str) -> int:
    """Return the index of a side's sensor frame."""
    if side not in nominal.foot_frames:
        raise ConfigError(not_accepted("foot", side, nominal.foot_frames))
    return nominal.foot_frames[side]
