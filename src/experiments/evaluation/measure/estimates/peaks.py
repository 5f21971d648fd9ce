"""How much of a push an estimate shows, and how late: slope on the low-passed push, delay of the rise, by joint."""

from collections.abc import Iterator, Sequence

import numpy as np
import scipy  # pyright: ignore[reportMissingTypeStubs]  # its parts are imported where they are used first
from numpy.typing import NDArray

from experiments.evaluation.compare.pair import Measured, Measures, Pair
from experiments.evaluation.compare.rmse import Spans
from experiments.evaluation.compare.scene import Scene, ShownPushes, shown_pushes
from experiments.evaluation.compare.windows import flagged_spans
from experiments.settings.measures import Peaks
from mobnet.core.arrays import Array

SHARE = "push_share"
DELAY = "rise_delay"
BOUND = "rise_bound"  # 1 of a walk whose delay is a lower bound, else 0
OBSERVER = "_observer"  # the delay of the push behind the observer's low-pass: what a perfect residual would show
HALF = 0.5  # of the true peak, where the rise is timed
MS = 1000.0


def measure(pair: Pair, scene: Scene, settings: Peaks) -> Measures:
    """Yield of the pushes of a recording `push_share` [-], and `rise_delay` [ms] with that of the observer.

    The share is that of `slopes`. The delay is the median over the pushes of the time in which what the estimate shows
    of a push rises to half of its largest torque, less the time that the push needs. Where the estimate never gets
    there it ends with the window, so that the median is a lower bound if half of the pushes or more end so: then
    `rise_bound` [-] is 1. A joint counts in a push that turns it with a share of the largest torque of all joints.
    """
    shown = shown_pushes(pair, scene)
    motors = np.isin(pair.joints, scene.layout.actuated)
    windows = list(push_rows(scene.pushed, pair.spans, settings, pair.rate_hz))
    # At a joint that a push does not load, the observer's error changes by more than its share of the push
    # (docs/notes/measures.md).
    turned = [turned_joints(shown.push[rise], settings.turned_share, motors) for _, rise in windows]
    yield Measured(SHARE, slopes(shown, [around for around, _ in windows], turned))
    for suffix, signal in (("", shown.estimate), (OBSERVER, shown.behind)):
        delays_of = [
            delays(shown.push[rise], signal[rise], is_turned)
            for (_, rise), is_turned in zip(windows, turned, strict=True)
        ]
        yield Measured(DELAY + suffix, medians(delays_of, len(pair.joints)) * MS / pair.rate_hz)
    never: list[Array] = []
    for (_, rise), is_turned in zip(windows, turned, strict=True):
        never.append(never_half(shown.push[rise], shown.estimate[rise], is_turned))
    yield Measured(BOUND, np.ceil(medians(never, len(pair.joints))))


def push_rows(
    pushed: NDArray[np.bool_], spans: Spans, settings: Peaks, rate_hz: float
) -> Iterator[tuple[slice, slice]]:
    """Yield the rows around each push, from some time before it, and those of its rise, from the last one before it.

    Both end some time after the push, or at the longest time.
    """
    before, after, longest = (
        round(time_s * rate_hz) for time_s in (settings.before_s, settings.after_s, settings.longest_s)
    )
    for first, last in spans:
        for start, end in flagged_spans(pushed, ((first, last),), 0):
            # What is shown in the row before a push is its zero: a push that acts from the first row on has none.
            if start > first:
                stop = min(end + after, start + longest, last)
                yield slice(max(start - before, first), stop), slice(start - 1, stop)


def turned_joints(push: NDArray[np.float64], share: float, counted: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return which joints a push (T, n) [N m] turns with a share of the largest torque of those that count, (n,)."""
    size = np.where(counted, np.abs(push).max(axis=0), 0.0)
    return (size > 0.0) & (size >= share * size.max(initial=0.0))


def slopes(shown: ShownPushes, windows: Sequence[slice], turned: Sequence[NDArray[np.bool_]]) -> Array:
    """Return the slope of what is shown on the low-passed push, over the pushes that turn a joint, (n,) [-].

    That is by least squares, with a line over time of each window, which slow errors follow: 1 of an estimate that
    follows the push, 0 of one that shows nothing of it, however noisy it is. It is nan of joints that no push turns.
    """
    products, squares = np.zeros((2, shown.push.shape[1]))
    for rows, is_turned in zip(windows, turned, strict=True):
        push, estimate = (scipy.signal.detrend(signal[rows], axis=0) for signal in (shown.behind, shown.estimate))
        products += is_turned * (push * estimate).sum(axis=0)
        squares += is_turned * (push * push).sum(axis=0)
    return np.divide(products, squares, out=np.full(len(squares), np.nan), where=squares > 0.0)


def delays(push: NDArray[np.float64], shown: NDArray[np.float64], turned: NDArray[np.bool_]) -> Array:
    """Return the delay of what is shown of a push, (n,) [rows], nan of joints that it does not turn.

    Push and shown (T, n) [N m] begin one row before the push; what is shown then is its zero.
    """
    scaled, true = (over_peak(push, signal, turned) for signal in (shown, push))
    return np.where(turned, first_above(scaled, HALF) - first_above(true, HALF), np.nan)


def never_half(push: NDArray[np.float64], shown: NDArray[np.float64], turned: NDArray[np.bool_]) -> Array:
    """Return whether what is shown of a push, as of `delays`, never rises to half of it: 1 or 0, nan if not turned."""
    highest = over_peak(push, shown, turned).max(axis=0)
    return np.where(turned, (highest < HALF).astype(float), np.nan)


def over_peak(push: NDArray[np.float64], signal: NDArray[np.float64], turned: NDArray[np.bool_]) -> Array:
    """Return a signal from its first row on over the largest torque of a push, (T, n) [-]; 0 of joints not turned."""
    peak = push[np.abs(push).argmax(axis=0), np.arange(push.shape[1])]
    return np.divide(signal - signal[0], peak, out=np.zeros(push.shape), where=turned)


def first_above(signal: NDArray[np.float64], level: float) -> Array:
    """Return when each signal (T, n) first reaches a level, (n,) [rows], between two rows; T - 1 if it never does."""
    above = signal >= level
    row = np.where(above.any(axis=0), above.argmax(axis=0), len(signal) - 1)
    columns = np.arange(signal.shape[1])
    before = np.maximum(row - 1, 0)
    low = signal[before, columns]
    high = signal[row, columns]
    crossed = above[row, columns] & (row > 0)
    part = np.divide(level - low, high - low, out=np.zeros(len(row)), where=crossed & (high > low))
    return np.where(crossed, before + part, row)


def medians(rows: list[Array], width: int) -> Array:
    """Return the median over pushes of each joint (width,) [any unit], nan of one that none turned."""
    values = np.array(rows).reshape(-1, width)
    is_known = ~np.isnan(values).all(axis=0) if len(values) else np.zeros(width, dtype=bool)
    median = np.full(width, np.nan)
    median[is_known] = np.nanmedian(values[:, is_known], axis=0)
    return median
