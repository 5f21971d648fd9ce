"""metrics.csv."""

import csv
from pathlib import Path

from mobnet.core.columns import Epoch
from mobnet.learning.tracking import METRICS, write_metrics

EPOCHS = [Epoch(number, *(10.0 * number + k for k in range(5))) for number in (1, 2, 3)]


def test_metrics_come_back_as_written(tmp_path: Path) -> None:
    """Writing and reading are a round trip."""
    write_metrics(tmp_path / METRICS, EPOCHS)
    with (tmp_path / METRICS).open() as file:
        read = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    assert read == [vars(epoch) for epoch in EPOCHS]
