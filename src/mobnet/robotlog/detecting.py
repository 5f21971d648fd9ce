"""What `./reproduce detect` does once its flags and the configuration are read (docs/detection.md)."""

from argparse import Namespace
from collections.abc import Iterator
from pathlib import Path

from mobnet.core.errors import DataError
from mobnet.core.files import check_place, sweep, write_text
from mobnet.core.options import MCAP
from mobnet.core.rows import csv_text
from mobnet.detection.threshold_file import check_thresholds, read_thresholds, sampling_of
from mobnet.estimation.estimate import write_estimate
from mobnet.estimation.own import ESTIMATE, OwnNetwork, read_network_folder
from mobnet.estimation.sampling import check_sampling
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.formats.loading import load_section
from mobnet.formats.log_map import LogMap
from mobnet.formats.plain import as_plain
from mobnet.robot.description import RobotDescription
from mobnet.robot.given import given_robot
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.detected import LogDetection, detect_log
from mobnet.robotlog.flags import COLUMNS, pushed_rows
from mobnet.robotlog.flags_mcap import write_mcap
from mobnet.robotlog.formats import stem_of
from mobnet.robotlog.plot import plot_flags
from mobnet.robotlog.wrenches import WrenchNumbers, place_of, wrench_lines, wrenches_of, write_wrenches
from mobnet.settings.lab import Lab

FLAGS = "flags.csv"
PLOT = "flags"


def write_detected(
    made: LogDetection, robot: RobotDescription, network: OwnNetwork | None, thresholds: LimbThresholds, out: Path
) -> None:
    """Write flags, estimate and plot into a folder."""
    read = made.observed.converted.recording
    note = {"method": thresholds.method, "network": network.fingerprint if network else None}
    write_estimate(out / ESTIMATE, read, made.estimate, thresholds.joints, robot.layout, note)
    write_text(out / FLAGS, csv_text(COLUMNS, [flag.row() for flag in made.flags]))
    pushed = pushed_rows(made.observed.converted, thresholds.joints)
    plot_flags(made.observed.converted.time_s, read.segments, made.watched, made.flags, thresholds, pushed, out / PLOT)


def report_lines(made: LogDetection) -> Iterator[str]:
    """Yield what the command prints."""
    read = made.observed.converted.recording
    yield f"{len(read.sensed)} samples at {read.rate_hz:g} Hz, hints on the log: {len(made.observed.hints)}"
    yield from (f"  {hint}" for hint in made.observed.hints)
    yield f"flags: {len(made.flags) or 'none'}"
    for flag in made.flags:
        push = flag.push
        where = f", as {push.force_n:.0f} N at {push.point} along {push.direction} of {push.body}" if push else ""
        span = f"{flag.start_s:9.3f} to {flag.end_s:.3f} s"
        yield f"  {span}: {flag.joint} at {flag.ratio:.2f} times its threshold{where}"
    if known := made.found:
        yield f"{known.found} of {known.pushes} pushes found, {known.others} other flag{'s' * (known.others != 1)}"


def detect(options: Namespace, settings: Lab) -> Iterator[str]:
    """Detect as the command's options say, and yield what is printed."""
    robot = given_robot(options.robot, settings.robot)
    meaning = load_section(options.map, LogMap) if options.map else None
    network = read_network_folder(options.network, robot.layout, settings) if options.network else None
    thresholds = read_thresholds(options.thresholds)
    if network and thresholds.network is None:  # `calibrate` keeps the observer where that finds more
        network = None
        yield f"{options.thresholds} are thresholds of the observer alone: the network is not used"
    check_thresholds(options.thresholds, thresholds, robot, network)
    if meaning and "torque" in meaning.model_fields_set and meaning.torque != thresholds.torque:
        made_with = f"{options.thresholds} was made with {thresholds.torque!r}"
        raise DataError(
            f"{options.map}: torque is {meaning.torque!r}, but {made_with}; one of both has to be made anew"
        )
    if network:
        check_sampling(options.thresholds, sampling_of(thresholds), network.sampling, network.folder)
    nominal = NominalModel(robot)
    places = [place_of(nominal, name, thresholds.joints) for name in dict.fromkeys(options.wrench)]
    out = options.out or Path(f"{stem_of(options.log)}_detected")
    is_mcap = out.suffix == MCAP
    check_place(out.parent if is_mcap else out)
    sweep(out.parent if is_mcap else out)
    made = detect_log(options.log, robot, meaning, network, thresholds, settings)
    read = made.observed.converted.recording
    numbers = as_plain(settings.robotlog.wrench, WrenchNumbers)
    wrenches = [wrenches_of(nominal, place, read.sensed.q, made.estimate, numbers) for place in places]
    if is_mcap:
        write_mcap(made, thresholds, robot.layout.columns(thresholds.joints), out)
        yield from report_lines(made)
        yield f"written: {out}"
        return
    write_detected(made, robot, network, thresholds, out)
    write_wrenches(wrenches, read, thresholds.method, out)
    yield from report_lines(made)
    yield f"written: {out / FLAGS}, {out / ESTIMATE}.parquet, {out / PLOT}.png"
    yield from wrench_lines(wrenches, numbers, out)
