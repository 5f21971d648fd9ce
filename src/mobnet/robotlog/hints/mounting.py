"""The direction of gravity in the axes of an arm's table, by least squares: a wall, a ceiling, a slope.

The torque that gravity makes is linear in its three components, so that one fit to all joints tells them.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pinocchio as pin

from mobnet.core.arrays import Array
from mobnet.kernel.linkage import linkage_of
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.hints.fits import quotient
from mobnet.robotlog.hints.windows import MotionWindows, MotorDemand, size_of

LEAST_RAD = np.radians(8.0)  # turn of gravity below which masses of the table may be the cause
WALL_RAD, CEILING_RAD = np.radians(60.0), np.radians(150.0)  # turns from which a base hangs on one
SIZE = 0.4  # share by which it may seem larger or smaller, as masses of a table differ from those of a robot
UNFELT = 1e-3  # weight of the table's gravity beside what joints tell: a direction that none of them feels stays


class Mounting(NamedTuple):
    """How a base hangs.

    Attributes:
        down: direction of gravity in the axes of the table, a unit vector (3,).
        turn: angle between it and that of the table [rad].
        torque: what gravity makes the joints need beside that of the table (W, nu) [N m].
    """

    down: Array
    turn: float
    torque: Array

    def text(self, nominal: NominalModel) -> str:
        """Return it in words, with the orientation that the first body of the table needs."""
        place = "on a wall" if self.turn > WALL_RAD else "on a slope"
        place = "from a ceiling" if self.turn > CEILING_RAD else place
        down = ", ".join(f"{part + 0.0:.2f}" for part in np.round(self.down, 2))
        quat = ", ".join(f"{part:.4g}" for part in turned_base(nominal, self.down))
        return (
            f"gravity comes from another side than in the table: along ({down}) in its axes, "
            f"{np.degrees(self.turn):.0f} degrees off, as {place}; give its first body `quat: [{quat}]`"
        )


def turned_base(nominal: NominalModel, down: Array) -> Array:
    """Return the orientation of the first body, w x y z, by which gravity along a unit vector (3,) points down."""
    w, x, y, z = nominal.robot.bodies[0].quat
    turn = pin.Quaternion.FromTwoVectors(down, _down_of(nominal))
    turned = turn * pin.Quaternion(w, x, y, z)
    parts = (turned.w, turned.x, turned.y, turned.z)
    quat = np.array([round(float(part), 6) + 0.0 for part in parts])  # no minus before zero
    return quat if quat[np.flatnonzero(quat)[0]] > 0.0 else -quat


def mounting_of(
    nominal: NominalModel,
    windows: MotionWindows,
    asked: MotorDemand,
    left: Array,
    joints: Sequence[int],
) -> Mounting | None:
    """Return the direction of gravity that explains some joints of an arm best, None where it is that of the table.

    `left` is the share of the joints' square torque that is not explained by that of the table (nu,). A size that is
    not that of gravity has another cause.
    """
    size = float(np.linalg.norm(nominal.model.gravity.linear))
    if nominal.robot.floating or size == 0.0:
        return None
    from scipy.optimize import lsq_linear  # here, as it takes a second to import

    columns = list(joints)
    pulls = _torque_of_gravity(nominal, windows)
    table = size * _down_of(nominal)
    rest = (windows.torque - asked.needed + pulls @ table)[:, columns]
    weight = quotient(np.ones(len(columns)), (np.sqrt(left) * size_of(windows.torque))[columns])
    friction = np.zeros((*rest.shape, len(columns), asked.terms.shape[-1]))  # of each joint alone
    friction[:, np.arange(len(columns)), np.arange(len(columns))] = asked.terms[:, columns]
    terms = np.concatenate([pulls[:, columns], friction.reshape(*rest.shape, -1)], axis=-1) * weight[:, None]
    terms = terms.reshape(-1, terms.shape[-1])
    kept = UNFELT * np.linalg.norm(terms[:, :3]) * np.eye(3, terms.shape[-1])
    low = np.where(np.arange(terms.shape[-1]) < 3, -np.inf, 0.0)
    target = np.concatenate([(rest * weight).ravel(), kept[:, :3] @ table])
    gravity = lsq_linear(np.concatenate([terms, kept]), target, (low, np.inf)).x[:3]
    pull = float(np.linalg.norm(gravity))
    if abs(pull / size - 1.0) > SIZE:
        return None
    down = gravity / pull
    turn = float(np.arccos(np.clip(down @ _down_of(nominal), -1.0, 1.0)))
    return Mounting(down, turn, pulls @ (size * down - table)) if turn > LEAST_RAD else None


def _down_of(nominal: NominalModel) -> Array:
    """Return the direction of gravity of a model (3,)."""
    gravity = np.array(nominal.model.gravity.linear)
    return gravity / np.linalg.norm(gravity)


def _torque_of_gravity(nominal: NominalModel, windows: MotionWindows) -> Array:
    """Return the torques that the joints need for each component of gravity (W, nu, 3) [N m s^2/m]."""
    still = replace(windows, v=np.zeros(windows.v.shape), loads={})
    return np.stack([still.needed(_pulled(nominal, axis)) for axis in np.eye(3)], axis=-1)


def _pulled(nominal: NominalModel, gravity: Array) -> NominalModel:
    """Return a model in another gravity (3,) [m/s^2]."""
    pulled = NominalModel(nominal.robot, nominal.mass_ratio)
    pulled.model.gravity.linear = gravity
    pulled.linkage = linkage_of(pulled.model)
    return pulled
