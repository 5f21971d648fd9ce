"""The clocks of a log's signals: their times, one clock for all, and what looks wrong with stamps of messages."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError
from mobnet.robotlog.columns import Column
from mobnet.settings.robotlog import RobotLog

ROUND = 1e-3  # a rate this close to a whole number [Hz] is meant to be it
Segments = tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class Timed:
    """A signal in SI units (T, n) with its own clock (T,) [s]."""

    time_s: Array
    values: Array


@dataclass(frozen=True)
class Ticks:
    """Times of a recording's rows (T,) [s], its segments, and whether rows lie between samples of the log."""

    time_s: Array
    segments: Segments
    interpolated: bool


def rate_of(time_s: Array) -> float:
    """Return the rate of a clock [Hz], a whole number where it is close to one; lost samples do not count."""
    steps = np.diff(time_s)
    usual = np.abs(steps / np.median(steps) - 1.0) <= 0.5
    rate = 1.0 / float(steps[usual].mean())
    return float(round(rate)) if abs(rate - round(rate)) < ROUND * rate else rate


def common_ticks(path: Path, clocks: Mapping[str, Array], rate_hz: float, bounds: RobotLog) -> Ticks:
    """Return the clock of a recording at a rate [Hz] of signals with clocks (T,) [s] of their own.

    Samples of one even clock at the rate itself are taken as they are; else values are interpolated linearly.

    Raises:
        DataError: signals do not overlap.
    """
    first = next(iter(clocks.values()))
    steps = np.diff(first)
    is_one = all(clock is first or np.array_equal(clock, first) for clock in clocks.values())
    pauses = steps > bounds.gap_intervals * np.median(steps)
    even = np.std(steps[~pauses]) <= bounds.even * np.median(steps)
    if is_one and even and abs(1.0 / np.median(steps) - rate_hz) <= ROUND * rate_hz:
        ends = [0, *(np.flatnonzero(pauses) + 1).tolist(), len(first)]
        return Ticks(first, _long_enough(path, pairwise(ends)), interpolated=False)
    last, earliest = max(clocks, key=lambda key: clocks[key][0]), min(clocks, key=lambda key: clocks[key][-1])
    start, end = clocks[last][0], clocks[earliest][-1]
    if end - start < 2 / rate_hz:
        text = f"clock: {last} begins at {start:.3f} s and {earliest} ends at {end:.3f} s"
        raise DataError(f"{path}: {text}; accepted: signals that overlap; of messages `clock: {{stamp: recorded}}`")
    ticks = start + np.arange(int((end - start) * rate_hz + ROUND) + 1) / rate_hz
    whole = np.ones(len(ticks), dtype=bool)
    for clock in {id(clock): clock for clock in clocks.values()}.values():
        steps = np.diff(clock)
        before = np.clip(np.searchsorted(clock, ticks, side="right") - 1, 0, len(steps) - 1)
        whole &= steps[before] <= bounds.gap_intervals * np.median(steps)
    kept = ticks[whole]
    ends = [0, *(np.flatnonzero(np.diff(np.flatnonzero(whole)) > 1) + 1).tolist(), len(kept)]
    return Ticks(kept, _long_enough(path, pairwise(ends)), interpolated=True)


def _long_enough(path: Path, segments: Iterable[tuple[int, int]]) -> Segments:
    """Return segments that are not empty."""
    found = tuple((start, end) for start, end in segments if end > start)
    if not found:
        raise DataError(f"{path}: clock: no two samples follow each other without a gap; accepted: a recording")
    return found


def at(signal: Timed, ticks: Array) -> Array:
    """Return a signal at other times, by linear interpolation (T, n)."""
    before = np.clip(np.searchsorted(signal.time_s, ticks, side="right") - 1, 0, len(signal.time_s) - 2)
    start, end = signal.time_s[before], signal.time_s[before + 1]
    share = np.clip((ticks - start) / (end - start), 0.0, 1.0)[:, None]
    found = signal.values[before]
    found += share * (signal.values[before + 1] - found)
    return found


def stamp_hints(columns: Iterable[Column], bounds: RobotLog) -> Iterator[str]:
    """Yield what looks wrong with the stamps of messages, of one column for each topic."""
    lags = dict[str, Array]()
    for column in {column.topic: column for column in columns if column.recorded_s is not None}.values():
        if column.is_stamped is False:
            yield f"stamps of {column.topic}: zero; the times of recording are taken instead"
        elif column.is_stamped and column.time_s is not None:
            lags[column.topic] = column.recorded_s - column.time_s
            back = int((np.diff(column.time_s) <= 0).sum())
            if back:
                yield f"stamps of {column.topic}: {back} of {len(column.time_s)} are not after the one before"
    usual = {topic: float(np.median(lag)) for topic, lag in lags.items()}
    for topic, lag in usual.items():
        least = min(usual, key=lambda key: abs(usual[key]))
        if abs(lag - usual[least]) > bounds.apart_s:
            text = f"{lag:.3g} s before the recording, those of {least} {usual[least]:.3g} s"
            yield f"stamps of {topic}: {text}: another clock, or late; `clock: {{stamp: recorded}}` takes the other times"
    for topic, lag in lags.items():
        part = max(1, len(lag) // 10)
        drift = float(np.median(lag[-part:]) - np.median(lag[:part]))
        if abs(drift) > bounds.apart_s:
            yield f"stamps of {topic}: against the recording they drift by {drift:.3g} s over the log"
