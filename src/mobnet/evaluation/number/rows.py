"""Rows of the result tables as CSV: one typed dataclass a file, one row a number."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, TypeVar, get_type_hints

from mobnet.core.errors import DataError, not_accepted
from mobnet.core.files import write_text

Row = TypeVar("Row")


@dataclass(frozen=True)
class Score:
    """One number measured on one run: a test recording, and a network seed for a learned method.

    Attributes:
        scenario: what was walked.
        level: uncertainty level of section 5.1.
        method: estimator, a row of the configuration's `methods`.
        network_seed: seed of the networks; 0 for a method without any.
        test_seed: seed of the test recording.
        limb: limb of section 4.1.
        joint: a joint of the limb, or `avg`, the mean over the limb's joints of this unit.
        metric: a name of `metrics.METRICS`.
        value: the number [unit].
        unit: unit of the number.
    """

    scenario: str
    level: str
    method: str
    network_seed: int
    test_seed: int
    limb: str
    joint: str
    metric: str
    value: float
    unit: str


@dataclass(frozen=True)
class Cell:
    """One cell of a table: mean over runs, its interval, and what the paper prints.

    Attributes:
        scenario: what was walked.
        level: uncertainty level of section 5.1.
        method: estimator.
        joint: joint, or the name of a mean over some, such as `avg`.
        seed_count: runs behind the mean, network seeds times test seeds.
        metric: a name of `metrics.METRICS`, or some joined by `+` whose mean it is.
        value: mean over runs [unit]; None where a run is too short for the metric's pushes.
        low: lower end of the interval [unit]; None with a single run.
        high: upper end of the interval [unit]; None with a single run.
        unit: unit of the numbers.
        published: the paper's number [unit]; None where it prints none.
    """

    scenario: str
    level: str
    method: str
    joint: str
    seed_count: int
    metric: str
    value: float | None
    low: float | None
    high: float | None
    unit: str
    published: float | None


def csv_text(header: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    """Return CSV text: numbers with six digits, None as an empty field, lines ending in a newline."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(list(header))
    writer.writerows([_field(value) for value in row] for row in rows)
    return text.getvalue()


def _field(value: Any) -> str:
    """Return a value as a CSV field."""
    if value is None:
        return ""
    return f"{value + 0.0:.6g}" if isinstance(value, float) else str(value)  # + 0.0 drops the sign of -0


def write_rows(path: Path, kind: type[Row], rows: Iterable[Row]) -> None:
    """Write dataclass rows as CSV, atomically, one column a field."""
    names = [field.name for field in fields(kind)]  # type: ignore[arg-type]
    write_text(path, csv_text(names, ([getattr(row, name) for name in names] for row in rows)))


def read_rows(path: Path, kind: type[Row]) -> list[Row]:
    """Read dataclass rows from CSV.

    Raises:
        DataError: the file is missing, a column is missing or a field is not a number where one is due.
    """
    hints = get_type_hints(kind)
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise DataError(f"{path}: file is missing") from None
    reader = csv.DictReader(io.StringIO(text))
    missing = [name for name in hints if name not in (reader.fieldnames or ())]
    if missing:
        raise DataError(f"{path}: column {missing[0]!r} is missing; it holds {', '.join(reader.fieldnames or ())}")
    return [
        kind(**{name: _parse(row[name], hint, f"{path}:{line}: {name}") for name, hint in hints.items()})
        for line, row in enumerate(reader, start=2)
    ]


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
