"""The Jacobian of a point of a body, in world axes: what each joint's torque feels of a force and a moment there."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array, rows_of
from mobnet.core.compilation import compiled
from mobnet.kernel.linkage import Linkage, turn, turn_base
from mobnet.kernel.triples import add, cross, out_of, put, vector
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import carrier_of


def point_jacobian(nominal: NominalModel, body: str, place: Sequence[float], q: NDArray[Any]) -> Array:
    """Return the Jacobian to the motors of a point of a body (T, 6, nu) [m], [-], at positions (T, nq).

    The point is a place (3,) [m] in the body's frame. Rows are its velocity and the body's angular velocity, in world
    axes, so that `J^T F` is what the motors feel of a force [N] and a moment [N m] at the point.

    Raises:
        ConfigError: the robot has no such body.
        DataError: positions do not fit the model.
    """
    robot = nominal.robot
    samples = np.shape(q)[:-1]
    positions = rows_of("q", q, samples, nominal.model.nq)
    joint, placement = carrier_of(robot, body)
    jacobian = np.zeros((len(positions), robot.layout.nu, 2, 3, 1))
    if joint is not None:
        link = 1 + robot.layout.actuated.index(joint)
        point = placement.act(np.array(place, dtype=np.float64))
        _fill(nominal.linkage, link, point, positions, robot.floating, jacobian)
    return np.swapaxes(jacobian.reshape(len(positions), -1, 6), 1, 2)


@compiled(allocating=True)
def _fill(linkage: Linkage, link: int, point: Array, q: Array, floating: bool, jacobian: Array) -> None:
    """Fill the columns (T, nu, 2, 3, 1) of the joints from a link down to the base, for a point in the link's axes.

    Each is turned with the links between it and the base, joint by joint.
    """
    rotation = np.empty((3, 3, 1))
    for row in range(len(q)):
        place = vector(point)
        k = link
        while k > 0:
            carrier = linkage.links[k]
            columns = jacobian[row]
            axis = vector(carrier.axis)
            put(columns[k - 1, 0], 0, cross(axis, place))
            put(columns[k - 1, 1], 0, axis)
            angle = q[row, k - len(linkage.links)]
            turn(carrier, math.cos(angle), math.sin(angle), rotation, 0)
            _turn_columns(linkage, link, k, rotation, columns)
            place = add(out_of(rotation, 0, place), vector(carrier.offset))
            k = carrier.parent
        if floating:
            turn_base(q[row], rotation, 0)
            _turn_columns(linkage, link, 0, rotation, jacobian[row])


@compiled
def _turn_columns(linkage: Linkage, link: int, last: int, rotation: Array, columns: Array) -> None:
    """Turn the columns (nu, 2, 3, 1) of the joints from a link down to the last one, that of the base left out."""
    k = link
    while k > 0:
        for part in range(2):
            x = columns[k - 1, part]
            put(x, 0, out_of(rotation, 0, (x[0, 0], x[1, 0], x[2, 0])))
        if k == last:
            break
        k = linkage.links[k].parent
