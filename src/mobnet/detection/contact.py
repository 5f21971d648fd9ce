"""Where on a limb something touches it, and with which force, from estimated external torques.

All points of the surface together, each as probable as it explains the torques, are the law of where the contact is. Of
the likeliest ones that is named from which all of them are least far away, and this mean distance says how sure it is.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import ConfigError, DataError, not_accepted
from mobnet.detection.surface import Carrier, Surface, carried_by, surface_of
from mobnet.kernel.detecting import ContactNumbers
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel

LEAST = 1.0  # force for which the cone still has a width [N]


# A force f in three directions of the surface at a point turns the joints by J^T B f, where J is the Jacobian of the
# link and B (6, 3) has the wrenches of 1 N in these directions. Errors of the torques are normal with a covariance C.
# Of the force it is known beforehand that it presses, is about as large as collisions are, and lies in the cone of
# friction; a normal law of covariance P says so. The density of the torques tau, given the point, is then
#
# -2 log p = const - h^T f + log det(A P), A = B^T J C^-1 J^T B + P^-1, f = A^-1 h, h = B^T J C^-1 tau, (a)
#
# the residual of weighted least squares, and what is paid for a force that goes far to fit (docs/notes/contact.md).
def explain(wrenches: Array, weight: Array, seen: Array, numbers: ContactNumbers) -> tuple[Array, Array]:
    """Return -2 log p of (a) at k points (k,), infinite where no force presses there, and the forces (k, 3) [N].

    Args:
        wrenches: B^T of each point, its first force into the surface (k, 3, 6) [N, N m].
        weight: J C^-1 J^T of each point's link (k, 6, 6).
        seen: J C^-1 tau of each point's link (k, 6).
        numbers: friction, and the size of forces.
    """
    inner = wrenches @ weight @ wrenches.transpose(0, 2, 1)
    pulled = (wrenches @ seen[:, :, None])[..., 0]
    # The cone is two standard deviations wide. Its width follows the force into the surface: that of the best force
    # without friction, and then that of the best one in the cone that follows.
    pressing = pulled[:, 0] / (inner[:, 0, 0] + numbers.force_n**-2)
    known = _known(pressing, numbers)
    force, _ = _solved(inner + np.eye(3) * known[:, :, None], pulled)
    known = _known(force[:, 0], numbers)
    force, determinant = _solved(inner + np.eye(3) * known[:, :, None], pulled)
    cost = np.log(determinant) - np.log(known).sum(axis=1) - (pulled * force).sum(axis=1)
    holds = np.linalg.norm(force[:, 1:], axis=1) <= numbers.friction * force[:, 0]
    return np.where(holds, cost, np.inf), force


def _known(pressing: Array, numbers: ContactNumbers) -> Array:
    """Return the diagonal of P^-1 of points where forces (k,) [N] press, (k, 3) [1/N^2]."""
    width = numbers.friction / 2.0 * np.maximum(pressing, LEAST)
    return np.stack([np.full(len(pressing), numbers.force_n), width, width], axis=1) ** -2


def _solved(matrix: Array, right: Array) -> tuple[Array, Array]:
    """Return the solutions (k, 3) of symmetric systems (k, 3, 3) with right sides (k, 3), and the determinants (k,).

    By Cramer's rule, for all of them at once: a solver takes them one by one.
    """
    first, second, third = (matrix[:, i] for i in range(3))
    adjugate = np.stack([np.cross(second, third), np.cross(third, first), np.cross(first, second)], axis=1)
    determinant = (first * adjugate[:, 0]).sum(axis=1)
    return (adjugate @ right[:, :, None])[..., 0] / determinant[:, None], determinant


@dataclass(frozen=True)
class Contact:
    """A contact with a body at one point.

    Attributes:
        body: the body.
        shape: the solid of the robot's table on which the point lies.
        point: in the axes of the body (3,) [m].
        place: the same point in world axes (3,) [m].
        force: that acts on the robot, in world axes (3,) [N], the mean over where the contact may be.
        spread_m: mean distance from the point to where the contact may be, each weighted by its probability [m].
    """

    body: str
    shape: str
    point: Array
    place: Array
    force: Array
    spread_m: float


@dataclass(frozen=True)
class ContactLocator:
    """Finds contacts with the bodies of a limb from torques of some joints.

    Attributes:
        numbers: of the surface, of forces and of errors.
        robot: the robot.
        nominal: its model.
        joints: names of the joints whose torques it takes (n,).
        surface: where something can touch the limb.
    """

    numbers: ContactNumbers
    robot: RobotDescription
    nominal: NominalModel
    joints: tuple[str, ...]
    surface: Surface

    @classmethod
    def of(cls, numbers: ContactNumbers, robot: RobotDescription, limb: str, joints: Sequence[str]) -> "ContactLocator":
        """Return a finder of contacts with the bodies that a limb moves.

        Joints are those of the limb. On a floating base those of the base and of the standing leg tell much more,
        because a force turns only the joints above its link (docs/detection.md).

        Raises:
            ConfigError: limb or joints are unknown, or the limb has no shapes.
        """
        robot.layout.columns(joints)
        surface = surface_of(robot, limb, numbers.spacing_m)
        return cls(numbers, robot, NominalModel(robot), tuple(joints), surface)

    def locate(
        self, q: NDArray[Any], tau: NDArray[Any], std: NDArray[Any], standing: Sequence[str] = ()
    ) -> Contact | None:
        """Return the contact that explains the external torque of one sample; None where no force that presses does.

        Args:
            q: generalized position (nq,) [m, -, rad].
            tau: external torque of the joints (n,) [N m], of V1..V3 [N].
            std: standard deviation of its error (n,), in the same units.
            standing: bodies on which the ground acts with a wrench that is not known.

        Raises:
            DataError: torques or standard deviations are not one of each joint.
            ConfigError: a body is unknown.
        """
        wanted = (len(self.joints),)
        if np.shape(tau) != wanted or np.shape(std) != wanted:
            raise DataError(not_accepted("tau and std", (np.shape(tau), np.shape(std)), [f"shapes {wanted}"]))
        pin.computeJointJacobians(self.nominal.model, self.nominal.data, self.nominal.positions(q))
        inverse = np.linalg.inv(self._covariance(np.asarray(std, dtype=np.float64), standing))
        jacobians = [self._jacobian(carrier) for carrier in self.surface.carriers]
        weight = np.array([jacobian @ inverse @ jacobian.T for jacobian in jacobians])[self.surface.shape]
        seen = np.array([jacobian @ inverse @ tau for jacobian in jacobians])[self.surface.shape]
        cost, force = explain(self.surface.wrenches, weight, seen, self.numbers)
        return self._named(cost, force) if np.isfinite(cost).any() else None

    def _named(self, cost: Array, force: Array) -> Contact:
        """Return the contact from -2 log p of each point (k,) and the forces there (k, 3)."""
        surface = self.surface
        probable = surface.patch.area * np.exp((cost.min() - cost) / 2.0)
        likely = np.argsort(-probable, kind="stable")[: self.numbers.candidates]
        share = probable[likely] / probable[likely].sum()
        solids = surface.shape[likely]
        axes, origins = map(np.array, zip(*map(self._placed, surface.carriers), strict=True))
        places = (axes[solids] @ surface.patch.points[likely, :, None])[..., 0] + origins[solids]
        # The likeliest point alone would jump from one link to another when two explain the torques nearly as well.
        distance = _distances(places) @ share
        best = int(np.argmin(distance))
        shape = surface.shapes[solids[best]]
        # Of the force the mean is said, because the named point itself need not be a likely one.
        turned = axes @ np.array([carrier.axes.T for carrier in surface.carriers])
        along_axes = force[likely, None] @ surface.wrenches[likely, :, :3]
        pushed = share @ (turned[solids] @ along_axes.transpose(0, 2, 1))[..., 0]
        point = surface.patch.points[likely[best]]
        return Contact(shape.body, shape.name, point, places[best], pushed, float(distance[best]))

    def place(self, q: NDArray[Any], body: str) -> tuple[Array, Array]:
        """Return the axes (3, 3) and the origin (3,) [m] of a body in the world, at a position q (nq,).

        Raises:
            ConfigError: the body is unknown, or no joint moves it.
        """
        pin.forwardKinematics(self.nominal.model, self.nominal.data, self.nominal.positions(q))
        return self._placed(carried_by(self.robot, body))

    def _placed(self, carrier: Carrier) -> tuple[Array, Array]:
        """Return axes (3, 3) and origin (3,) [m] of a body in the world, at the pose."""
        link = self.nominal.data.oMi[self._joint(carrier)]
        return link.rotation @ carrier.axes, link.rotation @ carrier.origin + link.translation

    def _covariance(self, std: Array, standing: Sequence[str]) -> Array:
        """Return the covariance (n, n) of what torques hold beside the contact: errors, and what the ground does."""
        numbers = self.numbers
        units = [self.robot.layout.unit(joint) for joint in self.joints]
        floor = np.where(np.array(units) == "N", numbers.error_n, numbers.error_nm)
        ground = np.repeat([numbers.ground_n, numbers.ground_nm], 3)
        covariance = np.diag(std**2 + floor**2)
        for body in standing:
            carried = self._jacobian(carried_by(self.robot, body)) * ground[:, None]
            covariance += carried.T @ carried
        return covariance

    def _jacobian(self, carrier: Carrier) -> Array:
        """Return the Jacobian (6, n) of a link to the joints, in its axes and about its origin, at the pose."""
        frame = pin.ReferenceFrame.LOCAL
        data = self.nominal.data
        whole = pin.getJointJacobian(self.nominal.model, data, self._joint(carrier), frame)
        return np.reshape(whole, (-1, self.nominal.model.nv))[:, self.robot.layout.columns(self.joints)]

    def _joint(self, carrier: Carrier) -> int:
        """Return the joint of the model that moves a link; a ConfigError says that none does."""
        if carrier.joint is None:
            raise ConfigError(f"robot {self.robot.name}: the base is not accepted; accepted: a body that a joint moves")
        return self.nominal.model.getJointId(carrier.joint)


def _distances(places: Array) -> Array:
    """Return the distances between places (k, 3) [m], (k, k)."""
    # By products: the differences of all pairs take ten times as long.
    size = (places**2).sum(axis=1)
    return np.sqrt(np.maximum(size[:, None] + size - 2.0 * places @ places.T, 0.0))
