"""How well a force at each of many points explains torques: weighted least squares with what is known of a force.

A force f in three directions of the surface at a point turns the joints by J^T B f, where J is the Jacobian of the link
and B (6, 3) has the wrenches of 1 N in these directions. Errors of the torques are normal with a covariance C. Of the
force it is known beforehand that it presses, is about as large as collisions are, and lies in the cone of friction; a
normal law of covariance P says so. The density of the torques tau, given the point, is then

    -2 log p = const - h^T f + log det(A P),  A = B^T J C^-1 J^T B + P^-1,  f = A^-1 h,  h = B^T J C^-1 tau,         (a)

the residual of weighted least squares, and what is paid for a force that goes far to fit (docs/notes/0044).
"""

import numpy as np

from mobnet.core.arrays import Array
from mobnet.settings.detection import ContactPoint

LEAST = 1.0  # force for which the cone still has a width [N]


def explain(wrenches: Array, weight: Array, seen: Array, settings: ContactPoint) -> tuple[Array, Array]:
    """Return -2 log p of (a) at k points (k,), infinite where no force presses there, and the forces (k, 3) [N].

    Args:
        wrenches: B^T of each point, its first force into the surface (k, 3, 6) [N, N m].
        weight: J C^-1 J^T of each point's link (k, 6, 6).
        seen: J C^-1 tau of each point's link (k, 6).
        settings: friction, and the size of forces.
    """
    inner = wrenches @ weight @ wrenches.transpose(0, 2, 1)
    pulled = (wrenches @ seen[:, :, None])[..., 0]
    # The cone is two standard deviations wide. Its width follows the force into the surface: that of the best force
    # without friction, and then that of the best one in the cone that follows.
    pressing = pulled[:, 0] / (inner[:, 0, 0] + settings.force_n**-2)
    known = _known(pressing, settings)
    force, _ = _solved(inner + np.eye(3) * known[:, :, None], pulled)
    known = _known(force[:, 0], settings)
    force, determinant = _solved(inner + np.eye(3) * known[:, :, None], pulled)
    cost = np.log(determinant) - np.log(known).sum(axis=1) - (pulled * force).sum(axis=1)
    holds = np.linalg.norm(force[:, 1:], axis=1) <= settings.friction * force[:, 0]
    return np.where(holds, cost, np.inf), force


def _known(pressing: Array, settings: ContactPoint) -> Array:
    """Return the diagonal of P^-1 of points where forces (k,) [N] press, (k, 3) [1/N^2]."""
    width = settings.friction / 2.0 * np.maximum(pressing, LEAST)
    return np.stack([np.full(len(pressing), settings.force_n), width, width], axis=1) ** -2


def _solved(matrix: Array, right: Array) -> tuple[Array, Array]:
    """Return the solutions (k, 3) of symmetric systems (k, 3, 3) with right sides (k, 3), and the determinants (k,).

    By Cramer's rule, for all of them at once: a solver takes them one by one.
    """
    first, second, third = (matrix[:, i] for i in range(3))
    adjugate = np.stack([np.cross(second, third), np.cross(third, first), np.cross(first, second)], axis=1)
    determinant = (first * adjugate[:, 0]).sum(axis=1)
    return (adjugate @ right[:, :, None])[..., 0] / determinant[:, None], determinant
