"""From the columns of a log to the recording that the observer takes: units, order, one clock, gaps."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array, rotation
from mobnet.core.columns import EXTERNAL, FEET, recording_columns
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.core.motion import turned
from mobnet.core.recording import ABSENT, Recording, Sensed, Truth
from mobnet.formats.log_map import LogMap, Signal, Tool
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import point_torque
from mobnet.robotlog.clocks import (
    ClockBounds,
    Rising,
    Segments,
    Timed,
    at,
    common_ticks,
    covered,
    rate_of,
    rising,
    stamp_hints,
)
from mobnet.robotlog.columns import Columns, LogColumn
from mobnet.robotlog.hints.columns import listed
from mobnet.robotlog.long_arrays import give_back, long_array
from mobnet.robotlog.meaning import given_signals, is_truth, resolved
from mobnet.robotlog.pieces import pieces
from mobnet.robotlog.restarts import counted_on

SI = {  # unit -> in SI units
    "deg": np.pi / 180,
    "deg/s": np.pi / 180,
    "rpm": 2 * np.pi / 60,
    "mN m": 1e-3,
    "kN m": 1e3,
    "mm": 1e-3,
    "g": 9.80665,
    "kN": 1e3,
    "ms": 1e-3,
    "us": 1e-6,
    "ns": 1e-9,
}
LARGEST = 1e15  # number of a signal in SI units: with the square of a speed a residual is one of single precision


@dataclass(frozen=True)
class Converted:
    """A recording, and what was done to make it.

    `wrenches` are those of the feet that have sensors, side -> (T, 6) [N], [N m]; `absent` are signals that the log
    does not have and that are zero; `clocks` are those of the log, signal -> (T,) [s]; `hints` are those on stamps;
    `time_s` are the times of the recording's rows by the log's clock (T,) [s]; `tool` is what a sensor at an end
    effector reads (T, 6) [N], [N m]; `truth` are the columns by which a simulated log tells its pushes, each (T,).
    """

    recording: Recording
    wrenches: Mapping[str, Array]
    absent: tuple[str, ...]
    clocks: Mapping[str, Array]
    interpolated: bool
    hints: tuple[str, ...]
    time_s: Array
    tool: Array | None
    truth: Mapping[str, Array]


def convert(
    path: Path, columns: Columns, meaning: LogMap, layout: JointLayout, bounds: ClockBounds, folder: Path | None = None
) -> Converted:
    """Make a recording of a log, whose long arrays lie in files in a folder, where one is given.

    Raises:
        DataError: a column is missing, a number is not finite, a clock does not rise, or signals do not overlap.
        ConfigError: the map does not fit the robot.
    """
    meaning = resolved(path, meaning, columns, layout)
    given = given_signals(meaning)
    clock = _table_clock(path, columns, meaning, bounds)
    restarts: tuple[str, ...] = ()
    if meaning.clock.stamp == "header":
        columns, restarts = counted_on(columns, bounds)
    known = {name: column for name, column in columns.items() if is_truth(name)}
    of_signals = dict.fromkeys(chain.from_iterable(signal.columns for signal in given.values()))
    left_out = dict.fromkeys(columns[name].hint for name in of_signals if columns[name].hint)
    stamps = list[str]()
    if meaning.clock.stamp == "header":
        stamps += stamp_hints((columns[signal.columns[0]] for signal in given.values()), bounds)
    free = {"q": layout.nq - layout.nu, "v": layout.nv - layout.nu}  # for the base: one copy of a long signal less
    # A log may be as large as the memory: each column goes with the last signal that it is part of, and each signal as
    # soon as it has its values.
    left = dict(columns)
    del columns
    waiting = list(given)
    signals = dict[str, Timed]()
    blank = dict[str, tuple[int, int]]()
    while waiting:
        name = waiting.pop(0)
        numbers = _read(left, given[name].columns, folder)
        blank |= _blank_cells(numbers)
        signals[name] = _timed(path, numbers, given[name], meaning, clock, bounds, free.get(name, 0), folder)
        del numbers
        needed = set(chain.from_iterable(given[other].columns for other in waiting))
        left = {name: column for name, column in left.items() if name in needed}
    _turn_base(path, signals, given)
    rate_hz = meaning.rate_hz or rate_of(signals["q"].time_s)
    clocks = {name: signal.time_s for name, signal in signals.items()}
    ticks = common_ticks(path, clocks, rate_hz, bounds)
    values = {}
    while signals:
        name, last_signal = signals.popitem()
        values[name] = _at_ticks(last_signal, ticks.time_s, folder) if ticks.interpolated else last_signal.values
        del last_signal
    wrenches = {foot.removesuffix("_foot"): values[foot] for foot in FEET if foot in values}
    truth = dict(zip(known, long_array((len(known), len(ticks.time_s)), folder), strict=True))
    for name, column in known.items():
        truth[name][:] = np.interp(ticks.time_s, *_own(path, name, column, meaning, clock))
        give_back()
    recording, absent = _recording(values, layout, ticks.segments, rate_hz)
    hints = (*left_out, *_blank_hints(blank), *clock.hints, *restarts, *stamps)
    return Converted(
        recording, wrenches, absent, clocks, ticks.interpolated, hints, ticks.time_s, values.get("tool"), truth
    )


def _read(columns: Columns, names: Sequence[str], folder: Path | None) -> dict[str, LogColumn]:
    """Return some columns with their numbers; those that are read only now lie in one array, as long as a signal."""
    read = {name: columns[name] for name in names}
    waiting = [name for name, column in read.items() if callable(column.values)]
    stored: Array | None = None
    for k, name in enumerate(waiting):
        numbers = read[name].numbers()
        stored = long_array((len(waiting), len(numbers)), folder) if stored is None else stored
        stored[k] = numbers
        read[name] = replace(read[name], values=stored[k])
        give_back()
    return read


def _blank_cells(columns: Columns) -> dict[str, tuple[int, int]]:
    """Return in how many of its rows a column has no number, and the rows, of the columns that lack some."""
    blank = dict[str, tuple[int, int]]()
    for name, column in columns.items():
        numbers = column.numbers()
        if count := int((~np.isfinite(numbers)).sum()):
            blank[name] = count, len(numbers)
    return blank


def _blank_hints(blank: Mapping[str, tuple[int, int]]) -> Iterator[str]:
    """Yield how many rows of columns have no number; columns of the same rows are one hint."""
    names_by_count = dict[tuple[int, int], list[str]]()
    for name, counted in blank.items():
        names_by_count.setdefault(counted, []).append(name)
    for (count, rows), names in names_by_count.items():
        text = "each signal is taken on the rows that it has"
        yield f"no number in {count} of {rows} rows of {listed(names)}: {text}"


def _at_ticks(signal: Timed, ticks: Array, folder: Path | None) -> Array:
    """Return a signal at other times (T, n), by linear interpolation; a long one lies in a file in a folder."""
    values = long_array((len(ticks), signal.values.shape[1]), folder)
    for rows in pieces(0, len(ticks)):
        values[rows] = at(signal, ticks[rows])
    return values


def _timed(
    path: Path,
    columns: Columns,
    signal: Signal,
    meaning: LogMap,
    clock: Rising,
    bounds: ClockBounds,
    free: int,
    folder: Path | None,
) -> Timed:
    """Return a signal in SI units with its clock: the times of the column with most numbers that the others cover.

    So many columns before it are left free, and zero.
    """
    parts_of_signal = [_own(path, name, columns[name], meaning, clock) for name in signal.columns]
    time_s = max((column_time for column_time, _ in parts_of_signal), key=len)
    for other, _ in parts_of_signal:
        if not np.array_equal(other, time_s):
            time_s = time_s[np.isin(time_s, other) | covered(other, time_s, bounds.gap_intervals)]
    if len(time_s) < 2:
        text = f"{', '.join(signal.columns)}: {len(time_s)} times at which all have numbers"
        raise DataError(f"{path}: {text}; accepted: two or more")
    parts = [
        part if np.array_equal(other, time_s) else np.interp(time_s, other, part) for other, part in parts_of_signal
    ]
    scale, sign, offset = (np.asarray(part) for part in (signal.scale, signal.sign, signal.offset))
    factor = scale * SI.get(signal.unit or "-", 1.0)
    whole = long_array((len(time_s), free + len(parts)), folder)
    values = whole[:, free:]
    largest = 0.0
    # In pieces, as a temporary array as long as the log would cost more time than what is computed in it.
    for rows in pieces(0, len(values)):
        parts_of_signal = np.stack([part[rows] for part in parts], axis=1, dtype=np.float64)
        parts_of_signal *= factor
        parts_of_signal -= offset
        parts_of_signal *= sign
        largest = max(largest, float(parts_of_signal.max()), -float(parts_of_signal.min()))
        values[rows] = parts_of_signal
        whole[rows, :free] = 0.0
    # The residual, which has squares of speeds, would leave the range of single precision.
    if largest > LARGEST:
        row, k = np.unravel_index(int(np.abs(values).argmax()), values.shape)
        what = f"column {signal.columns[k]!r}, sample {row}"
        raise DataError(f"{path}: {not_accepted(what, float(values[row, k]), [f'numbers up to {LARGEST:g}'])}")
    return Timed(time_s - signal.delay_s if signal.delay_s else time_s, whole)


def _own(path: Path, name: str, column: LogColumn, meaning: LogMap, clock: Rising) -> tuple[Array, NDArray[Any]]:
    """Return the times of a column, which rise, and its numbers there."""
    time_s = column.recorded_s if meaning.clock.stamp == "recorded" else column.time_s
    values = column.numbers()
    rows_of_column = len(values)
    if time_s is None:
        if len(values) != clock.length:
            text = f"column {name!r} has {len(values)} rows, and the clock {clock.length}"
            raise DataError(f"{path}: {text}; accepted: columns of one length")
        time_s = clock.time_s
        values = values if clock.rows is None else values[clock.rows]
    elif not (np.diff(time_s) > 0).all():  # of equal stamps the first one counts
        kept = np.unique(time_s, return_index=True)[1]
        time_s = time_s[kept]
        values = values[kept]
    # In a merged table the cells of a slower topic are empty: each column is taken on the rows that it has.
    is_number = np.isfinite(values)
    if not is_number.all():
        time_s = time_s[is_number]
        values = values[is_number]
    if len(time_s) < 2:
        what = f"column {name!r}: {len(time_s)} of {rows_of_column} rows have a number"
        what = f"{column.topic}: {len(time_s)} message with {name}" if column.topic else what
        raise DataError(f"{path}: {what}; accepted: two or more")
    return time_s, values


def _table_clock(path: Path, columns: Columns, meaning: LogMap, bounds: ClockBounds) -> Rising:
    """Return the clock of all columns of a table, which rises; logs of messages have none.

    Raises:
        DataError: a table has none, or it does not rise.
    """
    clock = meaning.clock.column
    unit = SI.get(meaning.clock.unit, 1.0)
    if clock in columns and columns[clock].time_s is None:
        return rising(path, columns[clock].numbers() * unit, bounds)
    first = next(column for name, column in columns.items() if name != clock)
    # Each column of messages has the times of its topic, and needs no clock of a table.
    if first.time_s is not None:
        return Rising(np.empty(0))
    if not meaning.rate_hz:
        raise DataError(f"{path}: {_no_clock(columns, meaning)}")
    return rising(path, np.arange(len(first.numbers())) / meaning.rate_hz, bounds)


def _no_clock(columns: Columns, meaning: LogMap) -> str:
    """Return the message about a clock that a log does not have."""
    name = meaning.clock.column
    return f"{not_accepted('clock.column', name, columns)}; or give rate_hz"


def _turn_base(path: Path, signals: dict[str, Timed], given: Mapping[str, Signal]) -> None:
    """Make quaternions w x y z, and vectors of the base those in the axes and with the gravity of a recording."""
    if "quaternion" in signals:
        signals["quaternion"] = _unit_quaternion(path, signals["quaternion"], given["quaternion"].order)
    for name in ("velocity", "acc"):
        signal = given.get(name)
        if signal is not None and (signal.frame == "base" or signal.gravity == "removed"):
            signals[name] = _turned(signals[name], signals["quaternion"], signal)


def _unit_quaternion(path: Path, signal: Timed, order: str) -> Timed:
    """Return quaternions w x y z of unit length that do not jump to their negatives."""
    quat = signal.values if order == "wxyz" else signal.values[:, [3, 0, 1, 2]]
    norm = np.linalg.norm(quat, axis=1)
    if (norm < 0.5).any():
        row = int(np.argmin(norm))
        raise DataError(f"{path}: {not_accepted(f'quaternion, row {row}: norm', float(norm[row]), ['1'])}")
    turns = np.cumprod(np.sign(np.r_[1.0, (quat[1:] * quat[:-1]).sum(axis=1)]) + 0.0)
    return Timed(signal.time_s, quat / norm[:, None] * np.where(turns == 0, 1.0, turns)[:, None])


def _turned(signal: Timed, quaternion: Timed, meaning: Signal) -> Timed:
    """Return a velocity in world axes, or a specific force with the gravity that its sensor left out."""
    quat = at(quaternion, signal.time_s)
    quat /= np.linalg.norm(quat, axis=1)[:, None]
    if meaning.frame == "base":
        return Timed(signal.time_s, turned(quat.T, signal.values.T).T)
    up = np.tile([0.0, 0.0, SI["g"]], (len(quat), 1))
    back = quat * [1.0, -1.0, -1.0, -1.0]
    return Timed(signal.time_s, signal.values + turned(back.T, up.T).T)


def _recording(
    values: Mapping[str, Array], layout: JointLayout, segments: Segments, rate_hz: float
) -> tuple[Recording, tuple[str, ...]]:
    """Return the recording of signals (T, n) in SI units, and the signals that it lacks.

    Positions and velocities of the joints stand behind columns that are free for the base.
    """
    rows = len(values["q"])
    fields = recording_columns(layout)

    def given(name: str, key: str) -> Array:
        return values[name] if name in values else np.zeros((rows, len(fields[key])))

    wanted = {"swing": layout.legs, "landing": layout.legs, "position": layout.virtual}
    wanted |= {foot: foot.removesuffix("_foot") in layout.legs for foot in FEET}
    absent = ("tau_ext", *(name for name, has in wanted.items() if has and name not in values))
    place = values.get("position", np.zeros((rows, 3)))
    q = values["q"]
    v = values["v"]
    if layout.virtual:
        quaternion = values["quaternion"]
        for piece in pieces(0, rows):
            q[piece, :3] = place[piece]
            q[piece, 3:7] = quaternion[piece] / np.linalg.norm(quaternion[piece], axis=1)[:, None]
            v[piece, :3] = values["velocity"][piece]
            v[piece, 3:6] = values["omega"][piece]
    motor = values["tau_motor"]
    sensed = Sensed(
        q=q,
        v=v,
        acc_base_in_base=given("acc", "acc_base_in_base"),
        tau_des=motor,
        tau_motor=motor,
        swing=given("swing", "swing"),
        command=given("command", "command"),
        landing=given("landing", "landing"),
    )
    truth = Truth(
        tau_ext=np.zeros((rows, layout.nv)),
        wrench_left_foot=given("left_foot", "wrench_left_foot"),
        wrench_right_foot=given("right_foot", "wrench_right_foot"),
        contact=np.zeros((rows, len(fields["contact"]))),
        pushed=np.zeros((rows, 1)),
        tau_random=np.zeros(motor.shape),
        tau_push=np.zeros((rows, layout.nv)),
        push=np.zeros((rows, len(fields["push"]))),
    )
    meta = {"scenario": "log", "level": "robot", "seed": 0, ABSENT: list(absent)}
    return Recording(sensed, segments, rate_hz, meta, truth), absent


def with_tool(converted: Converted, nominal: NominalModel, tool: Tool) -> Converted:
    """Return a log whose recording has the external torque by the sensor of a tool (T, nv) [N] and [N m].

    Raises:
        ConfigError: the robot has no such body.
    """
    if converted.tool is None:
        return converted
    read = converted.recording
    axes = rotation(np.array(tool.quat))
    torque = point_torque(nominal, tool.body, tool.pos, axes, read.sensed.q, converted.tool)
    absent = tuple(name for name in converted.absent if name != EXTERNAL)
    known = replace(read, truth=replace(read.truth, tau_ext=torque), meta={**read.meta, ABSENT: list(absent)})
    return replace(converted, recording=known, absent=absent)
