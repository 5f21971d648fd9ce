"""Rows of text and numbers as CSV files, and the numbers of tables."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from experiments.evaluation.number.number import Number
from mobnet.core.errors import refuse_lines
from mobnet.core.files import write_text
from mobnet.core.rows import csv_text, parse_field, read_texts

Field = str | int | float | None


def write_csv(path: Path, columns: Sequence[str], rows: Iterable[Sequence[Field]]) -> None:
    """Write CSV atomically: numbers with six digits, None as an empty field, lines ending in a newline."""
    write_text(path, csv_text(columns, rows))


def read_numbers(path: Path) -> list[tuple[dict[str, str], Number]]:
    """Read the rows of a table: the texts of all columns, and the number, with what the paper prints.

    Raises:
        DataError: the file is missing, a column is missing or a field is not a number where one is due.
    """
    names = ("value", "low", "high", "published")
    faults = list[str]()
    found: list[tuple[dict[str, str], Number]] = []
    # The names of the columns are line 1 of the file.
    for line, row in enumerate(read_texts(path, [*names, "unit"]), start=2):
        numbers = {name: parse_field(row[name], float | None, f"{path}:{line}: {name}", faults) for name in names}
        found.append((row, Number(**numbers, unit=row["unit"])))
    refuse_lines(faults)
    return found
