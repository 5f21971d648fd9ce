"""The momentum observer of section 3.2, in discrete time, second order in the sample time.

With T the sample time and gamma = exp(-K_0 T), exact for a torque that is constant over a sample:

    r_k = gamma r_{k-1} + (1 - gamma) * ((p_k - p_{k-1}) / T - u_k - (beta_k + beta_{k-1}) / 2)

u_k is the mean over (t_{k-1}, t_k] of the torque that the motors gave, while p_k and beta_k belong to the state at t_k.
The external torque behind the same pole is what r is compared with: r = filtered tau_e + filtered tau_u (15).
"""

from __future__ import annotations

import logging
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from mobnet.core.errors import ConfigError, DataError
from mobnet.core.joints import N_VIRTUAL
from mobnet.core.recording import Sensed
from mobnet.robot.dynamics import momentum_and_beta
from mobnet.robot.nominal import NominalModel

Array = NDArray[np.float64]
LOGGED_ROWS = 100_000  # samples between two messages of progress
log = logging.getLogger(__name__)


@dataclass(frozen=True)
class ObserverState:
    """What the observer carries from one sample to the next; all None before the first.

    Attributes:
        momentum: p of (4) at the last sample (nv,) [kg m/s] and [kg m^2/s].
        beta: C^T v - g of (6) at the last sample (nv,) [N] and [N m].
        residual: r of (9) at the last sample (nv,) [N] and [N m].
    """

    momentum: Array | None = None
    beta: Array | None = None
    residual: Array | None = None


class MomentumObserver:
    """Momentum observer (4)..(11): r follows the external torque through a first-order low-pass of K_0.

    Attributes:
        nominal: the model it knows.
        gain_hz: K_0 of (7) [1/s].
        pole: gamma = exp(-K_0 T) [-].
        rate_hz: samples per second [Hz].
    """

    def __init__(self, nominal: NominalModel, gain_hz: float, rate_hz: float) -> None:
        """Set up the observer.

        Args:
            nominal: the model it knows.
            gain_hz: K_0 of (7) [1/s].
            rate_hz: samples per second [Hz].

        Raises:
            ConfigError: a gain or a rate is not positive.
        """
        self.nominal = nominal
        self.gain_hz = gain_hz
        self.pole = exact_pole(gain_hz, rate_hz)
        self.rate_hz = rate_hz

    def init(self) -> ObserverState:
        """Return the state before the first sample."""
        return ObserverState()

    def step(self, state: ObserverState, sample: Sensed) -> tuple[ObserverState, Array]:
        """Take one sample (1-D arrays); return the new state and r of (9), (nv,) [N] and [N m]. The first r is zero."""
        p, beta = momentum_and_beta(self.nominal, sample.q, sample.v)
        if state.momentum is None or state.beta is None or state.residual is None:
            residual = np.zeros_like(p)
        else:
            applied = _with_base(np.asarray(sample.tau_motor, dtype=np.float64))
            raw = (p - state.momentum) * self.rate_hz - applied - (beta + state.beta) / 2
            residual = self.pole * state.residual + (1 - self.pole) * raw
        return ObserverState(p, beta, residual), residual

    def residual(self, sensed: Sensed) -> Array:
        """Return r of (9) over one contiguous stretch, (T, nv) [N] and [N m]; equal to stepping through it.

        Raises:
            DataError: positions or velocities do not fit the model.
        """
        model = self.nominal.model
        if sensed.q.shape[1:] != (model.nq,) or sensed.v.shape[1:] != (model.nv,):
            raise DataError(
                f"samples q, v of shapes {sensed.q.shape}, {sensed.v.shape}; accepted: (T, {model.nq}), (T, {model.nv})"
            )
        p, beta = self._terms(sensed)
        raw = np.zeros_like(p)
        raw[1:] = np.diff(p, axis=0) * self.rate_hz - (beta[1:] + beta[:-1]) / 2
        raw[1:, N_VIRTUAL:] -= sensed.tau_motor[1:]
        return _filtered(raw, self.pole)

    def _terms(self, sensed: Sensed) -> tuple[Array, Array]:
        """Return p and beta (T, nv) each, telling of progress on long stretches."""
        p, beta = np.empty(sensed.v.shape), np.empty(sensed.v.shape)
        for start in range(0, len(sensed), LOGGED_ROWS):
            rows = slice(start, start + LOGGED_ROWS)
            p[rows], beta[rows] = momentum_and_beta(self.nominal, sensed.q[rows], sensed.v[rows])
            log.info("momentum of %d of %d samples", min(rows.stop, len(sensed)), len(sensed))
        return p, beta


def exact_pole(gain_hz: float, rate_hz: float) -> float:
    """Return gamma = exp(-K_0 T), the sampled pole of (11) [-].

    Raises:
        ConfigError: a gain or a rate is not positive.
    """
    if gain_hz <= 0 or rate_hz <= 0:
        raise ConfigError(f"observer gain {gain_hz} 1/s at {rate_hz} Hz; accepted: numbers above 0")
    return float(np.exp(-gain_hz / rate_hz))


def low_pass(x: NDArray[Any], gain_hz: float, rate_hz: float) -> Array:
    """Return x (T, ...) behind the low-pass of (11), sampled as the observer is: zero at the first sample, same pole.

    Args:
        x: means over each sample (T, ...).
        gain_hz: K_0 of (7) [1/s].
        rate_hz: samples per second [Hz].

    Raises:
        ConfigError: a gain or a rate is not positive.
    """
    start_at_zero = np.array(x, dtype=np.float64)
    start_at_zero[:1] = 0.0
    return _filtered(start_at_zero, exact_pole(gain_hz, rate_hz))


def _filtered(x: Array, pole: float) -> Array:
    """Return y_k = pole y_{k-1} + (1 - pole) x_k along time, (T, ...)."""
    return np.asarray(lfilter([1 - pole], [1, -pole], x, axis=0))


def _with_base(torque: Array) -> Array:
    """Return tau_v of (1): six zeros of the base, then the motors' torque, (nv,) [N] and [N m]."""
    return np.concatenate([np.zeros(N_VIRTUAL), torque])
