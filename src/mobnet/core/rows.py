"""Rows of text and numbers as CSV: as text, and read from files."""

import csv
import io
import math
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

from mobnet.core.errors import DataError, nearest_of, not_accepted, refuse, refuse_lines
from mobnet.core.files import read_text

Row = TypeVar("Row")
WHOLE = re.compile(r"-?[0-9]+")
REAL = re.compile(r"-?[0-9]*\.?[0-9]+(e[-+]?[0-9]+)?", re.IGNORECASE)


def csv_text(columns: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return rows as CSV: numbers with six digits, None as an empty field, lines ending in a newline."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    for row in rows:
        writer.writerow([_field(value) for _, value in zip(columns, row, strict=True)])
    return text.getvalue()


def _field(value: object) -> str:
    if value is None:
        return ""
    return f"{value + 0.0:.6g}" if isinstance(value, float) else str(value)  # + 0.0 drops the sign of -0


def read_rows(path: Path, kind: type[Row]) -> list[Row]:
    """Read dataclass rows from CSV; columns that are no field of theirs are left out.

    Raises:
        DataError: the file is missing or damaged, a column is missing or a field is not a finite number where one is
            due; one line for each.
    """
    hints = get_type_hints(kind)
    faults = list[str]()
    rows = read_texts(path, list(hints))
    columns = list[Sequence[Any]]()
    for name, hint in hints.items():
        texts = [row[name] for row in rows]
        columns.append(_parsed(path, name, hint, texts, faults))
    refuse_lines(faults)
    return [kind(*row) for row in zip(*columns, strict=True)]


def _parsed(path: Path, name: str, hint: Any, texts: Sequence[str], faults: list[str]) -> Sequence[Any]:
    """Return the fields of a column as the type that it has; what is none is added to the faults."""
    if hint is str:
        return texts
    if hint is int and all(map(WHOLE.fullmatch, texts)):
        return [int(text) for text in texts]
    if hint is float and all(map(REAL.fullmatch, texts)) and not any(map(math.isinf, map(float, texts))):
        return [float(text) for text in texts]
    return [parse_field(text, hint, f"{path}:{line}: {name}", faults) for line, text in enumerate(texts, start=2)]


def refuse_rows(path: Path, faults: Iterable[tuple[int, str, object, str]]) -> None:
    """Raise a DataError with one line for each fault of a file of rows: number of the row, column, value, accepted."""
    refuse_lines(not_accepted(f"{path}:{row + 2}: {name}", value, [accepted]) for row, name, value, accepted in faults)


def read_texts(path: Path, needed: Sequence[str] = ()) -> list[dict[str, str]]:
    """Read the rows of a CSV file, column -> text.

    Raises:
        DataError: the file, or a column that is needed, is missing, a column occurs twice, or a line is cut off or has
            more fields than columns.
    """
    try:
        header, *lines = [*csv.reader(io.StringIO(read_text(path)), strict=True)] or [[]]
    except csv.Error as error:
        raise DataError(f"{path}: not CSV, {error}") from None
    faults = [
        f"column {name!r} is missing; accepted: it, beside {nearest_of(header, name)}"
        for name in needed
        if name not in header
    ]
    faults += [f"column {name!r} occurs {n} times; accepted: once" for name, n in Counter(header).items() if n > 1]
    refuse(path, faults)
    refuse_lines(
        f"{path}:{line}: line is cut off or too long: {len(fields)} fields; accepted: {len(header)}"
        for line, fields in enumerate(lines, start=2)
        if len(fields) != len(header)
    )
    return [dict(zip(header, fields, strict=True)) for fields in lines]


def parse_field(field: str, hint: Any, where: str, faults: list[str]) -> Any:
    """Return a CSV field as the type its column has; what is none is added to the faults."""
    if hint is str:
        return field
    if field == "" and hint not in (int, float):
        return None
    if hint is int and WHOLE.fullmatch(field):
        return int(field)
    number = float(field) if hint is not int and REAL.fullmatch(field) else math.inf
    if math.isinf(number):
        faults.append(not_accepted(where, field, ["a whole number" if hint is int else "a finite number"]))
    return number
