"""The momentum observer of section 3.2 over arrays, in discrete time, second order in the sample time.

The equations (O1) to (O5) are derived in docs/notes/observer.md, p and beta in `mobnet.kernel.momentum`.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.kernel.drive import DriveParameters, TorqueKind
from mobnet.kernel.low_pass import exact_pole, filter_in_place

BLOCK_ROWS = 2_000  # samples worked on together: larger arrays would not fit into the processor's cache
Terms = Callable[[NDArray[Any], NDArray[Any]], tuple[Array, Array]]  # of q and v: p of (4) and beta of (6)


@dataclass(frozen=True)
class ObserverState:
    """What the observer carries from one sample to the next; all None before the first.

    Attributes:
        momentum: p of (4) at the last sample (nv,) [kg m/s] and [kg m^2/s].
        beta: C^T v - g of (6) at the last sample (nv,) [N] and [N m].
        residual: r of (9) at the last sample (nv,) [N] and [N m].
        torque: motors' torque at the last sample (nu,) [N m].
        bend: state of the drives' friction (nu,), and
        friction: its torque at the last sample (nu,) [N m]; None for a robot without friction.
    """

    momentum: Array | None = None
    beta: Array | None = None
    residual: Array | None = None
    torque: Array | None = None
    bend: Array | None = None
    friction: Array | None = None


class Recursion:
    """Momentum observer (4) to (11): r follows the external torque through a first-order low-pass of K_0.

    Attributes:
        terms: what computes p and beta of samples.
        motors: which velocities (nv,) have a motor, a slice or their columns (nu,).
        gain_hz: K_0 of (7) [1/s].
        pole: gamma = exp(-K_0 T) [-].
        rate_hz: samples per second [Hz].
        torque: whether torques are means over the intervals that end at the ticks, or samples at the ticks.
        drives: friction of the drives and errors of their torques; None where they are not known.
    """

    def __init__(
        self,
        terms: Terms,
        motors: slice | NDArray[np.intp],
        gain_hz: float,
        rate_hz: float,
        torque: TorqueKind,
        drives: DriveParameters | None,
    ) -> None:
        """Set up the recursion.

        Raises:
            ConfigError: a gain or a rate is not positive, or the kind of torque is unknown.
        """
        if torque not in get_args(TorqueKind):
            raise ConfigError(not_accepted("torque", torque, get_args(TorqueKind)))
        self.terms = terms
        self.motors = motors
        self.gain_hz = gain_hz
        self.pole = exact_pole(gain_hz, rate_hz)
        self.rate_hz = rate_hz
        self.torque = torque
        self.drives = drives

    def step(
        self, state: ObserverState, q: NDArray[Any], v: NDArray[Any], tau: NDArray[Any]
    ) -> tuple[ObserverState, Array]:
        """Take one sample (1-D arrays); return the new state and r of (9), (nv,) [N] and [N m]. The first r is zero."""
        p, beta = self.terms(q, v)
        torque = np.array(tau, dtype=np.float64)  # kept: a robot may write its samples into one buffer
        if state.momentum is None or state.beta is None or state.residual is None or state.torque is None:
            # (O5): before the first sample there is no momentum to take a difference from.
            residual = np.zeros_like(p)
            bend, friction = self._friction(None, v[None], torque[None])
        else:
            applied = np.zeros_like(p)
            bend, friction = self._friction(state.bend, v[None], torque[None])
            applied[self.motors] = self._mean_torque(torque, state.torque)
            if self.drives is not None and friction is not None and state.friction is not None:
                lost = (friction[0] + state.friction) / 2
                applied[self.motors] = self.drives.scale * applied[self.motors] - lost
            # (O1): beta is known at both ends of the sample; either of them alone would cost an order in T.
            raw = (p - state.momentum) * self.rate_hz - applied - (beta + state.beta) / 2
            # (O4), the solution of (10) over a sample, so that r has the low-pass of the truth it is compared with.
            residual = self.pole * state.residual + (1 - self.pole) * raw
        return ObserverState(p, beta, residual, torque, bend, None if friction is None else friction[0]), residual

    def follow(
        self, state: ObserverState, q: NDArray[Any], v: NDArray[Any], tau: NDArray[Any], out: Array
    ) -> ObserverState:
        """Write r of (9) of contiguous samples into `out` (n, nv) [N] and [N m]; return the state after them.

        The state is that after the sample before the first one, or a fresh one: a stretch may come in pieces. Arrays of
        samples may be overwritten afterwards.
        """
        for start in range(0, len(q), BLOCK_ROWS):
            block = slice(start, start + BLOCK_ROWS)
            rows = out[block]
            after = self._write_raw(state, q[block], v[block], tau[block], rows)
            # (O5) once more: the first row is zero, and the low-pass from zero is then the recursion (O4) of `step`.
            filter_in_place(rows, self.pole, state.residual)
            state = replace(after, residual=rows[-1].copy())
        return state

    def _friction(self, bend: Array | None, v: NDArray[Any], torque: NDArray[Any]) -> tuple[Array | None, Array | None]:
        """Return the state of the drives' friction after samples, and its torque at each (T, nu) [N m]."""
        if self.drives is None:
            return None, None
        before = self.drives.init() if bend is None else bend
        return self.drives.run(before, v[:, self.motors], torque, self.rate_hz)

    def _write_raw(
        self, state: ObserverState, q: NDArray[Any], v: NDArray[Any], tau: NDArray[Any], raw: Array
    ) -> ObserverState:
        """Write what (O4) filters for successive samples into `raw` (n, nv) [N], [N m]; return the state after them."""
        p, beta = self.terms(q, v)
        bend, friction = self._friction(state.bend, v, tau)
        last_friction = None if friction is None else friction[-1]
        after = ObserverState(p[-1], beta[-1], None, tau[-1].copy(), bend, last_friction)
        torque = tau
        if state.momentum is None or state.beta is None or state.torque is None:
            raw[0] = 0.0
            raw = raw[1:]
        else:
            p = _behind(state.momentum, p)
            beta = _behind(state.beta, beta)
            torque = _behind(state.torque, torque)
            friction = None if friction is None or state.friction is None else _behind(state.friction, friction)
        np.subtract(p[1:], p[:-1], out=raw)
        raw *= self.rate_hz
        raw -= (beta[1:] + beta[:-1]) / 2
        applied = self._mean_torque(torque[1:], torque[:-1])
        if self.drives is not None and friction is not None:
            applied = self.drives.scale * applied - (friction[1:] + friction[:-1]) / 2
        raw[:, self.motors] -= applied
        return after

    def _mean_torque(self, now: NDArray[Any], before: NDArray[Any]) -> NDArray[Any]:
        """Return u_k from the motors' torque logged at t_k and at t_{k-1}, (..., nu) [N m]."""
        # (O2): a value at the tick taken for the mean would be half a sample late.
        return now if self.torque == "mean" else np.add(now, before, dtype=np.float64) / 2


def _behind(last: NDArray[Any], rows: NDArray[Any]) -> NDArray[Any]:
    """Return rows (n, k) behind the one before them (k,), (n + 1, k)."""
    return np.concatenate([last[None], rows])
