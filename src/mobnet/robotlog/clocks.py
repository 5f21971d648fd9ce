"""The clocks of a log's signals: their times, one clock for all, and what looks wrong with stamps of messages."""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError
from mobnet.robotlog.columns import LogColumn

ROUND = 1e-3  # a rate this close to a whole number [Hz] is meant to be it
Segments = tuple[tuple[int, int], ...]


@dataclass(frozen=True)
class ClockBounds:
    """What is accepted of the times of a log.

    Attributes:
        gap_intervals: a pause of more than so many sample intervals ends a segment.
        backward: share of the times of a table that may not be after the one before.
        ticks: samples of the recording for each one of the log, above which it is refused.
        even: standard deviation of the intervals over their median, below which samples are taken as they are.
        apart_s: difference between stamps and times of recording from which clocks count as apart [s].
    """

    gap_intervals: float
    backward: float
    ticks: float
    even: float
    apart_s: float


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


@dataclass(frozen=True)
class Rising:
    """The clock of a table: times that rise (T,) [s], the rows that they are of, None for all, and hints on the others.

    `length` is the number of rows of the table.
    """

    time_s: Array
    rows: NDArray[np.intp] | None = None
    length: int = 0
    hints: tuple[str, ...] = ()


def rising(path: Path, time_s: Array, bounds: ClockBounds) -> Rising:
    """Return the clock of a table, whose rows are put in order; of two with one time the first is taken.

    Where times begin anew, as those of episodes in one file do, a segment ends and times count on.

    Raises:
        DataError: there are less than two times, or most do not rise.
    """
    rows = np.flatnonzero(np.isfinite(time_s))
    hints = [f"clock: {len(time_s) - len(rows)} of {len(time_s)} rows have no time, and are left out"] * (
        len(rows) < len(time_s)
    )
    times = time_s[rows]
    steps = np.diff(time_s[rows])
    # Rows that stand twice or were exchanged can be put in order; where more of them go back, the column is no clock.
    if len(times) < 2 or np.mean(steps <= 0.0) > bounds.backward:
        row = int(rows[1:][steps <= 0.0][0]) if len(times) > 1 else 0
        back = f"row {row} is not after the one before it" + f", as {(steps <= 0.0).sum()} of {len(time_s)} rows"
        accepted = "two samples, rising times; or rate_hz with a clock.column that the log does not have"
        raise DataError(f"{path}: clock: {back if len(times) > 1 else f'{len(times)} row'}; accepted: {accepted}")
    if (steps > 0.0).all():
        return Rising(times, rows if hints else None, len(time_s), tuple(hints))
    # Episodes do not follow from each other: a pause that is longer than a gap ends a segment between them.
    pause = 2.0 * bounds.gap_intervals * float(np.median(steps[steps > 0.0]))
    anew = rows_anew(times, pause, bounds)
    forward = np.zeros(len(times))
    forward[anew] = times[anew - 1] - times[anew] + pause
    times = times + np.cumsum(forward)
    if len(anew):
        more = f" and {len(anew) - 1} more" if len(anew) > 1 else ""
        text = f"as those of episodes do: they count on after a pause of {pause:.3g} s, which ends a segment"
        hints.append(f"clock: times begin anew in row {rows[anew[0]]}{more}, {text}")
    if back := int((np.diff(times) <= 0.0).sum()):
        text = "rows are put in order, and of two with one time the first is taken"
        hints.append(f"clock: {back} of {len(times)} times are not after the one before: {text}")
    kept = np.unique(times, return_index=True)[1]
    return Rising(times[kept], rows[kept], len(time_s), tuple(hints))


def rows_anew(time_s: Array, pause: float, bounds: ClockBounds) -> NDArray[np.intp]:
    """Return the rows of a clock (T,) [s] in which it begins anew: by more than a pause [s], and not for a late row."""
    anew = np.flatnonzero(np.diff(time_s) < -pause) + 1
    few = anew[:, None] + np.arange(1, 1 + math.ceil(bounds.gap_intervals))
    is_late = (time_s[np.minimum(few, len(time_s) - 1)] > time_s[anew - 1, None]).any(axis=1)
    return anew[~is_late]


def covered(clock: Array, times: Array, gap_intervals: float) -> NDArray[np.bool_]:
    """Return which times (T,) [s] lie between samples of a clock that no gap parts."""
    steps = np.diff(clock)
    before = np.clip(np.searchsorted(clock, times, side="right") - 1, 0, len(steps) - 1)
    return (steps[before] <= gap_intervals * np.median(steps)) & (times >= clock[0]) & (times <= clock[-1])


def rate_of(time_s: Array) -> float:
    """Return the rate of a clock [Hz], a whole number where it is close to one; lost samples do not count."""
    steps = np.diff(time_s)
    usual = np.abs(steps / np.median(steps) - 1.0) <= 0.5
    rate = 1.0 / float(steps[usual].mean())
    return float(round(rate)) if abs(rate - round(rate)) < ROUND * rate else rate


def common_ticks(path: Path, clocks: Mapping[str, Array], rate_hz: float, bounds: ClockBounds) -> Ticks:
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
    last = max(clocks, key=lambda key: clocks[key][0])
    earliest = min(clocks, key=lambda key: clocks[key][-1])
    start = clocks[last][0]
    end = clocks[earliest][-1]
    if end - start < 2 / rate_hz:
        text = f"clock: {last} begins at {start:.3f} s and {earliest} ends at {end:.3f} s"
        raise DataError(f"{path}: {text}; accepted: signals that overlap; of messages `clock: {{stamp: recorded}}`")
    spans = _spans(first, pauses, start, end, rate_hz)
    wanted = int((spans[1] - spans[0] + 1).sum())
    samples = max(map(len, clocks.values()))
    # Far more ticks than samples come from a clock in another unit, or from a wrong rate_hz.
    if wanted > bounds.ticks * samples:
        text = f"{wanted} ticks at {rate_hz:g} Hz for {samples} samples, over {end - start:.4g} s"
        raise DataError(f"{path}: clock: {text}; accepted: up to {bounds.ticks:g} for each: is clock.unit right?")
    every = np.unique(np.concatenate([np.arange(a, b + 1) for a, b in zip(*spans, strict=True)]))
    ticks = start + every / rate_hz
    whole = np.ones(len(ticks), dtype=bool)
    # Signals of one table share the array of their clock, which is looked at once.
    for clock in {id(clock): clock for clock in clocks.values()}.values():
        whole &= covered(clock, np.clip(ticks, clock[0], clock[-1]), bounds.gap_intervals)
    kept = ticks[whole]
    ends = [0, *(np.flatnonzero(np.diff(kept) > 1.5 / rate_hz) + 1).tolist(), len(kept)]
    return Ticks(kept, _long_enough(path, pairwise(ends)), interpolated=True)


def _spans(
    clock: Array, pauses: NDArray[np.bool_], start: float, end: float, rate_hz: float
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the first and the last tick after a start [s] of each stretch between pauses of a clock, up to an end."""
    ends = np.r_[clock[0], clock[1:][pauses]], np.r_[clock[:-1][pauses], clock[-1]]
    first, last = (np.clip((part - start) * rate_hz, 0.0, (end - start) * rate_hz) for part in ends)
    return np.ceil(first - ROUND).astype(int), np.floor(last + ROUND).astype(int)


def _long_enough(path: Path, segments: Iterable[tuple[int, int]]) -> Segments:
    """Return segments that are not empty."""
    kept = tuple((start, end) for start, end in segments if end > start)
    if not kept:
        raise DataError(f"{path}: clock: no two samples follow each other without a gap; accepted: a recording")
    return kept


def at(signal: Timed, ticks: Array) -> Array:
    """Return a signal at other times, by linear interpolation (T, n)."""
    before = np.clip(np.searchsorted(signal.time_s, ticks, side="right") - 1, 0, len(signal.time_s) - 2)
    start = signal.time_s[before]
    end = signal.time_s[before + 1]
    share = np.clip((ticks - start) / (end - start), 0.0, 1.0)[:, None]
    values = signal.values[before]
    values += share * (signal.values[before + 1] - values)
    return values


def stamp_hints(columns: Iterable[LogColumn], bounds: ClockBounds) -> Iterator[str]:
    """Yield what looks wrong with the stamps of messages, of one column for each topic."""
    lags = dict[str, Array]()
    for topic, column in {column.topic: column for column in columns}.items():
        if column.is_stamped is False:
            yield f"stamps of {topic}: zero; the times of recording are taken instead"
        elif column.is_stamped and column.time_s is not None and column.recorded_s is not None:
            lags[topic] = column.recorded_s - column.time_s
            if back := int((np.diff(column.time_s) <= 0).sum()):
                yield f"stamps of {topic}: {back} of {len(column.time_s)} are not after the one before"
    usual = {topic: float(np.median(lag)) for topic, lag in lags.items()}
    for topic, lag in usual.items():
        least = min(usual, key=lambda key: abs(usual[key]))
        if abs(lag - usual[least]) > bounds.apart_s:
            text = f"{lag:.3g} s before the recording, those of {least} {usual[least]:.3g} s"
            other = "another clock, or late; `clock: {stamp: recorded}` takes the times of recording"
            yield f"stamps of {topic}: {text}: {other}"
    for topic, lag in lags.items():
        part = max(1, len(lag) // 10)
        drift = float(np.median(lag[-part:]) - np.median(lag[:part]))
        if abs(drift) > bounds.apart_s:
            yield f"stamps of {topic}: against the recording they drift by {drift:.3g} s over the log"
