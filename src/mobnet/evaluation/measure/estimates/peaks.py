"""How high and how fast an estimate rises under pushes: peak ratio and delay of the rise, joint by joint."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.metrics import Metric
from mobnet.evaluation.compare.pair import Pair
from mobnet.evaluation.compare.rmse import Spans
from mobnet.evaluation.compare.scene import Scene, shown_pushes
from mobnet.evaluation.compare.values import Measured, Measures
from mobnet.evaluation.compare.windows import flagged_spans
from mobnet.settings.evaluation import Peaks

PEAK, DELAY = "peak_ratio", "rise_delay"
OBSERVER = "_observer"  # the same of the push behind the observer's low-pass: what a perfect residual would show
HALF = 0.5  # of the true peak, where the rise is timed
MS = 1000.0
METRICS = (Metric("peak_ratio(_observer)?", "-", low=None), Metric("rise_delay(_observer)?", "ms", low=None))


def measure(pair: Pair, scene: Scene, settings: Peaks) -> Measures:
    """Yield the medians over the pushes of a recording: `peak_ratio` [-] and `rise_delay` [ms], and the observer's.

    For each push, the largest change of what the estimate shows of it, over the largest torque of the push; and the
    time that it needs to half of this torque, less the time that the push needs. A joint counts in a push that turns it
    with a share of the largest torque of all joints; one whose estimate never gets there has the delay of the window's
    end, which is a lower bound.
    """
    shown, motors = shown_pushes(pair, scene), np.isin(pair.joints, scene.layout.actuated)
    windows = list(push_rows(scene.pushed, pair.spans, settings, pair.rate_hz))
    for suffix, signal in (("", shown.estimate), (OBSERVER, shown.behind)):
        found = [rises(shown.push[rows], signal[rows], settings.turned_share, motors) for rows in windows]
        for metric, k, scale in ((PEAK, 0, 1.0), (DELAY, 1, MS / pair.rate_hz)):
            yield Measured(metric + suffix, medians([each[k] for each in found], len(pair.joints)) * scale)


def push_rows(pushed: NDArray[np.bool_], spans: Spans, settings: Peaks, rate_hz: float) -> Iterator[slice]:
    """Yield the rows of each push: from the last one before it to some time after it, or to the longest time."""
    after, longest = (round(time_s * rate_hz) for time_s in (settings.after_s, settings.longest_s))
    for first, last in spans:
        for start, end in flagged_spans(pushed, ((first, last),), 0):
            if start > first:
                yield slice(start - 1, min(end + after, start + longest, last))


def rises(
    push: NDArray[np.float64], shown: NDArray[np.float64], turned_share: float, counted: NDArray[np.bool_]
) -> tuple[Array, Array]:
    """Return peak ratio [-] and delay [rows] of what is shown of a push, (n,) each, nan of joints that do not count.

    Push and shown (T, n) [N m] begin one row before the push; what is shown then is its zero.
    """
    peak = push[np.abs(push).argmax(axis=0), np.arange(push.shape[1])]
    size = np.where(counted, np.abs(peak), 0.0)
    turned = (size > 0.0) & (size >= turned_share * size.max(initial=0.0))
    scaled = np.divide(shown - shown[0], peak, out=np.zeros(shown.shape), where=turned)
    true = np.divide(push, peak, out=np.zeros(push.shape), where=turned)
    delay = first_above(scaled, HALF) - first_above(true, HALF)
    return np.where(turned, scaled.max(axis=0), np.nan), np.where(turned, delay, np.nan)


def first_above(signal: NDArray[np.float64], level: float) -> Array:
    """Return when each signal (T, n) first reaches a level, (n,) [rows], between two rows; T - 1 if it never does."""
    above = signal >= level
    row = np.where(above.any(axis=0), above.argmax(axis=0), len(signal) - 1)
    columns, before = np.arange(signal.shape[1]), np.maximum(row - 1, 0)
    low, high = signal[before, columns], signal[row, columns]
    crossed = above[row, columns] & (row > 0)
    part = np.divide(level - low, high - low, out=np.zeros(len(row)), where=crossed & (high > low))
    return np.where(crossed, before + part, row)


def medians(rows: list[Array], width: int) -> Array:
    """Return the median over pushes of each joint (width,) [any unit], nan of one that none turned."""
    values = np.array(rows).reshape(-1, width)
    held = ~np.isnan(values).all(axis=0) if len(values) else np.zeros(width, dtype=bool)
    found = np.full(width, np.nan)
    found[held] = np.nanmedian(values[:, held], axis=0)
    return found
