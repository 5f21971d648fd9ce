"""Table of falls by random torque: from which largest torque on legs and waist does a robot fall (section 4.3)?"""

from collections.abc import Iterator, Sequence
from dataclasses import astuple
from pathlib import Path
from statistics import median_low

from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import Table, write_table
from experiments.intervals.single import rate_of
from experiments.records.falls import Falls
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import FALLEN
from mobnet.core.rows import read_rows

ALL = "all"
CHOSEN = "largest without a fall"
HOUR_S = 3600.0


def falls(counted: Sequence[Path], statistics: Statistics, out: Path) -> None:
    """Write a CSV, .tex and .md: falls of each robot with each largest random torque [N m], and of all [1/h].

    `counted` are the files of the robots, `out` is a path without a suffix. The torque that is raised until a robot
    falls is marked: the largest one up to which it did not. That of all is the median robot's, the lower one of two.
    """
    by_robot = [read_rows(path, Falls) for path in counted]
    together: list[Falls] = []
    # Every robot walked with the same torques in the same order, so that rows of one place belong together.
    for own in zip(*by_robot, strict=True):
        walked_s = sum(row.walked_s for row in own)
        together.append(Falls(ALL, own[0].amplitude_nm, walked_s, sum(row.falls for row in own)))
    own_nm = [chosen_nm(rows) for rows in by_robot]
    median = median_low(own_nm)
    robots = [rows[0].robot for rows in by_robot]
    header = ["Largest torque [N m]", *robots, ALL, "falls an hour", f"{statistics.confidence:.0%}"]
    lines: list[list[str]] = []
    for k, row in enumerate(together):
        rate = rate_of(row.falls, row.walked_s / HOUR_S, statistics)
        counts = [str(rows[k].falls) for rows in by_robot]
        lines.append([f"{row.amplitude_nm:g}", *counts, str(row.falls), rate.text(1), rate.interval(1)])
    lines.append([CHOSEN, *(f"{chosen:g}" for chosen in own_nm), f"{median:g}", "", ""])
    records: list[Sequence[Field]] = []
    for rows, chosen in zip((*by_robot, together), (*own_nm, median), strict=True):
        records += _records(rows, chosen, statistics)
    write_table(out, Table(FALLEN, records, header, lines))


def chosen_nm(rows: Sequence[Falls]) -> float:
    """Return the largest torque [N m], of a robot's rows in rising order, up to which it did not fall, or 0."""
    chosen = 0.0
    for row in rows:
        if row.falls:
            break
        chosen = row.amplitude_nm
    return chosen


def _records(rows: Sequence[Falls], chosen: float, statistics: Statistics) -> Iterator[Sequence[Field]]:
    """Yield the rows of CSV of a robot, or of all of them."""
    for row in rows:
        rate = rate_of(row.falls, row.walked_s / HOUR_S, statistics)
        yield (*astuple(row), *rate.with_ends, int(row.amplitude_nm == chosen))
