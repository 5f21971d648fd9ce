"""From a robot's log to the observer's residual: `./reproduce observe LOG --robot TABLE --map FILE` (docs/logs.md).

It writes the log as a recording, the residual as an estimate of the external torque (method MOB), and a plot. It prints
what was made of the log and what looks wrong with it.
"""

import logging
import sys
from argparse import Namespace
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import chain
from pathlib import Path

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL, recording_columns, torque_columns
from mobnet.core.estimator import Estimate
from mobnet.core.files import check_place, sweep
from mobnet.core.joints import JointLayout
from mobnet.core.notes import read_array_note
from mobnet.core.options import observe_parser
from mobnet.core.printed import printed
from mobnet.core.recording import Recording, SensedRecording
from mobnet.core.store import NOTE, array_writer, file_of
from mobnet.core.word_checks import check_observe
from mobnet.estimation import observer
from mobnet.estimation.observer import drives_of
from mobnet.estimation.own import ESTIMATE, RECORDING
from mobnet.estimation.sampling import DRIVES, OBSERVER
from mobnet.formats.loading import load_section
from mobnet.formats.log_map import LogMap
from mobnet.formats.plain import as_plain
from mobnet.kernel.drive import TorqueKind
from mobnet.robot.description import RobotDescription
from mobnet.robot.given import given_robot
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.clocks import ClockBounds, rate_of
from mobnet.robotlog.convert import Converted, convert, with_tool
from mobnet.robotlog.delimited import refuse_without_header
from mobnet.robotlog.flags import pushed_rows
from mobnet.robotlog.formats import column_names, read_log, stem_of
from mobnet.robotlog.hints.base import base_hints, weight_hints
from mobnet.robotlog.hints.bounds import HintBounds
from mobnet.robotlog.hints.columns import (
    base_column_hints,
    clock_hints,
    column_hints,
    limit_hints,
    unit_hints,
)
from mobnet.robotlog.hints.delay import speed_delay_hints, torque_delay
from mobnet.robotlog.hints.explained import explanation
from mobnet.robotlog.hints.motion import jump_hints, motion_hints
from mobnet.robotlog.hints.torque import torque_hints
from mobnet.robotlog.hints.windows import known_joints, windows_of
from mobnet.robotlog.long_arrays import long_array
from mobnet.robotlog.meaning import default_map, resolved, wanted_columns
from mobnet.robotlog.pieces import pieces, root_mean_square
from mobnet.robotlog.piped import as_file
from mobnet.robotlog.plot import plot_residual
from mobnet.robotlog.wrenches import (
    Wrenches,
    WrenchNumbers,
    WrenchPoint,
    place_of,
    wrench_lines,
    wrenches_of,
    write_wrenches,
)
from mobnet.settings.lab import load_lab
from mobnet.settings.robotlog import RobotLog

log = logging.getLogger(__name__)
PLOT = "residual"  # beside the arrays of a log
MANY = 100_000  # samples above which progress is told
OBSERVED_ROWS = 100_000  # samples of a piece, from which the observer's state is carried to the next one


@dataclass(frozen=True)
class ObservedLog:
    """A log with its residual r of (9), (T, nv) [N] and [N m], and hints on what is wrong with it.

    If its motion and torques are right, `explained` says what the residual comes from.
    """

    converted: Converted
    residual: Array
    hints: tuple[str, ...]
    explained: tuple[str, ...] = ()


def observe_log(
    path: Path,
    robot: RobotDescription,
    meaning: LogMap | None,
    torque: TorqueKind,
    gain_hz: float,
    gravity_m_s2: float,
    bounds: RobotLog,
    folder: Path | None = None,
) -> ObservedLog:
    """Read a log, run the momentum observer on it, and look for what is wrong with it.

    Without a map, columns have the names of a recording. `torque` says what torques are, whatever the map says; the
    gain is K_0 of (7) [1/s]. The arrays of a long log lie in files in a folder, where one is given.

    Raises:
        DataError: the log cannot be read, or a column is missing or not accepted.
        ConfigError: the map does not fit the robot.
    """
    converted = converted_log(path, robot.layout, meaning, bounds, folder)
    nominal = NominalModel(robot, gravity_m_s2=gravity_m_s2)
    if meaning and meaning.tool:
        converted = with_tool(converted, nominal, meaning.tool)
    read = converted.recording
    mob = observer.RobotObserver(nominal, gain_hz, read.rate_hz, torque)
    rows = len(read.sensed)
    _progress(rows, f"{rows} samples read")
    residual = long_array(read.sensed.v.shape, folder)
    for span in read.spans():
        state = mob.init()
        for piece in pieces(span.start, span.stop, OBSERVED_ROWS):
            state = mob.follow(state, read.sensed[piece], residual[piece])
    _progress(rows, "residual computed; looking for what is wrong with the log")
    hints, explained = looked_at(converted, nominal, torque, gravity_m_s2, as_plain(bounds, HintBounds))
    return ObservedLog(converted, residual, tuple(hints), tuple(explained))


def _progress(rows: int, text: str) -> None:
    """Tell how far a log of many rows is, which takes more than a few seconds."""
    if rows > MANY:
        log.info("%s", text)


def converted_log(
    path: Path, layout: JointLayout, meaning: LogMap | None, bounds: RobotLog, folder: Path | None = None
) -> Converted:
    """Return the recording of a log, of which only what the map names is read.

    The arrays of a long log lie in files in a folder, where one is given.

    Raises:
        DataError: the log cannot be read, or a column is missing or not accepted.
        ConfigError: the map does not fit the robot.
    """
    with as_file(path) as file:
        names = column_names(file)
        if meaning is None:
            refuse_without_header(file, names)
        meaning = resolved(file, meaning or default_map(file, names, layout), names, layout)
        return convert(
            file, read_log(file, wanted_columns(meaning, names)), meaning, layout, as_plain(bounds, ClockBounds), folder
        )


def looked_at(
    converted: Converted, nominal: NominalModel, torque: TorqueKind, gravity_m_s2: float, bounds: HintBounds
) -> tuple[list[str], list[str]]:
    """Return what looks wrong with a log whose torques are of a kind, each as one line with numbers.

    The second list says what the residual comes from, if neither motion nor torques are wrong.
    """
    read = converted.recording
    layout = nominal.robot.layout
    sensed = read.sensed
    spans = read.spans()
    rate_hz = read.rate_hz
    hints = list(converted.hints)
    # With a clock in another unit all speeds and delays are wrong, and no other hint means anything.
    if units := list(unit_hints(converted.clocks)):
        return hints + units, []
    hints += clock_hints(converted.clocks, bounds)
    hints += column_hints(sensed, layout.actuated, bounds)
    hints += limit_hints(sensed, layout)
    motors = sensed.q[:, -layout.nu :], sensed.v[:, -layout.nu :]
    wrong = list(motion_hints(*motors, spans, rate_hz, layout.actuated, bounds))
    hints += wrong
    hints += jump_hints(motors[0], spans, rate_hz, layout)
    late = [] if wrong else list(speed_delay_hints(*motors, spans, rate_hz, layout.actuated, bounds))
    hints += late
    if nominal.robot.floating:
        hints += base_column_hints(sensed, bounds)
        of_base = list(base_hints(sensed, spans, rate_hz, bounds))
        wrong += of_base
        hints += of_base
    # Torques that a wrong motion would need say nothing.
    if wrong:
        return hints, []
    # Of feet that do not carry the weight the wrenches are wrong, and would make torques of the legs look wrong.
    heavy = list(weight_hints(nominal, sensed, converted.wrenches, gravity_m_s2, bounds))
    wrenches = {} if heavy else converted.wrenches
    torques, explained = torques_looked_at(read, nominal, torque, wrenches, bool(late), bounds)
    return hints + heavy + torques, explained


def torques_looked_at(
    read: SensedRecording,
    nominal: NominalModel,
    torque: TorqueKind,
    wrenches: Mapping[str, Array],
    late: bool,
    bounds: HintBounds,
    with_friction: bool = True,
) -> tuple[list[str], list[str]]:
    """Return what looks wrong with torques of a kind, or else what explains the residual.

    Args:
        read: the log as a recording.
        nominal: the model of the robot.
        torque: whether torques are samples at the ticks or means over the intervals before them.
        wrenches: what the feet's sensors read, side -> (T, 6) [N], [N m].
        late: whether speeds are known to be late.
        bounds: when a hint is given.
        with_friction: whether friction is among what explains the residual.

    Returns:
        Hints, each as one line with numbers, and what explains the residual where there are none.
    """
    log_of = read.sensed, read.spans(), read.rate_hz, wrenches
    windows = windows_of(*log_of, torque, 0.0, bounds)
    if windows is None:
        return [], []
    known = known_joints(nominal, windows, windows.asked(nominal), bounds)
    # Late speeds make torques look early, and so do the gears of arms and a waist, which alone are left where legs tell
    # nothing for want of a sensor at the foot.
    is_known = not late and set(nominal.robot.feet) <= set(wrenches)
    delay = torque_delay(nominal, *log_of, known, torque, bounds) if is_known else None
    if delay:
        windows = windows_of(*log_of, torque, delay.samples, bounds) or windows
    # What the table says of the errors of torques is no mistake of the log.
    if drives := drives_of(nominal.robot.friction, nominal.robot.layout.actuated):
        windows = replace(windows, torque=drives.scale * windows.torque - drives.offset)
    hints = list(torque_hints(nominal, windows, bounds))
    if delay:
        return [delay.text, *hints], []
    return hints, [] if hints or late else list(explanation(nominal, windows, bounds, with_friction))


def write_observed(observed: ObservedLog, robot: RobotDescription, gain_hz: float, torque: str, out: Path) -> None:
    """Write recording, estimate and plot into a folder."""
    read = observed.converted.recording
    meta = {**read.meta, "gain_hz": gain_hz, "torque": torque, **({DRIVES: robot.drives} if robot.drives else {})}
    _write_recording(out / RECORDING, replace(read, meta=meta), robot.layout)
    columns = torque_columns(robot.layout, [EXTERNAL], robot.layout.names)
    recorded = read_array_note(file_of(out / RECORDING, NOTE))["footer"]
    note = {"rate_hz": read.rate_hz, **meta, "method": OBSERVER, "recording": recorded}
    with array_writer(out / ESTIMATE, columns) as writer:
        for rows in pieces(0, len(observed.residual)):
            writer.append(observed.residual[rows])
        writer.close(note, read.segments)
    pushed = pushed_rows(observed.converted, robot.layout.actuated)
    plot_residual(read, observed.residual, pushed, robot.layout, out / PLOT)


def _write_recording(stem: Path, recording: Recording, layout: JointLayout) -> None:
    """Write a recording as `mobnet.core.recording_file` does, in pieces: a log may be as large as the memory."""
    columns = recording_columns(layout)
    fields = {**vars(recording.sensed), **vars(recording.truth)}
    with array_writer(stem, list(chain.from_iterable(columns.values()))) as writer:
        for rows in pieces(0, len(recording.sensed)):
            writer.append(np.concatenate([fields[name][rows] for name in columns], axis=1))
        writer.close({"rate_hz": recording.rate_hz, **recording.meta}, recording.segments)


def report_lines(observed: ObservedLog, robot: RobotDescription, out: Path) -> Iterator[str]:
    """Yield what the command prints."""
    read = observed.converted.recording
    rows = len(read.sensed)
    count = len(read.segments)
    way = "interpolated linearly" if observed.converted.interpolated else "as they are in the log"
    parts = f"{count} segment{'s' * (count > 1)}"
    yield f"{rows} samples at {read.rate_hz:g} Hz, {rows / read.rate_hz:.6g} s in {parts}, {way}"
    if observed.converted.interpolated:
        yield f"rates of the log: {', '.join(_rates(observed.converted.clocks))}"
    if absent := [name for name in observed.converted.absent if name != EXTERNAL]:
        yield f"not in the log, and zero in the recording: {', '.join(absent)}"
    size = root_mean_square(observed.residual)
    motor = root_mean_square(read.sensed.tau_motor)
    yield "residual: what the model does not explain, root mean square beside that of the motor"
    width = max(map(len, robot.layout.names))
    for k, (name, value) in enumerate(zip(robot.layout.names, size, strict=True)):
        motor_number = k - len(robot.layout.virtual)
        beside = f"  of {motor[motor_number]:8.3f}" if motor_number >= 0 else ""
        yield f"  {name:<{width}} {value:9.3f}{beside} {robot.layout.unit(name)}"
    if observed.explained:
        yield "explained, by least squares:"
    yield from (f"  {line}" for line in observed.explained)
    yield "hints: none" if not observed.hints else f"hints: {len(observed.hints)}"
    yield from (f"  {hint}" for hint in observed.hints)
    yield f"written: {out / RECORDING}.parquet, {out / ESTIMATE}.parquet, {out / PLOT}.png"


def _rates(clocks: Mapping[str, Array]) -> Iterator[str]:
    """Yield the rates of a log's clocks (T,) [s], each with its signals."""
    signals: dict[float, list[str]] = {}
    for name, clock in clocks.items():
        signals.setdefault(rate_of(clock), []).append(name)
    yield from (f"{rate:.6g} Hz of {', '.join(names)}" for rate, names in signals.items())


def run(options: Namespace) -> Iterator[str]:
    """Observe a log as the command's options say, and yield what is printed."""
    check_observe(options)
    settings = load_lab()
    robot = given_robot(options.robot, settings.robot)
    meaning = load_section(options.map, LogMap) if options.map else None
    gain_hz = settings.observer.gain_hz if options.gain is None else options.gain
    torque = options.torque or (meaning.torque if meaning else "sample")
    numbers = as_plain(settings.robotlog.wrench, WrenchNumbers)
    gravity = settings.plant.gravity_m_s2
    places = [place_of(NominalModel(robot), name) for name in dict.fromkeys(options.wrench)]
    out = options.out or Path(f"{stem_of(options.log)}_observed")
    check_place(out)
    sweep(out)
    observed = observe_log(options.log, robot, meaning, torque, gain_hz, gravity, settings.robotlog, out)
    wrenches = [_wrench(observed, robot, place, numbers) for place in places]
    write_observed(observed, robot, gain_hz, torque, out)
    write_wrenches(wrenches, observed.converted.recording, OBSERVER, out)
    yield from report_lines(observed, robot, out)
    yield from wrench_lines(wrenches, numbers, out)


def _wrench(observed: ObservedLog, robot: RobotDescription, place: WrenchPoint, numbers: WrenchNumbers) -> Wrenches:
    """Return what the residual of the joints of a place tells of a wrench there."""
    residual = observed.residual[:, robot.layout.columns(place.joints)]
    q = observed.converted.recording.sensed.q
    return wrenches_of(NominalModel(robot), place, q, Estimate(residual), numbers)


def main(words: list[str]) -> int:
    """Run the command; return its exit status."""
    options = observe_parser().parse_args(words)
    logging.getLogger(observer.__name__).setLevel(logging.WARNING)  # it tells of each segment
    return printed(log, lambda: run(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
