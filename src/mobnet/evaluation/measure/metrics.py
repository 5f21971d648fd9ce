"""What is measured on an estimated torque."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

Spans = tuple[tuple[int, int], ...]
PERCENT = 100.0


def rmse(estimate: NDArray[Any], truth: NDArray[Any]) -> NDArray[np.float64]:
    """Return the root-mean-square error of each joint, the number of Tables 5 to 8.

    Args:
        estimate: estimated external torque (T, n) [N m]; V1..V3 [N].
        truth: true external torque behind the observer's low-pass, tau~_e of (15), (T, n) [N m]; V1..V3 [N].

    Returns:
        (n,) [N m]; V1..V3 [N].
    """
    error = np.asarray(estimate, dtype=np.float64) - np.asarray(truth, dtype=np.float64)
    return np.sqrt(np.mean(error**2, axis=0))


def roughness(signal: NDArray[Any], spans: Spans, rate_hz: float) -> NDArray[np.float64]:
    """Return how jagged each signal is: root mean square of its rate of change (section 5.1 on Figure 5).

    Args:
        signal: torque (T, n) [N m]; V1..V3 [N].
        spans: contiguous stretches (start, end); no difference is taken across their borders.
        rate_hz: samples per second [Hz].

    Returns:
        (n,) [N m/s]; V1..V3 [N/s].
    """
    steps = [np.diff(np.asarray(part, dtype=np.float64), axis=0) for part in parts(signal, spans)]
    return np.sqrt(np.mean(np.concatenate(steps) ** 2, axis=0)) * rate_hz


def parts(signal: NDArray[Any], spans: Spans) -> list[NDArray[Any]]:
    """Return the contiguous stretches of a signal (T, n) [N m], each (end - start, n)."""
    return [signal[start:end] for start, end in spans]


def rmse_in_spans(estimate: NDArray[Any], truth: NDArray[Any], spans: Spans, rate_hz: float) -> NDArray[np.float64]:
    """Return `rmse` (n,) [N m] of the samples that lie in a stretch; V1..V3 [N]. The rate plays no part."""
    return rmse(np.concatenate(parts(estimate, spans)), np.concatenate(parts(truth, spans)))


def roughness_in_spans(
    estimate: NDArray[Any], truth: NDArray[Any], spans: Spans, rate_hz: float
) -> NDArray[np.float64]:
    """Return `roughness` (n,) [N m/s] of the estimate; V1..V3 [N/s]. The truth plays no part."""
    return roughness(estimate, spans, rate_hz)


def relative_rmse_in_spans(
    estimate: NDArray[Any], truth: NDArray[Any], spans: Spans, rate_hz: float
) -> NDArray[np.float64]:
    """Return `rmse` over the largest true torque of each joint (n,) [%], the r-RMSE of Table 7; the rate plays no part.

    A joint without any external torque has none: nan.
    """
    largest = np.abs(np.concatenate(parts(truth, spans)), dtype=np.float64).max(axis=0)
    largest[largest == 0.0] = np.nan
    return PERCENT * rmse_in_spans(estimate, truth, spans, rate_hz) / largest


Measure = Callable[[NDArray[Any], NDArray[Any], Spans, float], NDArray[np.float64]]

METRICS: Mapping[str, tuple[Measure, str]] = {  # name -> (estimate, truth, spans, rate -> (n,)), unit of a joint's
    "rmse": (rmse_in_spans, "{}"),
    "roughness": (roughness_in_spans, "{}/s"),
    "r_rmse": (relative_rmse_in_spans, "%"),
}
PUSHED, PUSH = "rmse_pushed", "rmse_push_{}"  # `rmse` of all windows around pushes, and of the window of each
