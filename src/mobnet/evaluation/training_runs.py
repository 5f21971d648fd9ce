"""Trainings as their files tell them: numbers of the curves from metrics.csv, everything else from run.json."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import astuple, dataclass
from pathlib import Path
from typing import Any

from mobnet.core.errors import DataError
from mobnet.core.files import read_json
from mobnet.evaluation.rows import read_rows

SETTINGS = ("target", "settings", "fingerprint", "provenance")  # keys of run.json that say what was trained on what
# Keys of run.json that are shown as they are
TOLD = ("name", "method", "limb", "seed", "parameters", "samples", "seconds", "device", "precision")
ENDED, DIVERGED = "done", "diverged"


@dataclass(frozen=True)
class Epoch:
    """One line of metrics.csv.

    Attributes:
        epoch: its number, from 1.
        train_loss: loss (22) on the training blocks [-].
        validation_loss: loss (22) on the validation blocks [-].
        validation_rmse: mean over the network's joints [N m], of the base's forces [N].
        rate: learning rate [-].
    """

    epoch: int
    train_loss: float
    validation_loss: float
    validation_rmse: float
    rate: float


@dataclass(frozen=True)
class TrainingRun:
    """One training.

    Attributes:
        name: method, limb and seed, such as `MOB-Net-LL-s0`.
        method: row of the configuration's methods.
        limb: row of its networks.
        seed: number of the repetition.
        cell: kind of network.
        parameters: number of weights.
        samples: samples learned from.
        seconds: compute time [s].
        device: `cpu` or `cuda`.
        precision: number format of the products.
        state: `done` or `diverged`.
        curves: finished epochs.
        settings: what was trained on what, dotted name -> text.
        metrics: file that holds the curves.
    """

    name: str
    method: str
    limb: str
    seed: int
    cell: str
    parameters: int
    samples: int
    seconds: float
    device: str
    precision: str
    state: str
    curves: Sequence[Epoch]
    settings: Mapping[str, str]
    metrics: Path

    @property
    def epochs(self) -> int:
        """Number of finished epochs."""
        return len(self.curves)

    @property
    def best(self) -> Epoch | None:
        """The epoch of the smallest validation loss, whose weights are kept; None without a finished epoch."""
        return min(self.curves, key=lambda row: row.validation_loss, default=None)

    @property
    def best_epoch(self) -> int | None:
        """Number of the best epoch."""
        return self.best.epoch if self.best else None

    @property
    def loss(self) -> float | None:
        """Validation loss (22) at the best epoch [-]."""
        return self.best.validation_loss if self.best else None

    @property
    def rmse(self) -> float | None:
        """RMSE on the validation blocks at the best epoch [N m]."""
        return self.best.validation_rmse if self.best else None


def read_training_run(note: Path, metrics: Path) -> TrainingRun:
    """Read a training's `run.json` and `metrics.csv`.

    Raises:
        DataError: a file is missing or damaged, or lacks a key or a column.
    """
    told = read_json(note)
    try:
        return TrainingRun(
            **{key: told[key] for key in TOLD},
            cell=told["settings"]["network"]["cell"],
            state=DIVERGED if told["diverged"] else ENDED,
            curves=read_curves(metrics),
            settings=dict(pair for key in SETTINGS for pair in flattened(key, told[key])),
            metrics=metrics,
        )
    except KeyError as error:
        raise DataError(f"{note}: key {error} is missing; it holds {', '.join(told)}") from None


def read_curves(metrics: Path) -> list[Epoch]:
    """Read a training's finished epochs.

    Raises:
        DataError: the file is missing or damaged, or a number is not finite.
    """
    curves = read_rows(metrics, Epoch)
    for row in curves:
        if not all(map(math.isfinite, astuple(row))):
            raise DataError(f"{metrics}: {row} is not finite; a training stops before it writes such an epoch")
    return curves


def flattened(name: str, value: Any) -> Iterator[tuple[str, str]]:
    """Yield a nested value as pairs of a dotted name and text."""
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from flattened(f"{name}.{key}", inner)
    elif isinstance(value, Sequence) and not isinstance(value, str):
        yield name, ", ".join(map(str, value))
    else:
        yield name, str(value)
