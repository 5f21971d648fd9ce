"""What logs of free motion tell of a robot: `./reproduce identify FOLDER... --robot TABLE` (docs/identify.md).

It finds friction, rotor inertia and errors of the motors' torques, joint by joint, tries them on the end of the logs,
and writes them into a new table, by which the observer takes them into account.
"""

import logging
import sys
from argparse import Namespace
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from mobnet.core.errors import DataError
from mobnet.core.options import identify_parser
from mobnet.core.place import command
from mobnet.core.printed import printed
from mobnet.core.recording import SensedRecording
from mobnet.core.word_checks import RECORDING, check_new_file
from mobnet.estimation import observer
from mobnet.estimation.own import read_log_folder
from mobnet.formats.loading import load_section
from mobnet.formats.log_map import LogMap
from mobnet.formats.parts import BodyRow, FrictionRow
from mobnet.formats.plain import as_plain
from mobnet.formats.robot import RobotTable
from mobnet.kernel.drive import TorqueKind
from mobnet.robot.description import RobotDescription
from mobnet.robot.given import given_robot, given_table, is_robot_file
from mobnet.robot.nominal import NominalModel
from mobnet.robot.table_file import head_of, write_table
from mobnet.robot.word_checks import carrier_named
from mobnet.robotlog.hints.bounds import HintBounds
from mobnet.robotlog.hints.motion import motion_hints
from mobnet.robotlog.identifying.fit import FitNumbers, JointFit, fit_joints
from mobnet.robotlog.identifying.payload import Payload
from mobnet.robotlog.identifying.regressors import (
    RegressorWindows,
    WindowNumbers,
    columns_of,
    moved,
    together,
    windows_of,
)
from mobnet.robotlog.observe import converted_log, torques_looked_at
from mobnet.settings.lab import Lab, load_lab
from mobnet.settings.robotlog import Identification

log = logging.getLogger(__name__)
TERMS = ("coulomb", "viscous", "offset", "armature")
FURTHER = ("load", "scale")  # on request
PAYLOAD = "payload"  # name of its body in the table
DIGITS = 6  # of a number in the table


@dataclass(frozen=True)
class FreeLog:
    """A log of free motion: where it is, what the robot sensed, and what its torques are."""

    path: Path
    recording: SensedRecording
    torque: TorqueKind


def read_free_log(path: Path, robot: RobotDescription, meaning: LogMap | None, settings: Lab) -> FreeLog:
    """Read a folder that `./reproduce observe` wrote, or a log itself.

    Raises:
        DataError: it cannot be read, or a column is missing or not accepted.
        ConfigError: the map does not fit the robot.
    """
    if (path / f"{RECORDING}.json").exists():
        log = read_log_folder(path, robot.layout)
        return FreeLog(path, log.recording, log.sampling.torque)
    converted = converted_log(path, robot.layout, meaning, settings.robotlog)
    return FreeLog(path, converted.recording, meaning.torque if meaning else "sample")


def identify(
    robot: RobotDescription,
    logs: Sequence[FreeLog],
    terms: Sequence[str],
    settings: Lab,
    payload: str | None = None,
) -> tuple[dict[str, JointFit], Payload | None]:
    """Return the numbers of the joints that move in logs of free motion, and the payload of a body.

    Raises:
        DataError: the logs are too short.
        ConfigError: no joint moves the body.
    """
    numbers = settings.robotlog.identify
    gravity = settings.plant.gravity_m_s2
    carrier = carrier_named(robot, payload) if payload else None
    of_windows = as_plain(numbers, WindowNumbers)
    windows = [windows_of(robot, log.recording, log.torque, gravity, of_windows, carrier) for log in logs]
    known, held_out = split(windows, numbers)
    fits, carried = fit_joints(known, held_out, columns_of(of_windows), terms, as_plain(numbers, FitNumbers))
    # Of a joint that rests a log tells no friction: it keeps the numbers of the table.
    speeds = moved([log.recording for log in logs], robot.layout.nu)
    fits_of_moving = {
        joint: fit
        for joint, fit, speed in zip(robot.layout.actuated, fits, speeds, strict=True)
        if speed >= numbers.least_speed_rad_s
    }
    return fits_of_moving, carried


def suspicions(robot: RobotDescription, logs: Sequence[FreeLog], settings: Lab) -> list[str]:
    """Return what `./reproduce observe` says of motion and torques of logs but for friction, each behind a log's name.

    Where something is wrong with a log, the numbers that are identified in it are, too.
    """
    nominal = NominalModel(robot, gravity_m_s2=settings.plant.gravity_m_s2)
    bounds = as_plain(settings.robotlog, HintBounds)
    lines = list[str]()
    for log in logs:
        read = log.recording
        q, v = (values[:, -robot.layout.nu :] for values in (read.sensed.q, read.sensed.v))
        hints = list(motion_hints(q, v, read.spans(), read.rate_hz, robot.layout.actuated, bounds))
        # Torques that a wrong motion would need say nothing.
        if not hints:
            hints_and_explained = torques_looked_at(
                read, nominal, log.torque, {}, late=False, bounds=bounds, with_friction=False
            )
            hints = [*chain.from_iterable(hints_and_explained)]
        lines += [f"{log.path.name}: {hint}" for hint in hints]
    return lines


def split(windows: Sequence[RegressorWindows], numbers: Identification) -> tuple[RegressorWindows, RegressorWindows]:
    """Return the windows of logs before and after the time at which what is held out begins.

    Raises:
        DataError: there are too few windows.
    """
    cuts = [len(windows_of_log) - round(numbers.held_out * len(windows_of_log)) for windows_of_log in windows]
    known = together([windows_of_log[:cut] for windows_of_log, cut in zip(windows, cuts, strict=True)])
    held_out = together([windows_of_log[cut:] for windows_of_log, cut in zip(windows, cuts, strict=True)])
    if len(known) < numbers.least_windows or not len(held_out):
        seconds = numbers.window_s * (len(known) + len(held_out))
        least = numbers.window_s * numbers.least_windows / (1 - numbers.held_out)
        raise DataError(f"{seconds:g} s of free motion; {least:g} s or more are needed")
    return known, held_out


def with_numbers(table: RobotTable, fits: Mapping[str, JointFit]) -> RobotTable:
    """Return a table with the numbers of joints in place of its own; other joints keep theirs."""
    rows = {joint: friction_row(fit) for joint, fit in fits.items()}
    joints = tuple(
        row.model_copy(update={"armature": _rounded(fits[row.id].factors["armature"])}) if row.id in fits else row
        for row in table.joints
    )
    ordered = {row.id: rows.get(row.id) or table.friction.get(row.id) for row in joints}
    friction = {joint: row for joint, row in ordered.items() if row}
    return table.model_copy(update={"joints": joints, "friction": friction})


def with_payload(table: RobotTable, body: str, payload: Payload) -> RobotTable:
    """Return a table with one more body, a payload welded to one of its bodies; published totals are left out."""
    names = [row.name for row in table.bodies]
    name = PAYLOAD
    number = 2
    while name in names:
        name = f"{PAYLOAD}_{number}"
        number += 1
    inertia = _rounded(payload.inertia)
    (x, y, z) = map(_rounded, payload.com)
    row = BodyRow(
        name=name,
        parent=body,
        pos=(0.0, 0.0, 0.0),
        quat=(1.0, 0.0, 0.0, 0.0),
        mass=_rounded(payload.mass),
        com=(x, y, z),
        inertia=(inertia, inertia, inertia, 0.0, 0.0, 0.0),
    )
    # Bodies of a table stand depth-first: the payload comes right after the body that carries it.
    place = names.index(body) + 1
    return table.model_copy(update={"bodies": (*table.bodies[:place], row, *table.bodies[place:]), "totals": None})


def friction_row(fit: JointFit) -> FrictionRow:
    """Return the row of a joint in a table."""
    kind, number = fit.sign
    shape = {"smoothing_rad_s": number} if kind == "smoothing" else {"smoothing_rad_s": 1.0, "breakaway_rad": number}
    factors = {term: _rounded(value) for term, value in fit.factors.items()}
    optional = {"load": factors["load"]} if factors.get("load") else {}
    optional |= {"scale": _rounded(1.0 + factors["scale"])} if "scale" in factors else {}
    return FrictionRow(
        coulomb_nm=factors["coulomb"], viscous_nms=factors["viscous"], offset_nm=factors["offset"], **optional, **shape
    )


def _rounded(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")


def report_lines(fits: Mapping[str, JointFit], robot: RobotDescription, held_out: float) -> Iterator[str]:
    """Yield what the command prints."""
    units = {
        "coulomb": "Coulomb [N m]",
        "viscous": "viscous [N m s/rad]",
        "load": "load [-]",
        "offset": "offset [N m]",
        "armature": "rotor inertia [kg m^2]",
        "scale": "scale - 1 [-]",
    }
    fitted = set(chain.from_iterable(fit.factors for fit in fits.values()))
    shown = [term for term in units if term in fitted]
    rows = [["joint", *(units[term] for term in shown), "sign", "residual, held out", "explained"]]
    for joint, fit in fits.items():
        cells = [_cell(fit, term) for term in shown]
        kind, number = fit.sign
        sign = f"tanh, {number:g} rad/s" if kind == "smoothing" else f"Dahl, {number:g} rad"
        left = f"{fit.before_nm:.3g} -> {fit.after_nm:.3g} N m"
        rows.append([joint, *cells, sign, left, f"{fit.explained:.0%}"])
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    yield f"numbers with their intervals; the last {held_out:.0%} of each log are held out to try them"
    for row in rows:
        cells = [f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True)]
        yield "  ".join(cells).rstrip()
    if still := [joint for joint in robot.layout.actuated if joint not in fits]:
        yield f"did not move, and keep the numbers of the table: {', '.join(still)}"


def _cell(fit: JointFit, term: str) -> str:
    """Return a number with half the width of its interval."""
    return f"{fit.factors[term]:.4g} ± {fit.half[term]:.2g}" if term in fit.factors else "-"


def run(options: Namespace) -> Iterator[str]:
    """Identify as the command's options say, and yield what is printed."""
    settings = load_lab()
    table = given_table(options.robot, settings.robot)
    robot = given_robot(options.robot, settings.robot)
    out = options.out or Path(f"{robot.name.replace(' ', '_')}_identified.yaml")
    check_new_file(out, force=options.force)
    meaning = load_section(options.map, LogMap) if options.map else None
    logs = [read_free_log(path, robot, meaning, settings) for path in options.logs]
    terms = (*TERMS, *(term for term in FURTHER if getattr(options, term)))
    fits, carried = identify(robot, logs, terms, settings, options.payload)
    head = list(robot.notes)
    if options.robot is not None and not is_robot_file(options.robot):
        head = head_of(options.robot)
    suspected = suspicions(robot, logs, settings)
    made = f"friction and armature: from {', '.join(path.name for path in options.logs)}, by {command('identify')}."
    made_table = with_numbers(table, fits)
    made_table = with_payload(made_table, options.payload, carried) if carried else made_table
    write_table(out, made_table, [*head, made, *(f"observe says of {line}" for line in suspected)])
    load_section(out, RobotTable)
    yield from report_lines(fits, robot, settings.robotlog.identify.held_out)
    if suspected:
        yield "observe says of these logs:"
    yield from (f"  {line}" for line in suspected)
    if carried:
        place = ", ".join(f"{x:.3f} ± {half:.2g}" for x, half in zip(carried.com, carried.com_half, strict=True))
        mass = f"{carried.mass:.4g} ± {carried.mass_half:.2g} kg"
        yield f"payload of {options.payload}: {mass} with its centre at ({place}) m in the axes of that body"
    yield f"written: {out}"


def main(words: list[str]) -> int:
    """Run the command; return its exit status."""
    options = identify_parser().parse_args(words)
    logging.getLogger(observer.__name__).setLevel(logging.WARNING)  # it tells of each segment
    return printed(log, lambda: run(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
