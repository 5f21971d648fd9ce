"""From a wrench at a foot's sensor or a point of a body to the generalized external torque, tau_e = J^T F of (2)."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from mobnet.core.arrays import Array, rows_of
from mobnet.core.compilation import compiled
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.kernel.linkage import Linkage, turn, turn_base
from mobnet.kernel.triples import add, cross, dot, out_of, product, vector
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel


def feet_torque(nominal: NominalModel, q: NDArray[Any], wrenches: Mapping[str, NDArray[Any]]) -> Array:
    """Return the sum of J^T F over the feet, (T, nv) or (nv,) [N] and [N m]: the training label of section 4.2.3.

    Positions are (..., nq), wrenches side -> (..., 6): the force [N] and moment [N m] on the foot, in foot axes, about
    the sensor.

    Raises:
        ConfigError: a side is unknown.
        DataError: positions or wrenches do not fit the model or each other.
    """
    model = nominal.model
    samples = np.shape(q)[:-1]
    tau = np.zeros((*samples, model.nv))
    positions = rows_of("q", q, samples, model.nq)
    for side, wrench in wrenches.items():
        frame = model.frames[_frame(nominal, side)]
        loads = rows_of(f"the {side} wrench", wrench, samples, 6)
        link = len(nominal.linkage.links) - model.njoints + frame.parentJoint
        axes = np.ascontiguousarray(frame.placement.rotation)
        point = np.array(frame.placement.translation)
        _pull(nominal.linkage, link, axes, point, positions, loads, tau.reshape(-1, model.nv))
    return tau


def point_torque(
    nominal: NominalModel, body: str, place: Sequence[float], axes: Array, q: NDArray[Any], wrench: NDArray[Any]
) -> Array:
    """Return J^T F of wrenches at a point of a body, (T, nv) [N] and [N m], at positions (T, nq).

    The point is a place (3,) [m] in the body's frame; wrenches (T, 6), force [N] and moment [N m] about the point, are
    in the axes (3, 3) of a sensor, whose columns are in the body's frame.

    Raises:
        ConfigError: the robot has no such body.
        DataError: positions or wrenches do not fit the model or each other.
    """
    model = nominal.model
    samples = np.shape(q)[:-1]
    tau = np.zeros((*samples, model.nv))
    positions = rows_of("q", q, samples, model.nq)
    joint, placement = carrier_of(nominal.robot, body)
    link = 1 + nominal.robot.layout.actuated.index(joint) if joint else 0
    turned = np.ascontiguousarray(placement.rotation @ np.asarray(axes, dtype=np.float64))
    loads = rows_of("wrench", wrench, samples, 6)
    _pull(nominal.linkage, link, turned, placement.act(np.array(place, dtype=np.float64)), positions, loads, tau)
    return tau


def carrier_of(robot: RobotDescription, body: str) -> tuple[str | None, pin.SE3]:
    """Return the joint that carries a body, none for the base, and the body's placement in what the joint moves."""
    rows = {row.name: row for row in robot.bodies}
    placement = pin.SE3.Identity()
    if body not in rows:
        raise ConfigError(not_accepted("body", body, rows))
    while (joint := robot.joint_of(body)) is None and body != robot.base:
        w, x, y, z = rows[body].quat
        placement = pin.SE3(pin.Quaternion(w, x, y, z).matrix(), np.array(rows[body].pos)) * placement
        body = rows[body].parent
    return joint.id if joint else None, placement


@compiled(allocating=True)
def _pull(linkage: Linkage, link: int, axes: Array, point: Array, q: Array, wrench: Array, tau: Array) -> None:
    """Add J^T F of wrenches (T, 6) at a point of a link, in the axes of its sensor (3, 3), to tau (T, nv).

    A joint takes the share of the moment about its axis and passes the wrench on to its parent.
    """
    rotation = np.empty((3, 3, 1))
    floating = tau.shape[1] >= len(linkage.links)
    for row in range(len(q)):
        force, k = product(axes, vector(wrench[row])), link
        moment = add(product(axes, vector(wrench[row, 3:])), cross(vector(point), force))
        while k > 0:
            carrier = linkage.links[k]
            column = k - len(linkage.links)
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
    if side not in nominal.foot_frames:
        raise ConfigError(not_accepted("foot", side, nominal.foot_frames))
    return nominal.foot_frames[side]
