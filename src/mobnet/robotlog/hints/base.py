"""Hints from what a floating base and its feet read: gravity, orientation, weight."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.motion import turn, turned
from mobnet.core.recording import Sensed
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import feet_torque
from mobnet.robotlog.hints.bounds import HintBounds
from mobnet.robotlog.pieces import pieces

G = 9.80665  # standard gravity [m/s^2], the unit in which accelerometers are sold
ALIKE = 0.9  # correlation from which two turns are one
UPRIGHT = 0.9  # cosine between the mean specific force in world axes and the vertical


def base_hints(sensed: Sensed, spans: Sequence[slice], rate_hz: float, bounds: HintBounds) -> Iterator[str]:
    """Yield hints on the inertial sensor and the orientation of a floating base."""
    quat = _copied(sensed.q[:, 3:7])
    omega = _copied(sensed.v[:, 3:6])
    acc = sensed.acc_base_in_base.T
    size = float(np.linalg.norm(acc.mean(axis=1)))  # of the mean: steps shake the base by half of gravity
    if abs(size / G - 1) > bounds.gravity:
        meanings = {1.0: ": in units of g", 0.0: ": gravity is removed", G**2: ": taken for units of g"}
        nearest = min(meanings, key=lambda value: abs(size - value) / max(value, G))
        near = meanings[nearest] if abs(size - nearest) < bounds.gravity * max(nearest, G) else ""
        yield f"acc: its mean has a size of {size:.3g} m/s^2 and not {G:.2f}{near}"
    # Where gravity is removed, acc has no direction in the mean that could tell the order of a quaternion.
    if _upward(quat, acc, size) < UPRIGHT and size > G / 2:
        upward = {name: _upward(given, acc, size) for name, given in _orders(quat).items()}
        text = f"turned into world axes, acc points upwards by {upward['w x y z']:.2f} of its size"
        better = max(upward, key=lambda name: upward[name])
        meant = f"; as {better} by {upward[better]:.2f}" if upward[better] >= UPRIGHT else ""
        yield f"quaternion or acc: {text}{meant}"
    slope = _turning(quat, omega, spans, rate_hz, bounds)
    if slope is not None and not 1 - bounds.gravity < slope < 1 + bounds.gravity:
        yield f"omega: its integral is {slope:.3g} times the turn of the quaternion: unit, sign or axes"


def _copied(values: Array) -> Array:
    """Return values (T, n) as (n, T): a view of a few columns would keep all of a long log in the memory."""
    copied = np.empty(values.shape[::-1])
    for rows in pieces(0, len(values)):
        copied[:, rows] = values[rows].T
    return copied


def _upward(quat: Array, acc: Array, size: float) -> float:
    """Return which share of its size [m/s^2] the mean of acc (3, T) points upwards, turned by quaternions (4, T)."""
    return float(turned(quat, acc).mean(axis=1)[2] / max(size, 1e-9))


def weight_hints(
    nominal: NominalModel, sensed: Sensed, wrenches: Mapping[str, Array], gravity_m_s2: float, bounds: HintBounds
) -> Iterator[str]:
    """Yield hints on the feet's sensors, side -> (T, 6) [N], [N m]: their mean vertical force must carry the weight."""
    # A foot without a sensor may carry any share of the weight.
    if not wrenches or len(wrenches) < len(nominal.robot.feet):
        return
    carried = np.empty(len(sensed))
    for rows in pieces(0, len(sensed)):
        loads = {side: wrench[rows] for side, wrench in wrenches.items()}
        carried[rows] = feet_torque(nominal, sensed.q[rows], loads)[:, 2]
    lifted = float(carried.mean())
    weight = nominal.robot.mass * gravity_m_s2
    if abs(lifted / weight - 1) > bounds.weight:
        means = {side: float(np.linalg.norm(wrench[:, :3], axis=1).mean()) for side, wrench in wrenches.items()}
        text = ", ".join(f"{side} {force:.3g} N" for side, force in means.items())
        share = f"{lifted / weight:.2f} of its weight of {weight:.0f} N"
        meant = ": they read what the robot does to the ground" if abs(lifted / weight + 1) < bounds.weight else ""
        yield f"feet: their sensors carry {share} in the mean ({text} of any direction){meant}"


def _orders(quat: Array) -> dict[str, Array]:
    """Return what four columns mean as quaternions of other conventions, w x y z (4, T) each."""
    back = np.array([1.0, -1.0, -1.0, -1.0])[:, None]
    shifted = quat[[3, 0, 1, 2]]
    return {"w x y z": quat, "x y z w": shifted, "world to base": back * quat, "world to base, x y z w": back * shifted}


def _turning(quat: Array, omega: Array, spans: Sequence[slice], rate_hz: float, bounds: HintBounds) -> float | None:
    """Return the integral of omega over the turn of quaternions (largest axis), None where noise hides it."""
    steps = max(1, round(bounds.window_s * rate_hz))
    turns = [np.zeros((3, 0))]
    integrals = [np.zeros((3, 0))]
    for span in spans:
        quat_of_span = quat[:, span]
        travelled = np.cumsum(omega[:, span], axis=1) / rate_hz
        turns.append(turn(quat_of_span[:, :-steps:steps], quat_of_span[:, steps::steps]))
        integrals.append(np.diff(travelled[:, ::steps], axis=1)[:, : turns[-1].shape[1]])
    change = np.concatenate(turns, axis=1)
    integral = np.concatenate(integrals, axis=1)
    axis = int(np.argmax(np.square(integral).sum(axis=1)))
    component = change[axis]
    other = integral[axis]
    both = float(component @ other) / max(
        float(np.linalg.norm(component) * np.linalg.norm(other)), np.finfo(float).tiny
    )
    return float(component @ other) / float(component @ component) if abs(both) > ALIKE else None
