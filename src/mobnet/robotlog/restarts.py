"""Clocks of messages that begin anew within a log: of a simulation that was reset, or a driver that was started again.

Where the stamps of a topic begin anew they count on as the times of recording do, and a pause in all topics ends a
segment there.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.robotlog.clocks import ClockBounds, rows_anew
from mobnet.robotlog.columns import Columns, LogColumn


@dataclass(frozen=True)
class Restarts:
    """The clock of some columns of a topic, and the rows in which it begins anew.

    `step_s` is its usual interval [s].
    """

    column: LogColumn
    time_s: Array
    recorded_s: Array
    rows: NDArray[np.intp]
    step_s: float


def counted_on(columns: Columns, bounds: ClockBounds) -> tuple[Columns, tuple[str, ...]]:
    """Return the columns of a log with clocks that do not begin anew, and a hint for each topic whose clock did.

    Tables, whose columns have no times of their own, stay as they are.
    """
    clocks = dict[int, Restarts]()
    for column in columns.values():
        if column.time_s is not None and column.recorded_s is not None and id(column.time_s) not in clocks:
            clocks[id(column.time_s)] = _restarts(column, column.time_s, column.recorded_s, bounds)
    if not any(len(clock.rows) for clock in clocks.values()):
        return columns, ()
    # A pause that is a gap to the slowest topic: nothing is interpolated over it.
    pause = 2.0 * bounds.gap_intervals * max(clock.step_s for clock in clocks.values())
    starts = _starts(clocks, pause)
    corrected = dict[int, tuple[Array, Array]]()
    shifts = list[float]()
    for key, clock in clocks.items():
        pauses = np.zeros(len(clock.time_s))
        for start, end in starts:
            pauses[_first_row(clock, start, end) :] += pause
        steady = clock.time_s + _shift(clock, shifts, bounds)
        corrected[key] = steady + pauses, clock.recorded_s + pauses
    later = dict[str, LogColumn]()
    for name, column in columns.items():
        time_s, recorded_s = corrected.get(id(column.time_s), (column.time_s, column.recorded_s))
        later[name] = replace(column, time_s=time_s, recorded_s=recorded_s)
    return later, _hints(clocks, pause)


def _restarts(column: LogColumn, time_s: Array, recorded_s: Array, bounds: ClockBounds) -> Restarts:
    """Return where the clock of a column begins anew: nowhere, if its times are those of recording."""
    steps = np.diff(time_s)
    rising = steps[steps > 0.0]
    step_s = float(np.median(rising)) if len(rising) else 0.0
    rows = rows_anew(time_s, 2.0 * bounds.gap_intervals * step_s, bounds) if column.is_stamped else np.empty(0, np.intp)
    return Restarts(column, time_s, recorded_s, rows, step_s)


def _starts(clocks: Mapping[int, Restarts], pause: float) -> list[tuple[float, float]]:
    """Return first and last time of recording [s] of the restarts of all clocks; those closer than a pause are one."""
    times = np.sort(np.concatenate([clock.recorded_s[clock.rows] for clock in clocks.values()]))
    ends = np.r_[0, np.flatnonzero(np.diff(times) > pause) + 1, len(times)]
    return [(float(times[first]), float(times[end - 1])) for first, end in pairwise(ends)]


def _first_row(clock: Restarts, start: float, end: float) -> int:
    """Return the first row of a clock after a restart: its own, else by the times of recording."""
    times = clock.recorded_s[clock.rows]
    within = clock.rows[(times >= start) & (times <= end)]
    return int(within[0]) if len(within) else int(np.searchsorted(clock.recorded_s, start))


def _shift(clock: Restarts, shifts: list[float], bounds: ClockBounds) -> Array:
    """Return what each time of a clock is short of [s], so that it keeps the distance to the times of recording.

    Topics of one clock begin anew together, but are recorded with delays of their own: a shift close to one in the list
    is that one, and others are added to it.
    """
    lags = clock.recorded_s - clock.time_s
    shift = np.zeros(len(lags))
    first = float(np.median(lags[: clock.rows[0]])) if len(clock.rows) else 0.0
    for start, end in pairwise([*clock.rows, len(lags)]):
        short = float(np.median(lags[start:end])) - first
        near = [known for known in shifts if abs(known - short) <= bounds.apart_s]
        if not near:
            shifts.append(short)
        shift[start:end] = near[0] if near else short
    return shift


def _hints(clocks: Mapping[int, Restarts], pause: float) -> tuple[str, ...]:
    """Return a hint for each topic whose clock begins anew."""
    hints = dict[str, str]()
    for clock in clocks.values():
        topic = clock.column.topic
        if len(clock.rows):
            where = f"begin anew in message {clock.rows[0]}{_more(clock.rows)}, as in a simulation that was reset"
            after = f"after a pause of {pause:.3g} s, which ends a segment"
            hints[topic] = f"stamps of {topic}: {where}: they count on as the times of recording do, {after}"
    return tuple(hints.values())


def _more(rows: NDArray[np.intp]) -> str:
    """Return how many rows there are beside the first one."""
    return f" and {len(rows) - 1} more" if len(rows) > 1 else ""
