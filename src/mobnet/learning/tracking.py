"""metrics.csv, the course of a training."""

import csv
import io
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from mobnet.core.columns import EPOCHS, Epoch
from mobnet.core.files import write_text

METRICS = "metrics.csv"


def write_metrics(path: Path, epochs: Sequence[Epoch]) -> None:
    """Write one line for each epoch; atomic."""
    text = io.StringIO()
    writer = csv.DictWriter(text, EPOCHS, lineterminator="\n")
    writer.writeheader()
    writer.writerows(asdict(epoch) for epoch in epochs)
    write_text(path, text.getvalue())
