"""A simulated log of any robot of a table that moves without walking: `./reproduce motion` (docs/robots.md)."""

import logging
import sys
from argparse import Namespace
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pyarrow as pa
from pyarrow import csv, parquet

from mobnet.core.columns import EXTERNAL, PUSHED, recording_columns
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.files import atomic_path, sweep
from mobnet.core.options import motion_parser
from mobnet.core.printed import printed
from mobnet.core.recording import Recording
from mobnet.core.word_checks import ENDINGS, check_motion
from mobnet.robot.description import RobotDescription, given_robot
from mobnet.settings.lab import load_lab
from mobnet.simulation.free_run import Numbers, record_motion

log = logging.getLogger(__name__)
SENSED = ("q", "v", "acc_base_in_base", "tau_motor")
TRUTH = (EXTERNAL, PUSHED)
DIGITS = 8  # behind the point
WRITERS = dict(zip(ENDINGS, (csv.write_csv, parquet.write_table), strict=True))


def write_log(recording: Recording, robot: RobotDescription, out: Path, truth: bool) -> None:
    """Write what a robot would log, and on request the truth, one row for each sample, with a column `time` [s].

    Raises:
        DataError: the ending of the file is not accepted.
    """
    if out.suffix not in WRITERS:
        raise DataError(not_accepted("ending", out.suffix, WRITERS))
    fields = recording_columns(robot.layout)
    columns = {"time": np.arange(len(recording.sensed)) / recording.rate_hz}
    for part, names in ((recording.sensed, SENSED), (recording.truth, TRUTH if truth else ())):
        for name in names:
            values = np.round(getattr(part, name), DIGITS)
            columns |= {column: values[:, k] for k, (column, *_) in enumerate(fields[name])}
    with atomic_path(out) as temporary:
        WRITERS[out.suffix](pa.table(columns), temporary)


def report_lines(recording: Recording, robot: RobotDescription, out: Path, truth: bool) -> Iterator[str]:
    """Yield what the command prints."""
    held = "; the base is held in the air" if robot.floating else ""
    apart = "shapes keep apart" if robot.shapes else "the table has no shapes: nothing keeps its bodies apart"
    samples = len(recording.sensed)
    rate_hz = recording.rate_hz
    yield f"{robot.name}: {samples} samples at {rate_hz:g} Hz, {samples / rate_hz:g} s{held}; {apart}"
    speeds = np.abs(recording.sensed.v[:, -robot.layout.nu :]).max(axis=0)
    shares = np.abs(recording.sensed.tau_motor).max(axis=0) / robot.torque_limits
    yield f"largest speed {speeds.max():.2f} rad/s, largest torque {shares.max():.0%} of what its motor gives"
    pushed = np.flatnonzero(np.diff(recording.truth.pushed[:, 0], prepend=0.0) > 0)
    if truth:
        yield f"{len(pushed)} pushes, {recording.truth.pushed.mean():.0%} of the time; truth: tau_ext.JOINT, pushed"
    yield f"written: {out}"


def run(options: Namespace) -> Iterator[str]:
    """Simulate a log as the command's options say, and yield what is printed."""
    check_motion(options)
    settings = load_lab()
    robot = given_robot(options.robot, settings)
    sweep(options.out.parent)
    numbers = Numbers(settings.free_motion, settings.plant, settings.rates)
    seconds = 60.0 * options.minutes
    recording = record_motion(robot, numbers, seconds, options.seed, options.ideal, options.pushes)
    truth = options.pushes or robot.floating
    write_log(recording, robot, options.out, truth)
    yield from report_lines(recording, robot, options.out, truth)


def main(words: list[str]) -> int:
    """Run the command; return its exit status."""
    options = motion_parser().parse_args(words)
    return printed(log, lambda: run(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
