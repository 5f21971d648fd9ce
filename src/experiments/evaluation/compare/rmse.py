"""Errors of an estimated torque: RMSE, relative RMSE and roughness."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Spans = tuple[tuple[int, int], ...]
PERCENT = 100.0


def parts(signal: NDArray[Any], spans: Spans) -> list[NDArray[Any]]:
    """Return the contiguous stretches of a signal (T, n) [N m], each (end - start, n)."""
    return [signal[start:end] for start, end in spans]


def rmse(estimate: NDArray[Any], truth: NDArray[Any], spans: Spans) -> NDArray[np.float64]:
    """Return the root-mean-square error of each joint (n,) [N m], V1..V3 [N], the number of Tables 5 to 8.

    The truth is the external torque behind the observer's low-pass, tau~_e of (15); both are (T, n) [N m], V1..V3 [N].
    Rows within the spans (start, end) count.
    """
    ours, true = (np.concatenate(parts(signal, spans)).astype(np.float64) for signal in (estimate, truth))
    return np.sqrt(np.mean((ours - true) ** 2, axis=0))


def relative_rmse(estimate: NDArray[Any], truth: NDArray[Any], spans: Spans) -> NDArray[np.float64]:
    """Return `rmse` over the largest true torque of each joint (n,) [%], the r-RMSE of Table 7.

    A joint without any external torque has none: nan.
    """
    largest = np.abs(np.concatenate(parts(truth, spans)), dtype=np.float64).max(axis=0)
    largest[largest == 0.0] = np.nan
    return PERCENT * rmse(estimate, truth, spans) / largest


def roughness(signal: NDArray[Any], spans: Spans, rate_hz: float) -> NDArray[np.float64]:
    """Return how jagged each signal (T, n) [N m], V1..V3 [N] is (section 5.1 on Figure 5).

    That is the root mean square of its rate of change (n,) [N m/s], V1..V3 [N/s]; no difference is taken across the
    borders of spans (start, end).
    """
    steps = [np.diff(np.asarray(part, dtype=np.float64), axis=0) for part in parts(signal, spans)]
    return np.sqrt(np.mean(np.concatenate(steps) ** 2, axis=0)) * rate_hz


PUSHED, PUSH = "rmse_pushed", "rmse_push_{}"  # `rmse` of all windows around pushes, and of the window of each
RAW = "_raw"  # ending of an error against the external torque itself, before the low-pass
LABELLED = "_label"  # ending of an error against what foot sensors say of the external torque, (15)
