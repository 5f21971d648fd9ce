"""metrics.csv."""

from __future__ import annotations

import csv
from pathlib import Path

from mobnet.learning.tracking import COLUMNS, write_metrics

ROWS = [{name: float(10 * epoch + i) for i, name in enumerate(COLUMNS)} | {"epoch": epoch} for epoch in (1, 2, 3)]


def test_metrics_come_back_as_written(tmp_path: Path) -> None:
    """Writing and reading are a round trip."""
    write_metrics(tmp_path / "metrics.csv", ROWS)
    with (tmp_path / "metrics.csv").open() as file:
        read = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    assert read == ROWS
