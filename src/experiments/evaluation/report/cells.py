"""Numbers of any table, by the name of the table and the columns that stand before the number."""

from pathlib import Path
from typing import Literal

from experiments.evaluation.number.number import Number
from mobnet.core.errors import refuse_lines
from mobnet.core.rows import parse_field, read_texts

COUNTS = ("hours", "count", "events")  # they stand before a number, but are no name of it
FINE = ("N m", "-")  # units of numbers that are written with two digits
LARGE = 100.0


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
