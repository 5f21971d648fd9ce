"""Trainings with everything that their page shows."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mobnet.core.columns import Epoch
from mobnet.core.errors import DataError
from mobnet.core.files import read_json
from mobnet.evaluation.measure.trainings import METRICS, RUN, Training, read_training

SETTINGS = ("target", "settings", "fingerprint", "provenance")  # keys of run.json that say what was trained on what
SHOWN = ("name", "limb", "device", "precision")  # keys that are shown as they are
ENDED, DIVERGED = "done", "diverged"


@dataclass(frozen=True)
class TrainingRun(Training):
    """One training.

    Attributes:
        name: method, limb and seed, such as `MOB-Net-LL-s0`.
        limb: row of the configuration's networks.
        device: `cpu` or `cuda`.
        precision: number format of the products.
        cell: kind of network.
        settings: what was trained on what, dotted name -> text.
        metrics: file that holds the curves.
    """

    name: str
    limb: str
    device: str
    precision: str
    cell: str
    settings: Mapping[str, str]
    metrics: Path

    @property
    def state(self) -> str:
        """How the training ended."""
        return DIVERGED if self.diverged else ENDED

    @property
    def epoch_count(self) -> int:
        """Number of finished epochs."""
        return len(self.epochs)

    @property
    def best(self) -> Epoch | None:
        """The epoch kept; None where the training diverged in its first."""
        return self.kept if self.epochs else None

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


def read_training_run(folder: Path) -> TrainingRun:
    """Read a network's folder.

    Raises:
        DataError: a file is missing or damaged, or lacks a key or a column.
    """
    note = read_json(folder / RUN)
    try:
        return TrainingRun(
            **vars(read_training(folder)),
            **{key: note[key] for key in SHOWN},
            cell=note["settings"]["network"]["cell"],
            settings=dict(pair for key in SETTINGS for pair in flattened(key, note[key])),
            metrics=folder / METRICS,
        )
    except KeyError as error:
        raise DataError(f"{folder / RUN}: key {error} is missing; it holds {', '.join(note)}") from None


def flattened(name: str, value: Any) -> Iterator[tuple[str, str]]:
    """Yield a nested value as pairs of a dotted name and text."""
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from flattened(f"{name}.{key}", inner)
    elif isinstance(value, Sequence) and not isinstance(value, str):
        yield name, ", ".join(map(str, value))
    else:
        yield name, str(value)
