"""What a detector watches of an estimate: the mean, its standard deviation, one over the other, whitened if asked."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError
from mobnet.core.estimator import Estimate
from mobnet.settings.detection import Detector, Signal

MEAN, STD, RATIO, NORM = "mean", "std", "ratio", "norm"


def signals_of(detector: Detector, estimate: Estimate, whitening: Array | None = None) -> Array:
    """Return the signals of a detector, (T, m) or (m,): joint by joint, one kind after the other.

    A whitening matrix (m, m) is that of `whitening_of`.

    Raises:
        DataError: the estimate has no standard deviation, and the detector watches it.
    """
    parts = [_signal(kind, estimate) for kind in detector.signals]
    signals = np.concatenate(parts, axis=-1).astype(np.float64)
    return signals if whitening is None else signals @ whitening.T


def _signal(kind: Signal, estimate: Estimate) -> NDArray[Any]:
    """Return a signal of each joint, (..., n) [N m], a ratio [-]."""
    # (D1) [5.3]: the standard deviation surges at a collision, which no training shows. It raises an alarm by itself.
    if kind == MEAN:
        return estimate.tau_ext
    if estimate.std is None:
        raise DataError(f"signal {kind!r}: the estimate has no columns std.<joint>; accepted: {MEAN}")
    return estimate.std if kind == STD else estimate.tau_ext / estimate.std


def signal_names(detector: Detector, joints: Sequence[str]) -> list[str]:
    """Return the names of what has a threshold: `mean.LL1`, ..., or `norm` where the length of all is watched."""
    return [NORM] if detector.norm else [f"{kind}.{joint}" for kind in detector.signals for joint in joints]


def whitening_of(signals: Array) -> Array:
    """Return the matrix (m, m) after which signals (T, m) have the unit matrix as their second moment.

    The length of whitened signals is the Mahalanobis distance from zero.
    """
    # (D2): the second moment about zero and not the covariance, because a constant error of the estimate raises false
    # alarms as well. The small diagonal keeps signals that always move together from having no inverse.
    moment = signals.T @ signals / len(signals)
    return np.linalg.inv(np.linalg.cholesky(moment + 1e-9 * np.trace(moment) * np.eye(len(moment))))
