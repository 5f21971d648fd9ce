"""A mass at the end of an arm that its table lacks, such as a tool or what it holds, by least squares."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pinocchio as pin

from mobnet.core.arrays import Array
from mobnet.kernel.linkage import linkage_of
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.hints.fits import quotient
from mobnet.robotlog.hints.windows import MotionWindows, MotorDemand, size_of

PLACE_M = 0.1  # from the link's origin, at which a mass is tried
LEAST_KG = 0.05  # mass that is none


class PayloadHint(NamedTuple):
    """A mass that is carried [kg], where (3,) [m] in the frame of which body, and its torques (W, nu) [N m]."""

    mass: float
    place: Array
    body: str
    torque: Array

    def text(self) -> str:
        """Return it in words."""
        place = ", ".join(f"{part:.2f}" for part in self.place)
        return f"a mass of {self.mass:.2g} kg at ({place}) m of {self.body}, which the table lacks"


def payloads(
    nominal: NominalModel, windows: MotionWindows, asked: MotorDemand, left: Array, joints: Sequence[int]
) -> list[PayloadHint]:
    """Return the mass at the end of each limb of a robot with a fixed base that explains some joints best.

    `left` is the share of the joints' square torque that is not explained without it (nu,).
    """
    if nominal.robot.floating:
        return []
    from scipy.optimize import lsq_linear  # here, as it takes a second to import

    columns = list(joints)
    rest = (windows.torque - asked.needed)[:, columns]
    weight = quotient(np.ones(len(columns)), (np.sqrt(left) * size_of(windows.torque))[columns])
    friction = np.zeros((*rest.shape, len(columns), asked.terms.shape[-1]))  # of each joint alone
    friction[:, np.arange(len(columns)), np.arange(len(columns))] = asked.terms[:, columns]
    explanations = []
    for joint in (k for k in range(1, nominal.model.njoints) if not len(nominal.model.children[k])):
        carried = _torque_of_mass(nominal, windows, joint)
        terms = np.concatenate([carried[:, columns], friction.reshape(*rest.shape, -1)], axis=-1) * weight[:, None]
        # Friction and inertia take no torque away from what moves a joint; a centre of mass may lie on any side.
        low = np.where(np.arange(terms.shape[-1]) < carried.shape[-1], -np.inf, 0.0)
        numbers = lsq_linear(terms.reshape(-1, terms.shape[-1]), (rest * weight).ravel(), (low, np.inf)).x[:4]
        if numbers[0] > LEAST_KG:
            body = _body_of(nominal, joint)
            explanations.append(PayloadHint(float(numbers[0]), numbers[1:] / numbers[0], body, carried @ numbers))
    return explanations


def _torque_of_mass(nominal: NominalModel, windows: MotionWindows, joint: int) -> Array:
    """Return the torques for a mass at the origin of a joint's link, and for its first moments (W, nu, 4)."""
    without = windows.needed(nominal)
    torques = [windows.needed(_loaded(nominal, joint, np.zeros(3))) - without]
    for axis in PLACE_M * np.eye(3):
        ahead, behind = (windows.needed(_loaded(nominal, joint, place)) for place in (axis, -axis))
        torques.append((ahead - behind) / (2 * PLACE_M))
    return np.stack(torques, axis=-1)


def _loaded(nominal: NominalModel, joint: int, place: Array) -> NominalModel:
    """Return a model that carries a kilogram at a place (3,) [m] of a joint's link."""
    loaded = NominalModel(nominal.robot, nominal.mass_ratio, -float(nominal.model.gravity.linear[2]))
    loaded.model.appendBodyToJoint(joint, pin.Inertia(1.0, place, np.zeros((3, 3))), pin.SE3.Identity())
    loaded.linkage = linkage_of(loaded.model)
    return loaded


def _body_of(nominal: NominalModel, joint: int) -> str:
    """Return the name of the body that a joint moves."""
    names = (body.name for body in nominal.robot.bodies)
    moved = {row.id: name for name in names if (row := nominal.robot.joint_of(name))}
    return moved[nominal.model.names[joint]]
