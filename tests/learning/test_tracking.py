"""metrics.csv and the offline wandb run."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from mobnet.learning.tracking import COLUMNS, write_metrics, write_wandb

ROWS = [{name: float(10 * epoch + i) for i, name in enumerate(COLUMNS)} | {"epoch": epoch} for epoch in (1, 2, 3)]


def test_metrics_come_back_as_written(tmp_path: Path) -> None:
    """Writing and reading are a round trip."""
    write_metrics(tmp_path / "metrics.csv", ROWS)
    with (tmp_path / "metrics.csv").open() as file:
        read = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    assert read == ROWS


@pytest.mark.slow
def test_an_offline_run_gets_a_name_that_stays(tmp_path: Path) -> None:
    for _ in range(2):
        folder = write_wandb(tmp_path / "wandb", "MOB-Net-LL-s0", {"epochs": 3}, ROWS)
    assert [path.name for path in (tmp_path / "wandb").iterdir()] == ["offline-run-MOB-Net-LL-s0"]
    assert list(folder.glob("*.wandb"))
