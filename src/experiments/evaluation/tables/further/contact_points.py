"""Where collisions meet the legs, and with which force: errors of the point and of the force, by what is hit."""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from experiments.evaluation.measure.detection.contact_points import NAMED, NOTHING, ContactDeviation, contacts_of
from experiments.evaluation.measure.detection.results import ALL, CELLS, median_of
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import RULE, Line, Table, write_table
from experiments.plan.detection import Detections
from experiments.plan.runs import Run
from experiments.settings.detection_tables import ContactPoints
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import DETECTION
from mobnet.robot.description import describe
from mobnet.settings.data import Push
from mobnet.settings.detection import ContactPoint
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.robot import RobotTable

CM = 100.0
PERCENT = 100.0
DIGITS = 6
ERROR = "error"
SPREAD = "spread"
FORCE = "force"
SIZE = "force_size"
ANGLE = "angle"


def contact_points(
    settings: ContactPoints,
    contact_point: ContactPoint,
    robot: RobotTable,
    observer: ObserverSettings,
    statistics: Statistics,
    pushes: Mapping[str, Push],
    runs: Sequence[Run],
    detections: Detections,
    table_dir: Path,
) -> None:
    """Write contact_points.csv, .tex and .md: medians over collisions of what `contacts_of` says of them.

    Quantities are the distance to the true point [cm], its parts in the axes of the body that was hit, the distance
    that is expected, the force over the true one less 1 [%] with and without its sign, and the angle between them.
    """
    description = describe(robot)
    found = list(contacts_of(settings, contact_point, description, observer.gain_hz, pushes, runs, detections))
    write_contacts(table_dir / "contact_points", settings, statistics, found)


def write_contacts(
    stem: Path, settings: ContactPoints, statistics: Statistics, found: Sequence[ContactDeviation]
) -> None:
    """Write the three files of the table from what each line says of each collision."""
    rows: list[Sequence[Field]] = []
    lines: list[Line] = []
    for title in (*settings.lines, NAMED, NOTHING):
        numbers = {}
        for cell in (*CELLS, ALL):
            own = [one for one in found if one.line == title and cell in (one.cell, ALL)]
            numbers[cell] = {name: median_of(values, statistics, unit) for name, unit, values in _values(own)}
            place = settings.level, title, "+".join(settings.legs), settings.kind, cell
            rows += [
                (*place, name, *number.with_ends, len(own), number.unit, None) for name, number in numbers[cell].items()
            ]
        lines += [RULE] if title == NAMED else []
        lines.append([title, *_texts(numbers)])
    # the guesses are of every collision; a line has none of those in which it finds no contact
    hit = [one.cell for one in found if one.line == NOTHING]
    counts = [str(hit.count(cell)) for cell in CELLS]
    lines = [["collisions", str(len(hit)), "", *counts, "", "", ""], RULE, *lines]
    header = [
        "Point from",
        "error [cm]",
        f"{statistics.confidence:.0%}",
        *(f"{cell} [cm]" for cell in CELLS),
        "expected [cm]",
        "force [%]",
        "angle [deg]",
    ]
    write_table(stem, Table(DETECTION, rows, header, lines))


def _values(found: Sequence[ContactDeviation]) -> Iterator[tuple[str, str, list[float]]]:
    """Yield name, unit and values of each quantity of some collisions."""
    yield ERROR, "cm", [CM * float(np.linalg.norm(one.error_m)) for one in found]
    for axis, name in enumerate("xyz"):
        # rounded, as a part may be a zero that only rounding errors tell from zero
        yield f"{ERROR}_{name}", "cm", [round(CM * abs(float(one.error_m[axis])), DIGITS) for one in found]
    yield SPREAD, "cm", [CM * one.spread_m for one in found if one.spread_m is not None]
    yield FORCE, "%", [PERCENT * one.force for one in found if one.force is not None]
    yield SIZE, "%", [PERCENT * abs(one.force) for one in found if one.force is not None]
    yield ANGLE, "deg", [one.angle_deg for one in found if one.angle_deg is not None]


def _texts(numbers: Mapping[str, Mapping[str, Number]]) -> list[str]:
    """Return the cells of a line."""
    whole = numbers[ALL]
    cells = [numbers[cell][ERROR].text(1) for cell in CELLS]
    others = [whole[SPREAD].text(1), whole[SIZE].text(0), whole[ANGLE].text(0)]
    return [whole[ERROR].text(1), whole[ERROR].interval(1), *cells, *others]
