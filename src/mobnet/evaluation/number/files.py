"""Rows of text and numbers as CSV files, written and read."""

import csv
import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

from mobnet.core.errors import DataError, not_accepted
from mobnet.core.files import read_text, write_text
from mobnet.evaluation.number.number import Number

Row = TypeVar("Row")
Field = str | int | float | None


def write_csv(path: Path, columns: Sequence[str], rows: Iterable[Sequence[Field]]) -> None:
    """Write CSV atomically: numbers with six digits, None as an empty field, lines ending in a newline."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows([_text(field) for _, field in zip(columns, row, strict=True)] for row in rows)
    write_text(path, text.getvalue())


def _text(value: Field) -> str:
    """Return a value as a CSV field."""
    if value is None:
        return ""
    return f"{value + 0.0:.6g}" if isinstance(value, float) else str(value)  # + 0.0 drops the sign of -0


def read_rows(path: Path, kind: type[Row]) -> list[Row]:
    """Read dataclass rows from CSV; columns that are no field of theirs are left out.

    Raises:
        DataError: the file is missing, a column is missing or a field is not a number where one is due.
    """
    hints = get_type_hints(kind)
    return [
        kind(**{name: _parse(row[name], hint, f"{path}:{line}: {name}") for name, hint in hints.items()})
        for line, row in enumerate(read_texts(path, list(hints)), start=2)
    ]


def read_numbers(path: Path) -> list[tuple[dict[str, str], Number]]:
    """Read the rows of a table: the texts of all columns, and the number, with what the paper prints.

    Raises:
        DataError: the file is missing, a column is missing or a field is not a number where one is due.
    """
    names = ("value", "low", "high", "published")
    found: list[tuple[dict[str, str], Number]] = []
    for line, row in enumerate(read_texts(path, [*names, "unit"]), start=2):
        numbers = {name: _parse(row[name], float | None, f"{path}:{line}: {name}") for name in names}
        found.append((row, Number(**numbers, unit=row["unit"])))
    return found


def read_texts(path: Path, needed: Sequence[str] = ()) -> list[dict[str, str]]:
    """Read the rows of a CSV file, column -> text.

    Raises:
        DataError: the file, or a column that is needed, is missing.
    """
    reader = csv.DictReader(io.StringIO(read_text(path)))
    held = reader.fieldnames or ()
    missing = [name for name in needed if name not in held]
    if missing:
        raise DataError(f"{path}: column {missing[0]!r} is missing; it holds {', '.join(held)}")
    return list(reader)


def _parse(field: str | None, hint: Any, where: str) -> Any:
    """Return a CSV field as the type its column has."""
    if field is None:
        raise DataError(f"{where}: line is cut off")
    if hint is str:
        return field
    if field == "" and hint not in (int, float):
        return None
    try:
        return int(field) if hint is int else float(field)
    except ValueError:
        raise DataError(not_accepted(where, field, ["a number"])) from None
