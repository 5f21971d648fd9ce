"""Trainings of one size of the network or of the data: loss, error, and its ratio to that of the printed size."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from experiments.evaluation.measure.learning.trainings import TrainedNetwork, read_trainings, sound
from experiments.evaluation.number.intervals import RATIO, RunGrid, summarise
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.single import extremes
from experiments.plan.runs import SweptSize
from experiments.settings.runs import Statistics

SAMPLES = "samples"  # panel of the sizes of the data; the largest of them is all data, by a network of the printed size


@dataclass(frozen=True)
class Size:
    """One size in Figure 20, of trainings that did not diverge; a panel varies their `parameters` or `samples`.

    Validation loss (22) and root-mean-square error [N m], the mean over joints, are those of the epoch kept on held-out
    data: mean, lowest and highest run. The loss is of z-scored targets, the error is not. `ratio` is the error over
    that of the printed size that learned from all data [-].
    """

    panel: str
    base: str
    training: TrainedNetwork
    loss: Number
    rmse: Number
    ratio: Number

    @property
    def place(self) -> int:
        """What varies: trained parameters, or samples learned from."""
        return getattr(self.training, self.panel)

    def record(self) -> tuple[str | float | None, ...]:
        """Return the row of figure_20.csv."""
        of = self.training.method, self.training.parameters, self.training.samples
        measured = (*self.loss.with_ends, *self.rmse.with_ends, *self.ratio.with_ends)
        return (self.panel, self.base, *of, self.loss.runs, *measured)


def sizes_of(sweeps: Sequence[SweptSize], statistics: Statistics) -> list[Size]:
    """Return the sizes of all panels and bases, each panel's from small to large; none where all trainings diverged."""
    kept: list[tuple[SweptSize, list[TrainedNetwork]]] = []
    for swept in sweeps:
        for trainings in read_trainings(swept.folders).values():
            if found := sound(trainings):
                kept.append((swept, found))
    largest = {swept.base: found for swept, found in sorted(kept, key=_samples) if swept.panel == SAMPLES}
    sizes = [_size_of(swept, found, largest.get(swept.base, ()), statistics) for swept, found in kept]
    return sorted(sizes, key=lambda size: size.place)


def _samples(one: tuple[SweptSize, Sequence[TrainedNetwork]]) -> int:
    return one[1][0].samples


def _size_of(
    swept: SweptSize, trainings: Sequence[TrainedNetwork], printed: Sequence[TrainedNetwork], statistics: Statistics
) -> Size:
    """Return one size from its runs and those of the printed size, if there are any."""
    kept = np.array([(one.kept.validation_loss, one.kept.validation_rmse) for one in trainings])
    loss, rmse = extremes(kept)
    ratio = Number(None)
    if printed:
        ratio = summarise([_errors(trainings), _errors(printed)], statistics, RATIO)
    return Size(swept.panel, swept.base, trainings[0], loss, rmse, ratio)


def _errors(trainings: Sequence[TrainedNetwork]) -> RunGrid:
    """Return the errors of trainings on held-out data, (n, 1) [N m]: networks of one method on one walk."""
    return RunGrid(np.array([[one.kept.validation_rmse] for one in trainings]), trainings[0].method)
