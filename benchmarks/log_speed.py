"""Ten minutes of a robot's log at 1 kHz through `./reproduce observe`: processor time and memory of the whole command.

The logs are smooth motion with torques that do not belong to it, so that the search for mistakes tries all that it
knows. Start, hints, files and plot are in the numbers; code is compiled before, by a log of a second.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from pyarrow import csv

from mobnet.core.columns import recording_columns
from mobnet.core.joints import JointLayout
from mobnet.formats.loading import load_section
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe

ROOT = Path(__file__).parents[1]
ROBOTS = {"an arm of two joints": "tests/data/arm.yaml", "TOCABI": "configs/robots/tocabi.yaml"}
RATE_HZ, SECONDS = 1000.0, 600.0
MOST_S, MOST_MB = 20.0, 3000.0
DIGITS = 5  # after the point, as loggers write
MEGABYTE = 1 / 1024  # kilobytes, as Linux counts
SIGNALS = ("q", "v", "acc_base_in_base", "tau_motor", "wrench_left_foot", "wrench_right_foot")
STILL = {"q.quat_w": 1.0, "acc.z": 9.80665}
Row = dict[str, float | str]


def main() -> list[Row]:
    """Return rows of seconds and megabytes for each robot, from CSV and from Parquet."""
    rows: list[Row] = []
    for name, table in ROBOTS.items():
        layout = describe(load_section(ROOT / table, RobotTable)).layout
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "log.csv"
            csv.write_csv(log_of(layout, 1.0), path)
            _cost(path, table)
            log = log_of(layout, SECONDS)
            csv.write_csv(log, path)
            pq.write_table(log, path.with_suffix(".parquet"))
            for kind in (path, path.with_suffix(".parquet")):
                seconds, megabytes = _cost(kind, table)
                what = f"observe, 10 min of {name} at 1 kHz, {kind.suffix}"
                rows.append({"name": what, "ours": seconds, "unit": "s", "at_most": MOST_S})
                rows.append({"name": f"{what}: memory", "ours": megabytes, "unit": "MB", "at_most": MOST_MB})
    return rows


def log_of(layout: JointLayout, seconds: float) -> pa.Table:
    """Return a log as long [s], with a clock and the columns of a recording that a robot has."""
    rng, t = np.random.default_rng(0), np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    columns = {"time": t}
    rates = rng.uniform(1.0, 5.0, layout.nu)
    for signal, group in recording_columns(layout).items():
        if signal not in SIGNALS:
            continue
        for k, (name, *_) in enumerate(group[len(group) - layout.nu :] if signal in ("q", "v", "tau_motor") else ()):
            turned = {"q": 0.3 * np.sin(rates[k] * t), "v": 0.3 * rates[k] * np.cos(rates[k] * t)}
            columns[name] = turned[signal] if signal in turned else 5.0 * np.sin(2.0 * rates[k] * t)
        for name, *_ in group:
            columns.setdefault(name, np.full(len(t), STILL.get(name, 0.0)) + 1e-3 * np.sin(t))
    return pa.table({name: pa.array(np.round(values, DIGITS)) for name, values in columns.items()})


def _cost(path: Path, table: str) -> tuple[float, float]:
    """Return processor time [s] and most memory [MB] of the command in a process of its own, on one thread.

    Raises:
        CalledProcessError: the command failed.
    """
    words = [sys.executable, "-m", "mobnet.robotlog.observe", str(path), "--robot", table]
    words += ["--out", str(path.parent / "made")]
    process = subprocess.Popen(
        words, cwd=ROOT, env={**os.environ, "OMP_NUM_THREADS": "1"}, stdout=subprocess.DEVNULL
    )  # fmt: skip
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, words)
    return used.ru_utime + used.ru_stime, used.ru_maxrss * MEGABYTE


if __name__ == "__main__":
    for row in main():
        print("{name}: {ours:.1f} {unit}".format(**row))
