"""The three tables of the paper's main text, each of which compares what many tables hold: legs, limbs, detectors."""

from collections.abc import Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Literal

from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.layout import Line, Table, tex_in_groups, write_table
from experiments.settings.detection_tables import AlarmTable
from experiments.settings.tables import LegsTable, LimbsTable, MainTables
from mobnet.core.errors import refuse_lines
from mobnet.core.rows import parse_field, read_texts

COUNTS = ("hours", "count", "events")  # they stand before a number, but are no name of it
FINE = ("N m", "-")  # units of numbers that are written with two digits
LARGE = 100.0
COLUMNS = ("row", "quantity", "value", "low", "high", "unit", "published")
NONE = Number(None)
ZERO, ABOVE = "zero", "*"  # the method that estimates nothing, and what stands behind an error larger than its
PUSHED = ("push_share", "rise_delay")  # metrics of a push
BOUND = "rise_bound"  # metric: share of the walks whose delay is a lower bound
DETECTED = {  # quantity -> its cell, of a detector of a leg; both readings of the paper's rule, and that for a rate
    "threshold": "table_13@{}@walking@mean.LL3 1@threshold",
    "found": "table_09@{}@walking@all@found",
    "delay": "table_09@{}@walking@all@delay",
    "alarms": "false_alarms@{}@walking@random@measured",
    "found in place": "table_09@{}@largest@all@found",
    "alarms in place": "false_alarms@{}@largest@random@measured",
    "found at rate": "found_by_rate@{}@collision@all@found",
    "delay at rate": "found_by_rate@{}@collision@all@delay",
    "alarms at rate": "false_alarms@{}@collision@held out@measured",
}
RULE_HEADS = {  # head -> quantity of a column, with thresholds by the paper's rule from random walking
    "LL3 [N m]": "threshold",
    "found": "found",
    "original": "original",
    "delay [ms]": "delay",
    "false alarms [1/h]": "alarms",
}
PLACE_HEADS = {"found": "found in place", "false alarms [1/h]": "alarms in place"}  # from walking in place
RATE_HEADS = {  # the same, for one false alarm an hour
    "found": "found at rate",
    "95 %": "interval",
    "delay [ms]": "delay at rate",
    "false alarms [1/h]": "alarms at rate",
}
RULES = {
    "original's rule, random walking": RULE_HEADS,
    "the same, in place": PLACE_HEADS,
    "threshold for one false alarm an hour": RATE_HEADS,
}
LEG_HEADS = ("error [N m]", "95 %", "original", "push share", "delay [ms]")
Cells = Mapping[str, Number]
Fields = Sequence[str | float | None]


def cells_of(path: Path) -> dict[str, Number]:
    """Read the numbers of a table: `<table>@<column>@<column>...` -> number.

    Raises:
        DataError: the file or a column is missing, or a field is not a number where one is due.
    """
    faults = list[str]()
    found = dict[str, Number]()
    for line, row in enumerate(read_texts(path, ["value", "unit"]), start=2):
        before = list(row)[: list(row).index("value")]
        name = "@".join([path.stem, *(row[column] for column in before if column not in COUNTS)])
        numbers = {
            column: parse_field(row[column], float | None, f"{path}:{line}: {column}", faults)
            for column in ("value", "low", "high", "published")
            if column in row
        }
        found[name] = Number(**numbers, unit=row["unit"])
    refuse_lines(faults)
    return found


def cell_text(number: Number, part: Literal["number", "interval", "published"] = "number") -> str:
    """Return a number, its interval or the paper's as text; what is no torque or ratio has one digit, or none."""
    size = abs((number.published if part == "published" else number.value) or 0.0)
    digits = 2 if number.unit in FINE else int(size < LARGE)
    if part == "interval":
        return number.interval(digits)
    return Number(number.published).text(digits) if part == "published" else number.text(digits)


def main_tables(settings: MainTables, sources: Sequence[Path], out: Path) -> None:
    """Write legs, limbs and detectors as CSV, TeX and Markdown beside `out`, from the finished tables `sources`.

    A number that no source holds, such as that of a method without a run on one of the plants, is a dash.

    Raises:
        DataError: a table is missing or damaged.
    """
    cells: dict[str, Number] = {}
    for path in sources:
        cells |= cells_of(path)
    plants = {plant.title: LEG_HEADS for plant in settings.legs.plants}
    for name, table, groups in (
        ("legs", legs_table(settings.legs, cells), plants),
        ("detectors", detectors_table(settings.detectors, cells), RULES),
    ):
        write_table(out.with_name(name), table, tex_in_groups(table.header[0], groups, table.lines))
    write_table(out.with_name("limbs"), limbs_table(settings.by_limb, cells))


def legs_table(settings: LegsTable, cells: Cells) -> Table:
    """Return errors [N m] of the left leg in walking, and shares [-] and delays [ms] of pushes, by method."""
    header = ["Method"]
    rows = list[Fields]()
    lines = list[Line]()
    for plant in settings.plants:
        header += [f"{plant.title}: {head}" for head in LEG_HEADS]
    for method in settings.methods:
        line = [method]
        for plant in settings.plants:
            error = cells.get(f"methods@{plant.walk}@{method}@LL@avg@rmse", NONE)
            paper = Number(cells.get(f"{plant.printed}@{plant.walk}@{method}@avg@rmse", NONE).published)
            share, delay = (cells.get(f"peaks@{plant.push}@{method}@LL@avg@{name}", NONE) for name in PUSHED)
            late = delay_text(delay, cells.get(f"peaks@{plant.push}@{method}@LL@avg@{BOUND}", NONE))
            line += [error.text(), error.interval(), paper.text(), share.text(), late]
            rows.append((method, f"{plant.walk}@rmse", *error.with_ends, error.unit, paper.value))
            of_push = zip(PUSHED, (share, delay), strict=True)
            rows += [(method, f"{plant.push}@{name}", *one.with_ends, one.unit, None) for name, one in of_push]
        lines.append(line)
    return Table(COLUMNS, rows, header, lines)


def delay_text(delay: Number, bound: Number) -> str:
    """Return the delay of a push, a lower bound where that of any walk ends with the window: a share of them [-]."""
    return f">{cell_text(delay)}" if bound.value else cell_text(delay)


def bound_of(cells: Cells, name: str) -> Number:
    """Return the share of the walks [-] in which a delay of some name is a lower bound; no number if it is none."""
    if not name.endswith(f"@{PUSHED[1]}"):
        return NONE
    return cells.get(name.removesuffix(PUSHED[1]) + BOUND, NONE)


def limbs_table(settings: LimbsTable, cells: Cells) -> Table:
    """Return errors over that of estimating nothing [-], limb by limb, after the latter in the limb's unit."""
    rows = list[Fields]()
    lines = list[Line]()
    for limb in settings.lines:
        nothing = cells.get(f"{limb.test}@{ZERO}@{limb.column}", NONE)
        line = [limb.title, limb.part, f"{nothing.text()} {nothing.unit}"]
        for method in settings.methods:
            value = cells.get(f"{limb.test}@{method}@{limb.column}", NONE).value
            over = None if value is None or not nothing.value else value / nothing.value
            text = Number(over).text()
            line.append(text + (ABOVE if over is not None and float(text) > 1 else ""))
            rows.append((f"{limb.title}, {limb.part}", method, over, None, None, "-", None))
        lines.append(line)
    return Table(COLUMNS, rows, ["Test", "Limb", ZERO, *settings.methods], lines, left=2)


def detectors_table(settings: AlarmTable, cells: Cells) -> Table:
    """Return what detectors find by the paper's rule and for one false alarm an hour, and how often they are wrong.

    The paper's rule has two readings.
    """
    rows = list[Fields]()
    lines = list[Line]()
    for level, detector in product(settings.levels, settings.detectors):
        place = f"{level}@{detector}@{settings.leg}"
        found = {name: cells.get(cell.format(place), NONE) for name, cell in DETECTED.items()}
        rows += [(detector, name, *one.with_ends, one.unit, one.published) for name, one in found.items()]
        texts = {name: cell_text(one) for name, one in found.items()}
        texts["interval"] = found["found at rate"].interval()
        texts["original"] = cell_text(found["found"], "published")
        lines.append([detector, *(texts[name] for heads in RULES.values() for name in heads.values())])
    header = [f"{rule}: {head}" for rule, heads in RULES.items() for head in heads]
    return Table(COLUMNS, rows, ["Detector", *header], lines)
