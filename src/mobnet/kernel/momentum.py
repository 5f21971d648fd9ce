"""p = M v of (4) and beta = C^T v - g of (6) in one sweep out along the kinematic tree and one back, compiled.

Joint k has the columns J_k of its axes and moves with its link at V_k. Let H_k be the spatial momentum and W_k the
weight of the subtree behind it. The kinetic energy gives

    p_k = J_k^T H_k                                                                                                (a)

The columns are fixed in the link, so that their rate is V_k x J_k, and the rate of H_k is W_k and the wrench that joint
k passes on, whose share along J_k is the joint's torque tau_k:

    d/dt p_k = (V_k x J_k)^T H_k + J_k^T W_k + tau_k                                                               (b)

By (1) and C + C^T = Mdot, d/dt (M v) = tau + C^T v - g. Hence

    (C^T v)_k = (V_k x J_k)^T H_k        -g_k = J_k^T W_k                                                          (c)

All of it is in the axes of link k and about its origin. There a hinge about a unit vector a has J = (0, a), V = (v, w),
H = (h, n), and the weight of the mass m with first moment s = m c in the gravity g is (m g, s x g). By (a) and (c)

    p_k = a . n        beta_k = a . (h x v + n x w + s x g)                                                        (d)

The ball of a floating base is (d) with each of the base's axes for a. Its translation is along axes fixed in the
world, so its p is h in world axes and its beta is m g. A rotor turns with its joint's speed: it adds armature * v to p,
and nothing to beta, because its inertia is constant.

Samples lie side by side in lanes, the last axis of what is computed, so that the compiler makes vector instructions of
loops over lanes; no sample sees another one, and its numbers do not depend on how many lanes there are.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.machine_code import compiled
from mobnet.kernel.linkage import Linkage, turn, turn_base
from mobnet.kernel.triples import Triple, add, at, cross, dot, into, out_of, product, put, times, vector

LANES = 8  # samples side by side: the numbers in a register of AVX-512, or two of AVX2
Records = NDArray[np.void]


def lanes(width: int) -> np.dtype[np.void]:
    """Return what the sweeps keep of a link, in its axes and about its origin, for samples side by side (..., width).

    `velocity` [m/s] and `omega` [rad/s] are V of the module's text, `momentum` [kg m/s] and `spin` [kg m^2/s] H,
    `moment` [kg m] is s and `gravity` [m/s^2] g. The last three belong to the subtree once the sweep back reaches it.
    """
    shapes = {"cosine": (width,), "sine": (width,), "rotation": (3, 3, width)}
    shapes |= dict.fromkeys(("velocity", "omega", "gravity", "momentum", "spin", "moment"), (3, width))
    return np.dtype([(name, np.float64, shape) for name, shape in shapes.items()])


WIDE = lanes(LANES)
NARROW = lanes(1)


@compiled(allocating=True)
def sweep(linkage: Linkage, q: Array, v: Array, p: Array, beta: Array) -> None:
    """Write p of (4) [kg m/s], [kg m^2/s] and beta of (6) [N], [N m], both (T, nv), of positions (T, nq), w x y z.

    Quaternions may be of any length; velocities are (T, nv) [m/s], [rad/s].
    """
    links = len(linkage.links)
    row = 0
    wide = np.empty(links, WIDE)
    narrow = np.empty(links, NARROW)
    while row + LANES <= len(q):
        _sweep(linkage, wide, q[row:], v[row:], p[row:], beta[row:])
        row += LANES
    while row < len(q):
        _sweep(linkage, narrow, q[row:], v[row:], p[row:], beta[row:])
        row += 1


@compiled
def _sweep(linkage: Linkage, work: Records, q: Array, v: Array, p: Array, beta: Array) -> None:
    """Write p and beta of as many samples as there are lanes, the first ones."""
    links = linkage.links
    floating = v.shape[1] >= len(linkage.links)
    _start(linkage, work[0], floating, q, v)
    for k in range(1, len(links)):
        _go_out(links[k], work[k], work[links[k].parent], q[:, k - len(links)], v[:, k - len(links)])
    for k in range(len(links) - 1, 0, -1):
        column = k - len(links)
        _tell(links[k], work[k], v[:, column], p[:, column], beta[:, column])
        _go_back(links[k], work[k], work[links[k].parent])
    if floating:
        _tell_base(linkage, work[0], p, beta)


@compiled
def _start(linkage: Linkage, base: Any, floating: bool, q: Array, v: Array) -> None:
    """Set the state of the base, at rest in world axes where it is fixed."""
    for lane in range(base.cosine.shape[0]):
        put(base.velocity, lane, (0.0, 0.0, 0.0))
        put(base.omega, lane, (0.0, 0.0, 0.0))
        put(base.gravity, lane, vector(linkage.gravity))
        if floating:
            turn_base(q[lane], base.rotation, lane)
            put(base.velocity, lane, into(base.rotation, lane, vector(v[lane])))
            put(base.omega, lane, vector(v[lane, 3:]))
            put(base.gravity, lane, into(base.rotation, lane, vector(linkage.gravity)))
        _carry(linkage.links[0], base, lane)


@compiled
def _go_out(link: Any, state: Any, parent: Any, q: Array, v: Array) -> None:
    """Set a link's rotation, velocity, gravity and its own momentum from its parent's."""
    for lane in range(state.cosine.shape[0]):  # apart, because these are calls and no vector instructions
        state.cosine[lane], state.sine[lane] = math.cos(q[lane]), math.sin(q[lane])
    for lane in range(state.cosine.shape[0]):
        turn(link, state.cosine[lane], state.sine[lane], state.rotation, lane)
        omega = at(parent.omega, lane)
        axis = vector(link.axis)
        here = add(at(parent.velocity, lane), cross(omega, vector(link.offset)))
        put(state.velocity, lane, into(state.rotation, lane, here))
        put(state.omega, lane, add(into(state.rotation, lane, omega), times(v[lane], axis)))
        put(state.gravity, lane, into(state.rotation, lane, at(parent.gravity, lane)))
        _carry(link, state, lane)


@compiled
def _carry(link: Any, state: Any, lane: int) -> None:
    """Set the momentum and first moment of the link alone."""
    velocity = at(state.velocity, lane)
    omega = at(state.omega, lane)
    moment = vector(link.moment)
    turning = product(link.inertia, omega)
    put(state.momentum, lane, add(times(link.mass, velocity), cross(omega, moment)))
    put(state.spin, lane, add(turning, cross(moment, velocity)))
    put(state.moment, lane, moment)


@compiled
def _tell(link: Any, state: Any, v: Array, p: Array, beta: Array) -> None:
    """Write p and beta of a hinge by (d)."""
    axis = vector(link.axis)
    for lane in range(state.cosine.shape[0]):
        p[lane] = dot(axis, at(state.spin, lane)) + link.armature * v[lane]
        beta[lane] = dot(axis, _rate(state, lane))


@compiled
def _rate(state: Any, lane: int) -> Triple:
    """Return h x v + n x w + s x g of (d) [N m]."""
    moving = cross(at(state.momentum, lane), at(state.velocity, lane))
    turning = cross(at(state.spin, lane), at(state.omega, lane))
    return add(add(moving, turning), cross(at(state.moment, lane), at(state.gravity, lane)))


@compiled
def _go_back(link: Any, state: Any, parent: Any) -> None:
    """Add a subtree's momentum and first moment to its parent's."""
    offset = vector(link.offset)
    shift = times(link.behind, vector(link.offset))
    for lane in range(state.cosine.shape[0]):
        momentum = out_of(state.rotation, lane, at(state.momentum, lane))
        spin = add(out_of(state.rotation, lane, at(state.spin, lane)), cross(offset, momentum))
        moment = add(out_of(state.rotation, lane, at(state.moment, lane)), shift)
        put(parent.momentum, lane, add(at(parent.momentum, lane), momentum))
        put(parent.spin, lane, add(at(parent.spin, lane), spin))
        put(parent.moment, lane, add(at(parent.moment, lane), moment))


@compiled
def _tell_base(linkage: Linkage, base: Any, p: Array, beta: Array) -> None:
    """Write p and beta of a floating base: of its translation, and of its ball by (d)."""
    for lane in range(base.cosine.shape[0]):
        momentum = out_of(base.rotation, lane, at(base.momentum, lane))
        spin = at(base.spin, lane)
        weight = times(linkage.links[0].behind, vector(linkage.gravity))
        rate = _rate(base, lane)
        for i in range(3):
            p[lane, i], p[lane, 3 + i] = momentum[i], spin[i]
            beta[lane, i], beta[lane, 3 + i] = weight[i], rate[i]
