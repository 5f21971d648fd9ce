"""Figure 17: training and validation loss over the epochs by kind of network."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from mobnet.core.columns import LOSSES
from mobnet.core.errors import DataError
from mobnet.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from mobnet.evaluation.figures.style import save_figure
from mobnet.evaluation.measure.learning.trainings import TrainedNetwork, read_trainings, sound
from mobnet.evaluation.number.single import extremes

MEASURES = {"train_loss": "training loss", "validation_loss": "validation loss"}


def figure_17(folders: Sequence[Path], figure_dir: Path) -> None:
    """Write Figure 17, mean of (22) over the runs of each kind of network, as PDF, PNG and CSV.

    Trainings that diverged are left out.
    """
    kinds = {method: sound(trainings) for method, trainings in read_trainings(folders).items()}
    panels, rows = [], []
    for field, name in MEASURES.items():
        lines = [curve(method, trainings, field) for method, trainings in kinds.items() if trainings]
        panels.append(LinePanel(name.removesuffix(" loss"), "epoch", f"{name} [-]", lines))
        for line in lines:
            points = zip(line.x, line.numbers, strict=True)
            rows += [(name, line.label, number.runs, epoch, *number.with_ends) for epoch, number in points]
    save_figure(draw_lines(panels), figure_dir / "figure_17", LOSSES, rows)


def curve(label: str, trainings: Sequence[TrainedNetwork], field: str) -> Line:
    """Return a number of every epoch, the field of `columns.Epoch`: mean, lowest and highest of some runs.

    Raises:
        DataError: the runs have different numbers of epochs.
    """
    counts = {len(training.epochs) for training in trainings}
    if len(counts) != 1:
        raise DataError(f"{label}: runs of {', '.join(map(str, sorted(counts)))} epochs do not make one curve")
    values = np.array([[getattr(epoch, field) for epoch in training.epochs] for training in trainings])
    return Line(label, [epoch.epoch for epoch in trainings[0].epochs], extremes(values))
