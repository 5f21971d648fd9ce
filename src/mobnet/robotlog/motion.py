"""A simulated log of any robot of a table that moves without walking: `./reproduce motion` (docs/logs.md)."""

import contextlib
import logging
import sys
from argparse import Namespace
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
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
from mobnet.robot.description import RobotDescription
from mobnet.robot.given import given_robot
from mobnet.settings.lab import load_lab
from mobnet.simulation.free_run import Numbers, motion_pieces

log = logging.getLogger(__name__)
SENSED = ("q", "v", "acc_base_in_base", "tau_motor")
TRUTH = (EXTERNAL, PUSHED)
DIGITS = 8  # behind the point
WRITERS = dict(zip(ENDINGS, (csv.CSVWriter, parquet.ParquetWriter), strict=True))


@dataclass
class Told:
    """What the command tells of a log; speed [rad/s] and share of a motor's torque are the largest ones."""

    samples: int = 0
    speed: float = 0.0
    share: float = 0.0
    pushes: int = 0
    pushed: float = 0.0  # samples
    is_pushed: float = 0.0  # at the last sample

    def add(self, piece: Recording, robot: RobotDescription) -> None:
        """Take the samples that follow."""
        self.samples += len(piece.sensed)
        self.speed = max(self.speed, float(np.abs(piece.sensed.v[:, -robot.layout.nu :]).max()))
        self.share = max(self.share, float((np.abs(piece.sensed.tau_motor).max(axis=0) / robot.torque_limits).max()))
        pushed = piece.truth.pushed[:, 0]
        self.pushes += int(np.count_nonzero(np.diff(pushed, prepend=self.is_pushed) > 0))
        self.pushed += float(pushed.sum())
        self.is_pushed = float(pushed[-1])


def write_log(pieces: Iterable[Recording], robot: RobotDescription, out: Path, truth: bool) -> Told:
    """Write what a robot would log, and on request the truth, one row for each sample, with a column `time` [s].

    Pieces follow one another and are written one by one.

    Raises:
        DataError: the ending of the file is not accepted.
    """
    if out.suffix not in WRITERS:
        raise DataError(not_accepted("ending", out.suffix, WRITERS))
    written = Told()
    with atomic_path(out) as temporary, contextlib.ExitStack() as closed:
        writer = None
        for piece in pieces:
            table = _table(piece, robot, written.samples, truth)
            if writer is None:
                writer = closed.enter_context(WRITERS[out.suffix](temporary, table.schema))
            writer.write_table(table)
            written.add(piece, robot)
    return written


def _table(piece: Recording, robot: RobotDescription, first: int, truth: bool) -> pa.Table:
    """Return the columns of a log with samples of which `first` is the number of the first."""
    fields = recording_columns(robot.layout)
    columns = {"time": np.arange(first, first + len(piece.sensed)) / piece.rate_hz}
    for part, names in ((piece.sensed, SENSED), (piece.truth, TRUTH if truth else ())):
        for name in names:
            values = np.round(getattr(part, name), DIGITS)
            columns |= {column: values[:, k] for k, (column, *_) in enumerate(fields[name])}
    return pa.table(columns)


def report_lines(written: Told, robot: RobotDescription, rate_hz: float, out: Path, truth: bool) -> Iterator[str]:
    """Yield what the command prints."""
    base = "; the base is held in the air" if robot.floating else ""
    apart = "shapes keep apart" if robot.shapes else "the table has no shapes: nothing keeps its bodies apart"
    samples = written.samples
    yield f"{robot.name}: {samples} samples at {rate_hz:g} Hz, {samples / rate_hz:g} s{base}; {apart}"
    yield f"largest speed {written.speed:.2f} rad/s, largest torque {written.share:.0%} of what its motor gives"
    if truth:
        yield f"{written.pushes} pushes, {written.pushed / samples:.0%} of the time; truth: tau_ext.JOINT, pushed"
    yield f"written: {out}"


def run(options: Namespace) -> Iterator[str]:
    """Simulate a log as the command's options say, and yield what is printed."""
    check_motion(options)
    settings = load_lab()
    robot = given_robot(options.robot, settings.robot)
    if 60.0 * options.minutes * settings.rates.data_hz < 1.0:
        least = f"{1.0 / (60.0 * settings.rates.data_hz):.2g} or more, a sample at {settings.rates.data_hz:g} Hz"
        raise DataError(not_accepted("--minutes", options.minutes, [least]))
    sweep(options.out.parent)
    numbers = Numbers(settings.free_motion, settings.plant, settings.rates)
    seconds = 60.0 * options.minutes
    pieces = motion_pieces(robot, numbers, seconds, options.seed, options.ideal, options.pushes)
    truth = options.pushes or robot.floating
    written = write_log(pieces, robot, options.out, truth)
    yield from report_lines(written, robot, settings.rates.data_hz, options.out, truth)


def main(words: list[str]) -> int:
    """Run the command; return its exit status."""
    options = motion_parser().parse_args(words)
    return printed(log, lambda: run(options))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
