"""What a detector watches of an estimate: the mean, its standard deviation, one over the other.

Signals can be taken over what the robot's command lets one expect of them, and whitened.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError
from mobnet.core.estimator import Estimate
from mobnet.kernel.detecting import Signal, WatchedSignals

MEAN = "mean"
STD = "std"
RATIO = "ratio"
NORM = "norm"
TOLD = 3  # leading columns of a command that thresholds follow: step ahead, step to the side [m], turn [rad]


@dataclass(frozen=True)
class Watched:
    """What a detector watches.

    Attributes:
        detector: its signals.
        slopes: of each signal, by which share it grows with each metre of a step ahead and to the side, and with each
            radian of a turn, (m, 3) [1/m, 1/m, 1/rad]; None where thresholds are the same for every command.
        whitening: matrix (m, m) of `whitening_of`, where the length of all signals is watched.
    """

    detector: WatchedSignals
    slopes: Array | None = None
    whitening: Array | None = None

    def of(self, estimate: Estimate, command: NDArray[Any]) -> Array:
        """Return the signals of an estimate under a command (T, 5), (T, m), or of one sample, (m,).

        Joints come one after the other, and one kind of signal after the other.

        Raises:
            DataError: the estimate has no standard deviation, and the detector watches it.
        """
        parts = [_signal(kind, estimate) for kind in self.detector.signals]
        signals = parts[0] if len(parts) == 1 else np.concatenate(parts, axis=-1)
        return self.relative(signals.astype(np.float64), command)

    def relative(self, signals: Array, command: NDArray[Any]) -> Array:
        """Return the first k signals (..., k) [N m], a ratio [-], as the detector compares them with thresholds."""
        if self.slopes is not None:
            # (D24): what a robot is told to do decides how large the error of an estimate can be.
            command_size = np.abs(command[..., :TOLD].astype(np.float64))
            signals = signals / (1.0 + command_size @ self.slopes[: signals.shape[-1]].T)
        return signals if self.whitening is None else signals @ self.whitening.T

    def names(self, joints: Sequence[str]) -> list[str]:
        """Return the names of what has a threshold: `mean.LL1`, ..., or `norm` where the length of all is watched."""
        row = self.detector
        return [NORM] if row.norm else [f"{kind}.{joint}" for kind in row.signals for joint in joints]


def _signal(kind: Signal, estimate: Estimate) -> NDArray[Any]:
    """Return a signal of each joint, (..., n) [N m], a ratio [-]."""
    # (D1) [5.3]: the standard deviation surges at a collision, which no training shows. It raises an alarm by itself.
    if kind == MEAN:
        return estimate.tau_ext
    if estimate.std is None:
        raise DataError(f"signal {kind!r}: the estimate has no columns std.<joint>; accepted: {MEAN}")
    return estimate.std if kind == STD else estimate.tau_ext / estimate.std


def whitening_of(signals: Array) -> Array:
    """Return the matrix (m, m) after which signals (T, m) have the unit matrix as their second moment.

    The length of whitened signals is the Mahalanobis distance from zero.
    """
    # (D2): the second moment about zero and not the covariance, because a constant error of the estimate raises false
    # alarms as well. The small diagonal keeps signals that always move together from having no inverse.
    moment = signals.T @ signals / len(signals)
    return np.linalg.inv(np.linalg.cholesky(moment + 1e-9 * np.trace(moment) * np.eye(len(moment))))


def slopes_of(heights: Array, commands: Array, quantile: float) -> Array:
    """Return the slopes of signals (m, 3) from their largest values in swings (n, m) under commands (n, 5).

    A quantile of the largest values is fitted as a constant and a share of it for each part of the command, none of
    which may be negative. All are zero where fewer swings lie above the fit than it has numbers: it would go through
    the largest values themselves.
    """
    command_sizes = np.abs(commands[:, :TOLD])
    if (1.0 - quantile) * len(heights) < 1 + TOLD:
        return np.zeros((heights.shape[1], TOLD))
    planes = [_quantile_plane(command_sizes, heights_of_signal, quantile) for heights_of_signal in heights.T]
    return np.array([plane[1:] / plane[0] for plane in planes])


def _quantile_plane(command_sizes: Array, height: Array, quantile: float) -> Array:
    """Return the constant and the slopes (4,) of a quantile of heights (n,) over |commands| (n, 3)."""
    from scipy.optimize import linprog  # here, as it takes a second to import
    from scipy.sparse import eye_array, hstack

    # (D25), quantile regression as a linear program (Koenker and Bassett 1978): what lies above and below the plane
    # costs unequally. A signal is never smaller than its smallest largest value, so the constant is above zero.
    count = len(height)
    plane = np.column_stack([np.ones(count), command_sizes])
    size = plane.shape[1]
    cost = np.repeat([0.0, quantile, 1.0 - quantile], [size, count, count])
    sides = hstack([plane, eye_array(count), -eye_array(count)])
    bounds = [(float(height.min()), None), *[(0.0, None)] * (cost.size - 1)]
    return linprog(cost, A_eq=sides, b_eq=height, bounds=bounds, method="highs").x[:size]
