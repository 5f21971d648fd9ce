"""Short windows of a log, in which the momentum of the nominal model must change by the mean torque.

This is (O1) of docs/notes/observer.md. No acceleration is needed. All hints on torques look at these windows.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.recording import Sensed
from mobnet.kernel.drive import TorqueKind
from mobnet.robot.dynamics import momentum_and_beta
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import feet_torque
from mobnet.robotlog.hints.bounds import HintBounds
from mobnet.robotlog.hints.fits import dry, unexplained
from mobnet.robotlog.long_arrays import give_back

NODES = 11  # samples of a window at which beta is taken


class MotorDemand(NamedTuple):
    """What the motion of windows asks of the motors: `needed` (W, nu) [N m], and terms of their friction (W, nu, 3)."""

    needed: Array
    terms: Array


@dataclass(frozen=True)
class MotionWindows:
    """Positions and velocities at the nodes of windows (W, NODES, n), and mean torques of the motors (W, nu) [N m].

    `loads` are what the feet's sensors read, side -> (W, NODES, 6) [N], [N m]; `beside` is what acts on the joints
    beside the motors, as they are logged (W, nu) [N m].
    """

    q: Array
    v: Array
    torque: Array
    beside: Array
    loads: Mapping[str, Array]
    period_s: float

    def asked(self, nominal: NominalModel) -> MotorDemand:
        """Return what the motion needs of the motors, and what their friction and rotor inertia multiply."""
        speed = self.v[:, :, len(nominal.robot.layout.virtual) :]
        terms = np.stack([_mean(dry(speed)), _mean(speed), (speed[:, -1] - speed[:, 0]) / self.period_s], axis=-1)
        return MotorDemand(self.needed(nominal) - self.beside, terms)

    def needed(self, nominal: NominalModel) -> Array:
        """Return the mean torques that the motion needs at the joints (W, nu) [N m]."""
        shape = self.q.shape[:2]
        p, beta = (term.reshape(*shape, -1) for term in momentum_and_beta(nominal, self.q, self.v))
        feet = feet_torque(nominal, self.q, self.loads).mean(axis=1)
        needed = (p[:, -1] - p[:, 0]) / self.period_s - _mean(beta) - feet
        return needed[:, len(nominal.robot.layout.virtual) :]

    def thinned(self, step: int) -> "MotionWindows":
        """Return every so many of the windows."""
        loads = {side: load[::step] for side, load in self.loads.items()}
        q = self.q[::step]
        v = self.v[::step]
        torque = self.torque[::step]
        beside = self.beside[::step]
        return MotionWindows(q, v, torque, beside, loads, self.period_s)


def repeated(windows: MotionWindows, times: int) -> MotionWindows:
    """Return windows so many times, one after another."""
    loads = {side: np.concatenate([load] * times) for side, load in windows.loads.items()}
    q = np.concatenate([windows.q] * times)
    v = np.concatenate([windows.v] * times)
    torque = np.concatenate([windows.torque] * times)
    beside = np.concatenate([windows.beside] * times)
    return MotionWindows(q, v, torque, beside, loads, windows.period_s)


def windows_of(
    sensed: Sensed,
    spans: Sequence[slice],
    rate_hz: float,
    wrenches: Mapping[str, Array],
    kind: TorqueKind,
    late: float,
    bounds: HintBounds,
) -> MotionWindows | None:
    """Return windows spread evenly over the spans, None where no span is long enough.

    Torques of a kind are so many samples late.
    """
    steps = max(2, round(bounds.window_s * rate_hz))
    # Torques that are moved in time must stay within the span, too.
    apart = math.ceil(abs(late))
    firsts = [np.arange(s.start + apart, s.stop - steps - apart, steps) for s in spans]
    starts = np.concatenate(firsts or [np.zeros(0)]).astype(np.intp)
    if not len(starts):
        return None
    count = min(bounds.windows, len(starts))
    starts = starts[np.linspace(0, len(starts) - 1, count).round().astype(np.intp)]
    nodes = starts[:, None] + np.linspace(0, steps, min(NODES, steps + 1)).round().astype(np.intp)
    q = sensed.q[nodes].astype(np.float64)
    give_back()
    v = sensed.v[nodes].astype(np.float64)
    give_back()
    torque = _mean_torque(sensed, starts[:, None] + np.arange(steps + 1), kind, late)
    give_back()
    loads = {side: wrench[nodes] for side, wrench in wrenches.items()}
    return MotionWindows(q, v, torque, np.zeros(torque.shape), loads, steps / rate_hz)


def _mean_torque(sensed: Sensed, rows: NDArray[np.intp], kind: TorqueKind, late: float) -> Array:
    """Return the mean torque of the motors between the first and the last of rows (W, n), so many samples late."""
    whole = math.floor(late)
    part = late - whole
    torque = sensed.tau_motor[rows + whole].astype(np.float64)
    if part > 0:
        torque = (1 - part) * torque + part * sensed.tau_motor[rows + whole + 1]
    return _mean(torque) if kind == "sample" else torque[:, 1:].mean(axis=1)


def _mean(nodes: Array) -> Array:
    """Return the mean of what is given at the nodes of windows (W, n, ...), by the rule of trapezia."""
    return (nodes.sum(axis=1) - (nodes[:, 0] + nodes[:, -1]) / 2) / (nodes.shape[1] - 1)


def known_joints(
    nominal: NominalModel, windows: MotionWindows, asked: MotorDemand, bounds: HintBounds
) -> NDArray[np.bool_]:
    """Return of which joints a log tells (nu,): those with a torque, but on no leg whose contact is not measured."""
    robot = nominal.robot
    felt = [foot.limb for side, foot in robot.feet.items() if side not in windows.loads]
    blind = set(robot.layout.limbs(felt))
    sees = np.array([joint not in blind for joint in robot.layout.actuated])
    sees &= np.ptp(windows.torque, axis=0) > 0.0
    largest = np.maximum(size_of(windows.torque), size_of(asked.needed))
    return sees & (largest > bounds.least_torque * robot.torque_limits)


def left_of(
    asked: MotorDemand, torque: Array, nominal: NominalModel, bounds: HintBounds, joints: Sequence[int]
) -> Array:
    """Return the share of the square torque of some joints that motion and friction leave unexplained (n,)."""
    columns = list(joints)
    offsets = bounds.offset * nominal.robot.torque_limits[columns]
    terms = np.moveaxis(asked.terms[:, columns], 1, 0)
    needed, measured = (values[:, columns].T[..., None] for values in (asked.needed, torque))
    return np.minimum(unexplained(terms, needed, measured, offsets)[:, 0], 1.0)


def size_of(values: Array) -> Array:
    """Return the root mean square of columns (n,)."""
    return np.sqrt(np.square(values).mean(axis=0))
