"""Terms of the equation of motion (1), M vdot + C v + g = tau_v + tau_e, from the nominal model.

Positions have a w x y z quaternion. Torques are [N] for V1..V3 and [N m] for the others, axes as `JointLayout` says.
"""

from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from mobnet.core.arrays import Array, rows_of
from mobnet.kernel.momentum import sweep
from mobnet.robot.nominal import NominalModel


def mass_matrix(nominal: NominalModel, q: NDArray[Any]) -> Array:
    """Return M(q) of (1), rotor inertia included, (nv, nv) [kg], [kg m], [kg m^2]."""
    upper = np.triu(pin.crba(nominal.model, nominal.data, nominal.positions(q)))
    return upper + np.triu(upper, 1).T


def coriolis(nominal: NominalModel, q: NDArray[Any], v: NDArray[Any]) -> Array:
    """Return C(q, v) of (1) with C + C^T = Mdot, (nv, nv); times v it is in [N] and [N m]."""
    return pin.computeCoriolisMatrix(nominal.model, nominal.data, nominal.positions(q), _float64(v))


def gravity(nominal: NominalModel, q: NDArray[Any]) -> Array:
    """Return g(q) of (1), (nv,) [N] and [N m]."""
    return pin.computeGeneralizedGravity(nominal.model, nominal.data, nominal.positions(q))


def bias(nominal: NominalModel, q: NDArray[Any], v: NDArray[Any]) -> Array:
    """Return C v + g of (1), (nv,) [N] and [N m]."""
    return pin.nonLinearEffects(nominal.model, nominal.data, nominal.positions(q), _float64(v))


def inverse_dynamics(nominal: NominalModel, q: NDArray[Any], v: NDArray[Any], a: NDArray[Any]) -> Array:
    """Return M a + C v + g of (1), a the derivative of v, (nv,) [N] and [N m]."""
    return pin.rnea(nominal.model, nominal.data, nominal.positions(q), _float64(v), _float64(a))


def momentum_and_beta(nominal: NominalModel, q: NDArray[Any], v: NDArray[Any]) -> tuple[Array, Array]:
    """Return p = M v of (4) [kg m/s], [kg m^2/s] and C^T v - g of (6) [N], [N m], both (..., nv).

    Positions (..., nq) and velocities (..., nv) [m/s], [rad/s] are of any float type and memory order.

    Raises:
        DataError: their shapes do not fit the model or each other.
    """
    nv = nominal.model.nv
    samples = np.shape(v)[:-1]
    rows = rows_of("q", q, samples, nominal.model.nq), rows_of("v", v, samples, nv)
    p = np.empty((*samples, nv))
    result = np.empty((*samples, nv))
    sweep(nominal.linkage, *rows, p.reshape(-1, nv), result.reshape(-1, nv))
    return p, result


def _float64(array: NDArray[Any]) -> Array:
    """Return an array in float64, as physics is computed, its last axis contiguous, as Pinocchio takes it."""
    return np.ascontiguousarray(array, dtype=np.float64)
