"""Where collisions meet the legs, and with which force: errors of the point and of the force, by what is hit."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd

from experiments.evaluation.measure.detection.contact_points import ERRORS, NAMED, NOTHING, contacts_of
from experiments.evaluation.measure.detection.results import ALL, CELLS, median_of
from experiments.evaluation.number.frames import records_of, rows_of
from experiments.evaluation.number.laws import fields_of
from experiments.evaluation.tables.layout import RULE, Line, Table, write_table
from experiments.evaluation.tables.look import ShownColumn, TableLook, lines_of
from experiments.plan.detection import Detections
from experiments.plan.runs import Run
from experiments.settings.detection_tables import ContactPoints
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import DETECTION
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe
from mobnet.settings.data import Push
from mobnet.settings.detection import ContactPoint
from mobnet.settings.methods import ObserverSettings

CM = 100.0
PERCENT = 100.0
DIGITS = 6
ERROR = "error"
SPREAD = "spread"
FORCE = "force"
SIZE = "force_size"
ANGLE = "angle"
QUANTITIES = {
    ERROR: "cm",
    **{f"{ERROR}_{axis}": "cm" for axis in "xyz"},
    SPREAD: "cm",
    FORCE: "%",
    SIZE: "%",
    ANGLE: "deg",
}


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
    contacts = contacts_of(settings, contact_point, description, observer.gain_hz, pushes, runs, detections)
    write_contacts(table_dir / "contact_points", settings, statistics, contacts)


def write_contacts(stem: Path, settings: ContactPoints, statistics: Statistics, contacts: pd.DataFrame) -> None:
    """Write the three files of the table from what each line says of each collision."""
    contacts = with_quantities(contacts)
    rows: list[dict[str, object]] = []
    for title, cell in product((*settings.lines, NAMED, NOTHING), (*CELLS, ALL)):
        # A line may have no collision of a cell, and has a row of it all the same.
        same = rows_of(contacts, line=title) if cell == ALL else rows_of(contacts, line=title, cell=cell)
        for quantity, unit in QUANTITIES.items():
            number = median_of(same[quantity].dropna().tolist(), statistics, unit)
            place = {"detector": title, "cell": cell, "quantity": quantity, "guess": title in (NAMED, NOTHING)}
            rows.append({**place, **fields_of(number), "count": len(same)})
    table = pd.DataFrame(rows).assign(level=settings.level, leg="+".join(settings.legs), kind=settings.kind)
    look = look_of(statistics)
    # The guesses are of every collision; a line has none of those in which it finds no contact.
    hit = rows_of(contacts, line=NOTHING)["cell"]
    counts = [str((hit == cell).sum()) for cell in CELLS]
    lines: list[Line] = [["collisions", str(len(hit)), "", *counts, "", "", ""], RULE, *lines_of(table, look)]
    write_table(stem, Table(DETECTION, records_of(table, DETECTION), look.header, lines))


def with_quantities(contacts: pd.DataFrame) -> pd.DataFrame:
    """Return CONTACTS with the quantities of the table [cm], [%], [deg]."""
    errors = contacts[[*ERRORS]]
    # Rounded, as a part may be a zero that only rounding errors tell from zero.
    parts = {
        f"{ERROR}_{axis}": (CM * errors[name].abs()).round(DIGITS) for axis, name in zip("xyz", ERRORS, strict=True)
    }
    return contacts.assign(
        **parts,
        **{
            ERROR: CM * np.linalg.norm(contacts[[*ERRORS]], axis=1),
            SPREAD: CM * contacts["spread_m"],
            FORCE: PERCENT * contacts["force"],
            SIZE: PERCENT * contacts["force"].abs(),
            ANGLE: contacts["angle_deg"],
        },
    )


def look_of(statistics: Statistics) -> TableLook:
    """Return what a reader sees: a line for each estimate, then for each guess."""
    every = {"cell": ALL}
    shown = [ShownColumn("error [cm]", {**every, "quantity": ERROR}, 1, f"{statistics.confidence:.0%}")]
    shown += [ShownColumn(f"{cell} [cm]", {"cell": cell, "quantity": ERROR}, 1) for cell in CELLS]
    shown.append(ShownColumn("expected [cm]", {**every, "quantity": SPREAD}, 1))
    shown.append(ShownColumn("force [%]", {**every, "quantity": SIZE}, 0))
    shown.append(ShownColumn("angle [deg]", {**every, "quantity": ANGLE}, 0))
    return TableLook({"detector": "Point from"}, shown, blocks=["guess"])
