"""CSV files in tests: rows as objects whose fields are numbers where they can be, None where they are empty.

After a change that is meant to move golden files, run the tests with `UPDATE_GOLDEN=1` once and read the diff.
"""

import csv
import os
import re
from collections.abc import Sequence
from dataclasses import astuple, fields
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from experiments.evaluation.number.rows import write_csv
from experiments.records.scores import Score

GOLDEN = Path(__file__).parent / "golden"


def write_rows(path: Path, rows: Sequence[Any], kind: type[Any] = Score) -> None:
    write_csv(path, [field.name for field in fields(kind)], [astuple(row) for row in rows])


def read_table(path: Path) -> list[SimpleNamespace]:
    with path.open(newline="", encoding="utf-8") as file:
        return [SimpleNamespace(**{name: _value(text) for name, text in row.items()}) for row in csv.DictReader(file)]


def markdown_cells(table: Path) -> list[list[str]]:
    """Return the cells of each line of a table's Markdown, which stands beside its CSV file."""
    lines = table.with_suffix(".md").read_text().splitlines()
    return [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines]


def check_golden(*produced: Path) -> None:
    """Compare files with the golden ones of their names, or make them the golden ones."""
    for path in produced:
        if os.environ.get("UPDATE_GOLDEN"):
            (GOLDEN / path.name).write_text(path.read_text())
        now, before = path.read_text(), (GOLDEN / path.name).read_text()
        assert _without_noise(now) == _without_noise(before)


def check_golden_table(table: Path) -> None:
    """Compare the three files of a table with the golden ones: all numbers, and what a reader sees."""
    check_golden(*(table.with_suffix(ending) for ending in (".csv", ".md", ".tex")))


def _without_noise(text: str) -> str:
    """Return a text with 0 for numbers below 1e-5: differences of equal ones, which each processor rounds its way."""
    return re.sub(r"(?<=,)-?\d(\.\d+)?e-(0[6-9]|[1-9]\d)(?=,|\n)", "0", text)


def _value(text: str) -> str | float | None:
    try:
        return float(text) if text else None
    except ValueError:
        return text
