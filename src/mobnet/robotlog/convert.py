"""From the columns of a log to the recording that the observer takes: units, order, clock, gaps."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.columns import FEET, recording_columns
from mobnet.core.errors import ConfigError, DataError, not_accepted, refuse
from mobnet.core.joints import JointLayout
from mobnet.core.motion import turned
from mobnet.core.recording import Recording, Sensed, Truth
from mobnet.robotlog.formats import Column, Columns, names_like
from mobnet.settings.robotlog import LogMap, RobotLog, Signal

SI = {  # unit -> in SI units
    "deg": np.pi / 180, "deg/s": np.pi / 180, "rpm": 2 * np.pi / 60, "mN m": 1e-3, "kN m": 1e3, "mm": 1e-3,
    "g": 9.80665, "kN": 1e3, "ms": 1e-3, "us": 1e-6, "ns": 1e-9,
}  # fmt: skip
BASE = ("quaternion", "velocity", "omega", "acc")  # what a floating base needs
WIDTHS = {"position": 3, "quaternion": 4, "velocity": 3, "omega": 3, "acc": 3, "left_foot": 6, "right_foot": 6}
MOTORS = ("q", "v", "tau_motor")
ROUND = 1e-3  # a rate this close to a whole number [Hz] is meant to be it


@dataclass(frozen=True)
class Timed:
    """A signal in SI units (T, n) with its own clock (T,) [s]."""

    time_s: Array
    values: Array


@dataclass(frozen=True)
class Converted:
    """A recording, and what was done to make it.

    `wrenches` are those of the feet that have sensors, side -> (T, 6) [N], [N m]; `absent` are signals that the log
    does not have and that are zero; `clocks` are those of the log, signal -> (T,) [s].
    """

    recording: Recording
    wrenches: Mapping[str, Array]
    absent: tuple[str, ...]
    clocks: Mapping[str, Array]
    interpolated: bool


def default_map(columns: Columns, layout: JointLayout) -> LogMap:
    """Return the map of a log whose columns have the names of a recording (docs/data.md), with the clock `time`."""
    fields, taken = recording_columns(layout), dict[str, Signal]()
    base = 7 if layout.virtual else 0
    names = {key: [name for name, *_ in group] for key, group in fields.items()}
    groups = {
        "q": names["q"][base:], "v": names["v"][6 if base else 0 :], "tau_motor": names["tau_motor"],
        "position": names["q"][:3] if base else [], "quaternion": names["q"][3:base], "acc": names["acc_base_in_base"],
        "velocity": names["v"][:3] if base else [], "omega": names["v"][3:6] if base else [],
        **{foot: names[f"wrench_{foot}"] for foot in FEET}, "swing": names["swing"], "landing": names["landing"],
    }  # fmt: skip
    for key, group in groups.items():
        if group and (key in MOTORS or set(group) <= columns.keys()):
            taken[key] = Signal(columns=tuple(group))
    return LogMap.model_validate(taken)


def convert(path: Path, columns: Columns, meaning: LogMap, layout: JointLayout, bounds: RobotLog) -> Converted:
    """Make a recording of a log.

    Raises:
        DataError: a column is missing, a number is not finite, a clock does not rise, or signals do not overlap.
        ConfigError: the map does not fit the robot.
    """
    signals = _signals(path, columns, meaning, layout)
    rate_hz = meaning.rate_hz or _rate_of(signals["q"].time_s)
    clocks = {name: signal.time_s for name, signal in signals.items()}
    ticks, segments, interpolated = _ticks(path, clocks, rate_hz, bounds)
    values = {name: _at(signal, ticks) if interpolated else signal.values for name, signal in signals.items()}
    return _recording(values, layout, segments, rate_hz, clocks, interpolated)


def _signals(path: Path, columns: Columns, meaning: LogMap, layout: JointLayout) -> dict[str, Timed]:
    """Return all signals of the map in SI units."""
    given = {name: signal for name in LogMap.model_fields if isinstance(signal := getattr(meaning, name), Signal)}
    floating = bool(layout.virtual)
    needed = [*MOTORS, *(BASE if floating else ())]
    if missing := [name for name in needed if name not in given]:
        raise ConfigError(f"{path}: {', '.join(missing)}: missing in the map; a robot with a floating base needs them")
    widths = dict.fromkeys(MOTORS, layout.nu) | WIDTHS | dict.fromkeys(("swing", "landing"), len(layout.legs))
    faults = [
        f"{name}.columns: {not_accepted('number', len(signal.columns), [widths[name]])}"
        for name, signal in given.items()
        if len(signal.columns) != widths[name]
    ]
    wanted = [name for signal in given.values() for name in signal.columns]
    faults += [not_accepted("column", name, names_like(columns)) for name in wanted if name not in columns]
    refuse(path, faults)
    found = {name: _timed(path, columns, signal, meaning) for name, signal in given.items()}
    if "quaternion" in found:
        found["quaternion"] = _unit_quaternion(path, found["quaternion"], given["quaternion"].order)
    for name, signal in (("velocity", given.get("velocity")), ("acc", given.get("acc"))):
        if signal is not None and (signal.frame == "base" or signal.gravity == "removed"):
            found[name] = _turned(found[name], found["quaternion"], signal)
    return found


def _timed(path: Path, columns: Columns, signal: Signal, meaning: LogMap) -> Timed:
    """Return a signal in SI units with its clock."""
    parts = [columns[name] for name in signal.columns]
    values = np.stack([part.values for part in parts], axis=1) if _alike(parts) else _joined(parts)
    if not np.isfinite(values).all():
        row, k = np.argwhere(~np.isfinite(values))[0]
        where = f"column {signal.columns[k]!r}, row {row}"
        raise DataError(f"{path}: {not_accepted(where, float(values[row, k]), ['finite numbers'])}")
    scale = np.multiply(signal.scale, SI.get(signal.unit or "-", 1.0))
    time_s = _clock(path, columns, parts[0], meaning, len(values)) - signal.delay_s
    return Timed(time_s, np.asarray(signal.sign) * (scale * values - np.asarray(signal.offset)))


def _alike(parts: list[Column]) -> bool:
    """Return whether columns share one clock."""
    first = parts[0].time_s
    return all(
        part.time_s is first or (part.time_s is not None and first is not None and np.array_equal(part.time_s, first))
        for part in parts
    )


def _joined(parts: list[Column]) -> Array:
    """Return columns of different messages at the times of the first one, (T, n)."""
    stamped = [(part.time_s, part.values) for part in parts if part.time_s is not None]
    return np.stack([np.interp(stamped[0][0], *pair) for pair in stamped], axis=1)


def _clock(path: Path, columns: Columns, first: Column, meaning: LogMap, rows: int) -> Array:
    """Return the times of a column (T,) [s], which rise."""
    clock, unit = meaning.clock.column, SI.get(meaning.clock.unit, 1.0)
    if first.time_s is not None:
        time_s = first.time_s
    elif clock in columns:
        time_s = columns[clock].values * unit
    elif meaning.rate_hz:
        time_s = np.arange(rows) / meaning.rate_hz
    else:
        raise DataError(f"{path}: {not_accepted('clock.column', clock, names_like(columns))}; or give rate_hz")
    if len(time_s) < 2 or not (np.diff(time_s) > 0).all():
        row = int(np.argmin(np.diff(time_s) > 0)) + 1 if len(time_s) > 1 else 0
        raise DataError(f"{path}: clock: row {row} is not after the one before it; accepted: two samples, rising times")
    return time_s


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
    quat = _at(quaternion, signal.time_s)
    quat /= np.linalg.norm(quat, axis=1)[:, None]
    if meaning.frame == "base":
        return Timed(signal.time_s, turned(quat.T, signal.values.T).T)
    up = np.tile([0.0, 0.0, SI["g"]], (len(quat), 1))
    back = quat * [1.0, -1.0, -1.0, -1.0]
    return Timed(signal.time_s, signal.values + turned(back.T, up.T).T)


def _rate_of(time_s: Array) -> float:
    """Return the rate of a clock [Hz], a whole number where it is close to one."""
    rate = 1.0 / float(np.median(np.diff(time_s)))
    return float(round(rate)) if abs(rate - round(rate)) < ROUND * rate else rate


def _ticks(
    path: Path, clocks: Mapping[str, Array], rate_hz: float, bounds: RobotLog
) -> tuple[Array, tuple[tuple[int, int], ...], bool]:
    """Return the times of the recording's rows (T,) [s], its segments, and whether rows lie between samples.

    Samples of one even clock at the rate itself are taken as they are; else values are interpolated linearly.
    """
    first = next(iter(clocks.values()))
    steps = np.diff(first)
    is_one = all(len(clock) == len(first) and np.array_equal(clock, first) for clock in clocks.values())
    pauses = steps > bounds.gap_intervals * np.median(steps)
    even = np.std(steps[~pauses]) <= bounds.even * np.median(steps)
    if is_one and even and abs(1.0 / np.median(steps) - rate_hz) <= ROUND * rate_hz:
        ends = [0, *(np.flatnonzero(pauses) + 1).tolist(), len(first)]
        return first, _long_enough(path, pairwise(ends)), False
    start, end = max(clock[0] for clock in clocks.values()), min(clock[-1] for clock in clocks.values())
    if end - start < 2 / rate_hz:
        raise DataError(f"{path}: signals overlap from {start:.3f} to {end:.3f} s; accepted: two samples at least")
    ticks = start + np.arange(int((end - start) * rate_hz) + 1) / rate_hz
    whole = np.ones(len(ticks), dtype=bool)
    for clock in {id(clock): clock for clock in clocks.values()}.values():
        steps = np.diff(clock)
        before = np.clip(np.searchsorted(clock, ticks, side="right") - 1, 0, len(steps) - 1)
        whole &= steps[before] <= bounds.gap_intervals * np.median(steps)
    kept = ticks[whole]
    ends = [0, *(np.flatnonzero(np.diff(np.flatnonzero(whole)) > 1) + 1).tolist(), len(kept)]
    return kept, _long_enough(path, pairwise(ends)), True


def _long_enough(path: Path, segments: Iterable[tuple[int, int]]) -> tuple[tuple[int, int], ...]:
    """Return segments that are not empty."""
    found = tuple((start, end) for start, end in segments if end > start)
    if not found:
        raise DataError(f"{path}: clock: no two samples follow each other without a gap; accepted: a recording")
    return found


def _at(signal: Timed, ticks: Array) -> Array:
    """Return a signal at other times, by linear interpolation (T, n)."""
    return np.stack([np.interp(ticks, signal.time_s, column) for column in signal.values.T], axis=1)


def _recording(
    values: Mapping[str, Array], layout: JointLayout, segments: tuple[tuple[int, int], ...], rate_hz: float,
    clocks: Mapping[str, Array], interpolated: bool,
) -> Converted:  # fmt: skip
    """Return the recording of signals (T, n) in SI units."""
    rows, none = len(values["q"]), np.zeros((len(values["q"]), 0))
    fields = recording_columns(layout)

    def given(name: str, key: str) -> NDArray[np.float64]:
        return values.get(name, np.zeros((rows, len(fields[key]))))

    base_q, base_v = none, none
    if layout.virtual:
        quat = values["quaternion"] / np.linalg.norm(values["quaternion"], axis=1)[:, None]
        base_q = np.concatenate([values.get("position", np.zeros((rows, 3))), quat], axis=1)
        base_v = np.concatenate([values["velocity"], values["omega"]], axis=1)
    motor = values["tau_motor"]
    sensed = Sensed(
        q=np.concatenate([base_q, values["q"]], axis=1), v=np.concatenate([base_v, values["v"]], axis=1),
        acc_base_in_base=given("acc", "acc_base_in_base"), tau_des=motor, tau_motor=motor,
        swing=given("swing", "swing"), command=given("command", "command"), landing=given("landing", "landing"),
    )  # fmt: skip
    truth = Truth(
        tau_ext=np.zeros((rows, layout.nv)), wrench_left_foot=given("left_foot", "wrench_left_foot"),
        wrench_right_foot=given("right_foot", "wrench_right_foot"), contact=np.zeros((rows, len(fields["contact"]))),
        pushed=np.zeros((rows, 1)), tau_random=np.zeros_like(motor), tau_push=np.zeros((rows, layout.nv)),
        push=np.zeros((rows, len(fields["push"]))),
    )  # fmt: skip
    wanted = {"swing": layout.legs, "landing": layout.legs, "position": layout.virtual}
    wanted |= {foot: foot.removesuffix("_foot") in layout.legs for foot in FEET}
    absent = ("tau_ext", *(name for name, has in wanted.items() if has and name not in values))
    meta = {"scenario": "log", "level": "robot", "seed": 0, "absent": list(absent)}
    wrenches = {foot.removesuffix("_foot"): values[foot] for foot in FEET if foot in values}
    recording = Recording(sensed, segments, rate_hz, meta, truth)
    return Converted(recording, wrenches, absent, clocks, interpolated)
