"""Table of falls by random torque: from which largest torque on legs and waist does a robot fall (section 4.3)?"""

from collections.abc import Iterator, Sequence
from dataclasses import astuple
from pathlib import Path

from mobnet.core.columns import FALLEN, Falls
from mobnet.evaluation.measure.detection.results import rate_of
from mobnet.evaluation.number.files import Field, read_rows
from mobnet.evaluation.tables.layout import Table, write_table
from mobnet.settings.evaluation import Statistics

ALL, CHOSEN, HOUR_S = "all", "chosen", 3600.0


def falls(counted: Sequence[Path], statistics: Statistics, out: Path) -> None:
    """Write a CSV, .tex and .md: falls of each robot with each largest random torque [N m], and of all [1/h].

    `counted` are the files of the robots, `out` is a path without a suffix. The torque that is raised until a robot
    falls is marked: the largest one up to which none fell.
    """
    by_robot = [read_rows(path, Falls) for path in counted]
    together = [
        Falls(ALL, own[0].amplitude_nm, sum(row.walked_s for row in own), sum(row.falls for row in own))
        for own in zip(*by_robot, strict=True)
    ]
    chosen = chosen_nm(together)
    robots = [rows[0].robot for rows in by_robot]
    header = ["Largest torque [N m]", *robots, ALL, "falls an hour", f"{statistics.confidence:.0%}", ""]
    lines = [
        [f"{row.amplitude_nm:g}", *(str(rows[k].falls) for rows in by_robot), str(row.falls), rate.text(1),
         rate.interval(1), CHOSEN if row.amplitude_nm == chosen else ""]
        for k, row in enumerate(together)
        for rate in [rate_of(row.falls, row.walked_s / HOUR_S, statistics)]
    ]  # fmt: skip
    records = [record for rows in (*by_robot, together) for record in _records(rows, chosen, statistics)]
    write_table(out, Table(FALLEN, records, header, lines))


def chosen_nm(rows: Sequence[Falls]) -> float | None:
    """Return the largest torque [N m], of rows in rising order, up to which nothing fell; None if there is none."""
    chosen = None
    for row in rows:
        if row.falls:
            break
        chosen = row.amplitude_nm
    return chosen


def _records(rows: Sequence[Falls], chosen: float | None, statistics: Statistics) -> Iterator[Sequence[Field]]:
    """Yield the rows of CSV of a robot, or of all of them."""
    for row in rows:
        rate = rate_of(row.falls, row.walked_s / HOUR_S, statistics)
        yield (*astuple(row), *rate.with_ends, int(row.amplitude_nm == chosen))
