"""The momentum observer of section 3.2, in discrete time, second order in the sample time.

With T the sample time and gamma = exp(-K_0 T), exact for a torque that is constant over a sample:

    r_k = gamma r_{k-1} + (1 - gamma) * ((p_k - p_{k-1}) / T - u_k - (beta_k + beta_{k-1}) / 2)

p_k and beta_k belong to the state at t_k, while u_k is the mean over (t_{k-1}, t_k] of the torque that the motors gave.
A log holds either that mean or samples tau_k of the torque at the ticks; u_k = (tau_k + tau_{k-1}) / 2 then. A sample
that is taken for the mean is half a sample late: the residual is wrong by T / 2 times the rate of the torque.
The external torque behind the same pole is what r is compared with: r = filtered tau_e + filtered tau_u (15).
"""

import logging
from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import ConfigError, DataError, not_accepted
from mobnet.core.recording import Sensed
from mobnet.estimation.low_pass import exact_pole, filtered
from mobnet.robot.dynamics import momentum_and_beta
from mobnet.robot.nominal import NominalModel

TorqueKind = Literal["mean", "sample"]  # over the interval that ends at the tick, or at the tick
LOGGED_ROWS = 100_000  # samples between two messages of progress
log = logging.getLogger(__name__)


@dataclass(frozen=True)
class ObserverState:
    """What the observer carries from one sample to the next; all None before the first.

    Attributes:
        momentum: p of (4) at the last sample (nv,) [kg m/s] and [kg m^2/s].
        beta: C^T v - g of (6) at the last sample (nv,) [N] and [N m].
        residual: r of (9) at the last sample (nv,) [N] and [N m].
        torque: motors' torque at the last sample (nu,) [N m].
    """

    momentum: Array | None = None
    beta: Array | None = None
    residual: Array | None = None
    torque: Array | None = None


class MomentumObserver:
    """Momentum observer (4)..(11): r follows the external torque through a first-order low-pass of K_0.

    Attributes:
        nominal: the model it knows.
        gain_hz: K_0 of (7) [1/s].
        pole: gamma = exp(-K_0 T) [-].
        rate_hz: samples per second [Hz].
        torque: whether `Sensed.tau_motor` holds means over the intervals that end at the ticks, as the simulator writes
            them, or samples at the ticks.
    """

    def __init__(self, nominal: NominalModel, gain_hz: float, rate_hz: float, torque: TorqueKind = "mean") -> None:
        """Set up the observer.

        Raises:
            ConfigError: a gain or a rate is not positive, or the kind of torque is unknown.
        """
        if torque not in get_args(TorqueKind):
            raise ConfigError(not_accepted("torque", torque, get_args(TorqueKind)))
        self.torque = torque
        self.nominal = nominal
        self._motors = slice(len(nominal.robot.layout.virtual), None)  # of a generalized velocity
        self.gain_hz = gain_hz
        self.pole = exact_pole(gain_hz, rate_hz)
        self.rate_hz = rate_hz

    def init(self) -> ObserverState:
        """Return the state before the first sample."""
        return ObserverState()

    def step(self, state: ObserverState, sample: Sensed) -> tuple[ObserverState, Array]:
        """Take one sample (1-D arrays); return the new state and r of (9), (nv,) [N] and [N m]. The first r is zero."""
        p, beta = momentum_and_beta(self.nominal, sample.q, sample.v)
        torque = np.array(sample.tau_motor, dtype=np.float64)  # kept: a robot may write its samples into one buffer
        if state.momentum is None or state.beta is None or state.residual is None or state.torque is None:
            residual = np.zeros_like(p)
        else:
            applied = np.zeros_like(p)
            applied[self._motors] = self._mean_torque(torque, state.torque)
            raw = (p - state.momentum) * self.rate_hz - applied - (beta + state.beta) / 2
            residual = self.pole * state.residual + (1 - self.pole) * raw
        return ObserverState(p, beta, residual, torque), residual

    def residual(self, sensed: Sensed) -> Array:
        """Return r of (9) over one contiguous stretch, (T, nv) [N] and [N m]; equal to stepping through it.

        Raises:
            DataError: positions, velocities or torques do not fit the model.
        """
        layout, shapes = self.nominal.robot.layout, [sensed.q.shape, sensed.v.shape, sensed.tau_motor.shape]
        accepted = [(len(sensed), width) for width in (layout.nq, layout.nv, layout.nu)]
        if shapes != accepted:
            raise DataError(f"samples q, v, tau_motor of shapes {shapes}; accepted: {accepted}")
        p, beta = self._terms(sensed)
        raw = np.zeros_like(p)
        raw[1:] = np.diff(p, axis=0) * self.rate_hz - (beta[1:] + beta[:-1]) / 2
        raw[1:, self._motors] -= self._mean_torque(sensed.tau_motor[1:], sensed.tau_motor[:-1])
        return filtered(raw, self.pole)

    def _mean_torque(self, now: NDArray[Any], before: NDArray[Any]) -> NDArray[Any]:
        """Return u_k from the motors' torque logged at t_k and at t_{k-1}, (..., nu) [N m]."""
        return now if self.torque == "mean" else np.add(now, before, dtype=np.float64) / 2

    def _terms(self, sensed: Sensed) -> tuple[Array, Array]:
        """Return p and beta (T, nv) each, telling of progress on long stretches."""
        p, beta = np.empty(sensed.v.shape), np.empty(sensed.v.shape)
        for start in range(0, len(sensed), LOGGED_ROWS):
            rows = slice(start, start + LOGGED_ROWS)
            p[rows], beta[rows] = momentum_and_beta(self.nominal, sensed.q[rows], sensed.v[rows])
            log.info("momentum of %d of %d samples", min(rows.stop, len(sensed)), len(sensed))
        return p, beta
