"""metrics.csv, the course of a training."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from mobnet.core.files import write_text

METRICS = "metrics.csv"


@dataclass(frozen=True)
class Epoch:
    """One epoch of a training: a row of metrics.csv.

    Attributes:
        epoch: counted from 1.
        train_loss: mean of (22) over the training samples.
        validation_loss: mean of (22) over the samples held out.
        validation_rmse: mean over the joints of their root-mean-square errors [N m], V1..V3 [N].
        rate: learning rate.
        gradient_norm: mean norm of the gradient before the clip.
    """

    epoch: int
    train_loss: float
    validation_loss: float
    validation_rmse: float
    rate: float
    gradient_norm: float


def write_metrics(path: Path, epochs: Sequence[Epoch]) -> None:
    """Write one line for each epoch; atomic."""
    text = io.StringIO()
    writer = csv.DictWriter(text, [field.name for field in fields(Epoch)], lineterminator="\n")
    writer.writeheader()
    writer.writerows(asdict(epoch) for epoch in epochs)
    write_text(path, text.getvalue())
