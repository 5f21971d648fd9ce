"""What a training run leaves to look at: metrics.csv, which is the truth."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path

from mobnet.core.files import write_text
from mobnet.learning.checkpoint import Row

METRICS = "metrics.csv"
COLUMNS = ("epoch", "train_loss", "validation_loss", "validation_rmse", "rate", "gradient_norm")


def write_metrics(path: Path, rows: Sequence[Row]) -> None:
    """Write one line per epoch: losses of (22) unitless, RMSE [N, N m], rate and gradient norm [-]; atomic."""
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows({name: row[name] for name in COLUMNS} for row in rows)
    write_text(path, text.getvalue())
