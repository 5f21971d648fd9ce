"""Trainings as they were written: sizes from run.json, losses from metrics.csv."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from mobnet.core.columns import Epoch
from mobnet.core.errors import DataError
from mobnet.core.files import METRICS, RUN, read_json
from mobnet.evaluation.number.files import read_rows

MEASURES: Mapping[str, tuple[Callable[[Training], float], str]] = {  # name -> (of a training, unit)
    "validation loss": (lambda training: training.kept.validation_loss, "-"),
    "validation RMSE": (lambda training: training.kept.validation_rmse, "N m"),
    "validation loss on windows": (lambda training: training.windows_loss, "-"),
    "training loss at the end": (lambda training: training.last.train_loss, "-"),
    "validation loss at the end": (lambda training: training.last.validation_loss, "-"),
}


@dataclass(frozen=True)
class Training:
    """One trained network, with its parameters (column `Network Size` of Table 1).

    The samples are those learned from, without those held out. A training that diverged was stopped as its loss grew;
    its epochs end there. The validation loss (22) on windows is that of the epoch kept where the network runs through a
    window from a zero state for every sample; all other losses are of a state that is carried on.
    """

    method: str
    seed: int
    parameters: int
    samples: int
    diverged: bool
    windows_loss: float
    epochs: tuple[Epoch, ...]

    @property
    def last(self) -> Epoch:
        """The last epoch."""
        return self.epochs[-1]

    @property
    def kept(self) -> Epoch:
        """The epoch that validated best, whose weights are kept."""
        return min(self.epochs, key=lambda epoch: epoch.validation_loss)


def read_training(folder: Path) -> Training:
    """Read a network's folder.

    Raises:
        DataError: a file is missing or damaged, or a training that did not diverge has no epoch.
    """
    note, epochs = read_json(folder / RUN), tuple(read_rows(folder / METRICS, Epoch))
    diverged = bool(note.get("diverged", False))
    if not epochs and not diverged:
        raise DataError(f"{folder / METRICS}: no epoch, though {RUN} does not say that the training diverged")
    return Training(
        note["method"], note["seed"], note["parameters"], note["samples"], diverged,
        note["on_windows"]["loss"], epochs,
    )  # fmt: skip


def read_trainings(folders: Iterable[Path]) -> dict[str, list[Training]]:
    """Return method -> its trainings, in the order given."""
    found: dict[str, list[Training]] = {}
    for folder in folders:
        training = read_training(folder)
        found.setdefault(training.method, []).append(training)
    return found


def sound(trainings: Sequence[Training]) -> list[Training]:
    """Return the trainings that did not diverge."""
    return [training for training in trainings if not training.diverged]
