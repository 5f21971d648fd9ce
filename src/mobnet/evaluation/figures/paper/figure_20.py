"""Figure 20: validation loss by size of the network and of the training data."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mobnet.core.columns import SIZES
from mobnet.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from mobnet.evaluation.figures.style import save_figure
from mobnet.evaluation.measure.learning.trainings import TrainedNetwork, read_trainings, sound
from mobnet.evaluation.number.number import Number
from mobnet.evaluation.number.single import extremes
from mobnet.plan.runs import SweptSize

TITLES = {"parameters": "size of the network", "samples": "size of the training data"}
X_LABELS = {"parameters": "parameters [thousand]", "samples": "samples learned from [thousand]"}
THOUSAND = 1e3


@dataclass(frozen=True)
class Size:
    """One place of Figure 20, of trainings that did not diverge; a panel shows what varies, `parameters` or `samples`.

    Validation loss (22) and root-mean-square error [N m], the mean over joints, are those of the epoch kept on held-out
    data: mean, lowest and highest run. The loss is of z-scored targets, the error is not.
    """

    panel: str
    base: str
    training: TrainedNetwork
    loss: Number
    rmse: Number

    @property
    def place(self) -> int:
        """What varies: trained parameters, or samples learned from."""
        return getattr(self.training, self.panel)

    def record(self) -> tuple[str | float | None, ...]:
        """Return the row of figure_20.csv."""
        of = self.training.method, self.training.parameters, self.training.samples
        return (self.panel, self.base, *of, self.loss.runs, *self.loss.with_ends, *self.rmse.with_ends)


def figure_20(sizes_of_networks: Sequence[SweptSize], figure_dir: Path) -> None:
    """Write Figure 20, validation loss over parameters (a) and training samples (b), as PDF, PNG and CSV."""
    sizes = sorted((size for swept in sizes_of_networks for size in sizes_of(swept)), key=lambda size: size.place)
    panels = []
    for panel, title in TITLES.items():
        bases = dict.fromkeys(swept.base for swept in sizes_of_networks if swept.panel == panel)
        own = {base: [size for size in sizes if (size.panel, size.base) == (panel, base)] for base in bases}
        lines = [growth_line(found, base) for base, found in own.items() if found]
        panels.append(LinePanel(title, X_LABELS[panel], "validation loss [-]", lines, sizes=True))
    save_figure(draw_lines(panels), figure_dir / "figure_20", SIZES, [size.record() for size in sizes])


def sizes_of(swept: SweptSize) -> list[Size]:
    """Return the place of a variation in its panel; none where all its trainings diverged."""
    found = [sound(trainings) for trainings in read_trainings(swept.folders).values()]
    return [size_of(swept.panel, swept.base, kept) for kept in found if kept]


def size_of(panel: str, base: str, trainings: Sequence[TrainedNetwork]) -> Size:
    """Return one place of the figure, loss and RMSE [N m], from its runs."""
    kept = [training.kept for training in trainings]
    loss, rmse = extremes(np.array([(epoch.validation_loss, epoch.validation_rmse) for epoch in kept]))
    return Size(panel, base, trainings[0], loss, rmse)


def growth_line(own: Sequence[Size], base: str) -> Line:
    """Return the losses (n,) of an estimator's variations over the size that their panel varies."""
    return Line(base, [size.place / THOUSAND for size in own], [size.loss for size in own])
