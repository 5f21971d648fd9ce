"""Whether the signals of an array agree as physics says; if not, a unit, an order, a sign or the rate is wrong.

Over short windows the change of a joint's position is the integral of its velocity, the turn of the base that of its
angular velocity, and on average its inertial sensor reads gravity, upwards. A hundred windows a minute are looked at.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.contract import QUATERNION
from mobnet.core.errors import not_accepted

WINDOW_S, WINDOWS = 0.1, 100  # length, and how many of a piece of an array
MOVES_RAD = 0.005  # a mean turn in a window below this tells nothing: it is noise
APART = 0.05  # share of the mean square by which the two may differ; a factor of 0.73 or 1.37 between them does
UP = 0.9  # cosine of the angle between gravity as the sensor reads it and the vertical
GRAVITY_M_S2 = (1.5, 30.0)  # of any planet to stand on; in units of g, or without gravity, it is less
SETTLED_S = 1.0  # in less time a step or a hit may hide gravity


class MotionCheck:
    """Looks at the positions and velocities of an array, piece by piece."""

    def __init__(self, names: Sequence[str], segments: Sequence[Sequence[int]], rate_hz: float) -> None:
        """Look at columns of these names, within segments (start, end) of rows, at a rate [Hz]."""
        where = {name: k for k, name in enumerate(names)}
        positions = [name[2:] for name in names if name.startswith("q.")]
        # A simulator may shift the base's place.
        self._joints = [joint for joint in positions if f"v.{joint}" in where and not joint.startswith("base_")]
        self._q = [where[f"q.{joint}"] for joint in self._joints]
        self._v = [where[f"v.{joint}"] for joint in self._joints]
        self._quat = _places(where, QUATERNION)
        self._omega = _places(where, [f"v.omega_{axis}" for axis in "xyz"])
        self._acc = _places(where, [f"acc.{axis}" for axis in "xyz"])
        self._segments = segments
        self._rate_hz = rate_hz
        longest = max(end - start for start, end in segments)
        self._steps = min(max(1, round(WINDOW_S * rate_hz)), longest - 1)
        self._turns = _Agreement(len(self._joints))
        self._bodies = _Agreement(3)
        self._gravity = np.zeros(3)
        self._samples = 0

    def look(self, first: int, columns: NDArray[np.float32]) -> None:
        """Look at samples, (C, n), of which `first` is the number of the first."""
        starts = self._starts(first, columns.shape[1])
        if self._steps < 1 or not len(starts):
            return
        rows = starts[:, None] + np.arange(self._steps + 1)
        if self._joints:
            before, after = (_picked(columns, self._q, ends) for ends in (starts, starts + self._steps))
            self._turns.add(after - before, self._integral(_picked(columns, self._v, rows)))
        if self._quat and self._omega:
            before, after = (_picked(columns, self._quat, ends) for ends in (starts, starts + self._steps))
            self._bodies.add(turn(before, after), self._integral(_picked(columns, self._omega, rows)))
        if self._quat and self._acc:
            quat, acc = (_picked(columns, places, rows.ravel()) for places in (self._quat, self._acc))
            self._gravity += turned(quat, acc).sum(axis=1)
            self._samples += rows.size

    def _starts(self, first: int, count: int) -> NDArray[np.intp]:
        """Return where windows start that lie within the piece and within a segment, evenly thinned."""
        spans = [(max(start - first, 0), min(end - first, count)) for start, end in self._segments]
        starts = np.concatenate([np.arange(a, b - self._steps, max(1, self._steps)) for a, b in spans])
        return starts[np.unique(np.linspace(0, len(starts) - 1, min(WINDOWS, len(starts))).round().astype(np.intp))]

    def _integral(self, rates: Array) -> Array:
        """Return the integral of rates (n, K, steps + 1) over their windows, (n, K), by the trapezoidal rule."""
        return (rates.sum(axis=2) - (rates[..., 0] + rates[..., -1]) / 2) / self._rate_hz

    def faults(self) -> list[str]:
        """Return a line for each way in which the signals disagree."""
        lines = []
        rules = {"v": (self._turns, self._joints, "q"), "v.omega": (self._bodies, list("xyz"), "q.quat")}
        for signal, (agreement, names, position) in rules.items():
            wrong = agreement.apart()
            if len(wrong):
                few = ", ".join(names[k] for k in wrong[:3]) + (f" and {len(wrong) - 3} more" if len(wrong) > 3 else "")
                accepted = "the change itself, to which unit, order, sign and rate_hz must fit"
                text = f"an integral of {agreement.ratio(wrong[0]):.3g} x the change of {position}"
                lines.append(f"{signal} of {few}: {text} is not accepted; accepted: {accepted}")
        if self._samples >= SETTLED_S * self._rate_hz:
            mean = self._gravity / self._samples
            size = float(np.linalg.norm(mean))
            if not (GRAVITY_M_S2[0] <= size <= GRAVITY_M_S2[1] and mean[2] >= UP * size):
                accepted = f"{GRAVITY_M_S2[0]} to {GRAVITY_M_S2[1]:g} m/s^2 along z: gravity is included"
                lines.append(not_accepted("acc, turned into world axes: mean", mean.round(2).tolist(), [accepted]))
        return lines


class _Agreement:
    """Sums over windows of changes and integrals of n signals."""

    def __init__(self, count: int) -> None:
        """Start with none of `count` signals."""
        self._apart, self._size, self._both, self._change = np.zeros((4, count))
        self._windows = 0

    def add(self, change: Array, integral: Array) -> None:
        """Add changes and integrals (n, K) [rad]."""
        self._apart += np.square(change - integral).sum(axis=1)
        self._size += (np.square(change) + np.square(integral)).sum(axis=1)
        self._both += (change * integral).sum(axis=1)
        self._change += np.square(change).sum(axis=1)
        self._windows += change.shape[1]

    def apart(self) -> NDArray[np.intp]:
        """Return which signals move and do not agree."""
        return np.flatnonzero((self._size > 2 * self._windows * MOVES_RAD**2) & (self._apart > APART * self._size))

    def ratio(self, k: int) -> float:
        """Return by how much the change must be multiplied to be nearest to the integral."""
        return float(self._both[k] / max(self._change[k], np.finfo(float).tiny))


def turn(before: Array, after: Array) -> Array:
    """Return the small turn between quaternions w x y z (4, K) as a vector (3, K) [rad], axes of the first."""
    w = before[0] * after[0] + (before[1:] * after[1:]).sum(axis=0)
    u = -np.cross(before[1:], after[1:], axis=0)
    return 2.0 * np.sign(w) * (u + before[0] * after[1:] - after[0] * before[1:])


def turned(quat: Array, vector: Array) -> Array:
    """Return vectors (3, K) of body axes in world axes, by unit quaternions w x y z (4, K)."""
    across = np.cross(quat[1:], vector, axis=0)
    return vector + 2.0 * (quat[0] * across + np.cross(quat[1:], across, axis=0))


def _places(where: Mapping[str, Any], names: Sequence[str]) -> list[int]:
    """Return where columns stand, or nothing if one is not there."""
    return [where[name] for name in names] if set(names) <= where.keys() else []


def _picked(columns: NDArray[np.float32], places: Sequence[int], rows: NDArray[np.intp]) -> Array:
    """Return some rows, of any shape, of some columns (C, n), in float64: (len(places), *rows.shape)."""
    picked = columns[np.array(places)[:, None], rows.ravel()].astype(np.float64)
    return picked.reshape(len(places), *rows.shape)
