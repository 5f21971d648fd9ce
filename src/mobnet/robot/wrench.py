"""From a wrench at a foot's sensor to the generalized external torque, tau_e = J^T F of (2)."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.robot.nominal import NominalModel


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
    """
    model, data, frame = nominal.model, nominal.data, _frame(nominal, side)
    positions = nominal.positions(q).reshape(-1, model.nq)
    loads = np.ascontiguousarray(wrench, dtype=np.float64).reshape(len(positions), -1)
    torque = np.empty((len(positions), model.nv))
    for k, (position, load) in enumerate(zip(positions, loads, strict=True)):
        torque[k] = load @ pin.computeFrameJacobian(model, data, position, frame, pin.ReferenceFrame.LOCAL)
    return torque.reshape(*np.shape(q)[:-1], model.nv)


def feet_torque(nominal: NominalModel, q: NDArray[Any], wrenches: Mapping[str, NDArray[Any]]) -> Array:
    """Return the sum of J^T F over the feet, (T, nv) or (nv,) [N] and [N m]: the training label of section 4.2.3.

    Positions are (..., nq), wrenches side -> (..., 6) [N] and [N m] as in `foot_torque`.

    Raises:
        ConfigError: a side is unknown.
    """
    zero = np.zeros((*np.shape(q)[:-1], nominal.model.nv))
    return sum((foot_torque(nominal, q, side, wrench) for side, wrench in wrenches.items()), zero)


def _frame(nominal: NominalModel, side: str) -> int:
    """Return the index of a side's sensor frame."""
    if side not in nominal.foot_frames:
        raise ConfigError(not_accepted("foot", side, nominal.foot_frames))
    return nominal.foot_frames[side]
