"""Losses and errors of kinds of networks: epoch by epoch, and where a training ends, with intervals over its runs."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from experiments.evaluation.measure.learning.trainings import MEASURES, TrainedNetwork
from experiments.evaluation.number.intervals import RunGrid, summarise
from experiments.evaluation.number.number import Number
from experiments.settings.runs import Statistics
from mobnet.core.errors import DataError

COURSES = {  # fields of `columns.Epoch` -> measure
    "train_loss": "training loss",
    "validation_loss": "validation loss",
    "validation_rmse": "validation RMSE",
}
ENDS = {  # of MEASURES -> its course
    "training loss at the end": "training loss",
    "validation loss": "validation loss",
    "validation RMSE": "validation RMSE",
}


@dataclass(frozen=True)
class Loss:
    """A loss (22) [-] or an RMSE [N m] of a kind of network, the mean over its runs: of an epoch, or None for the end.

    At the end it is the training loss of the last epoch, or that in validation of the epoch kept. `stride` is the
    distance between two time steps of the epoch [samples]: losses at unlike strides are those of unlike tasks. `runs`
    are the numbers of the single runs, `unit` is theirs.
    """

    measure: str
    method: str
    epoch: int | None
    stride: int
    number: Number
    runs: tuple[float, ...]

    def record(self) -> tuple[str | float | None, ...]:
        """Return the row of figure_17.csv."""
        own = self.measure, self.method, len(self.runs), self.epoch, self.stride
        return *own, *self.number.with_ends, self.number.unit


def losses_of(method: str, trainings: Sequence[TrainedNetwork], statistics: Statistics) -> Iterator[Loss]:
    """Yield the losses and errors of every epoch of a kind's runs, which did not diverge, and those of their end.

    Raises:
        DataError: the runs have different numbers of epochs.
    """
    counts = {len(training.epochs) for training in trainings}
    if len(counts) != 1:
        raise DataError(f"{method}: runs of {', '.join(map(str, sorted(counts)))} epochs do not make one curve")
    for field, measure in COURSES.items():
        for k, epoch in enumerate(trainings[0].epochs):
            values = [float(getattr(training.epochs[k], field)) for training in trainings]
            yield _loss(measure, method, epoch.epoch, epoch.stride, values, statistics)
    for name, measure in ENDS.items():
        values = [MEASURES[name][0](training) for training in trainings]
        yield _loss(measure, method, None, trainings[0].kept.stride, values, statistics)


def _loss(
    measure: str, method: str, epoch: int | None, stride: int, values: Sequence[float], statistics: Statistics
) -> Loss:
    """Return a loss [-] or an error [N m] of some runs (n,)."""
    unit = {ENDS[name]: unit for name, (_, unit) in MEASURES.items() if name in ENDS}[measure]
    number = summarise([RunGrid(np.array(values)[:, None])], statistics, unit=unit)
    return Loss(measure, method, epoch, stride, number, tuple(values))
