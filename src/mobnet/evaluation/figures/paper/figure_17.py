"""Figure 17: training and validation loss by kind of network, where all have learned from equally many time steps."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mobnet.core.columns import LOSSES
from mobnet.evaluation.figures.style import COLUMN_INCH, Look, entitle, looks, save_figure, styled
from mobnet.evaluation.measure.learning.losses import ENDS, Loss, losses_of
from mobnet.evaluation.measure.learning.trainings import read_trainings, sound
from mobnet.settings.runs import Statistics

ROW_INCH, LABELS_INCH = 0.24, 0.6  # height of a kind, and of titles and labels
NUMBER_POINTS = 6.5  # size of a number
ROOM = 0.18  # of the axis for numbers at its right [share]
TITLES = {"training loss": "training, last epoch", "validation loss": "validation"}


def figure_17(folders: Sequence[Path], statistics: Statistics, figure_dir: Path) -> None:
    """Write Figure 17, losses (22) of each kind of network [-], as PDF, PNG and CSV.

    Trainings that diverged are left out. The figure has the losses at the end, the CSV file those of every epoch too.
    """
    kinds = {method: sound(trainings) for method, trainings in read_trainings(folders).items()}
    losses = [loss for method, runs in kinds.items() if runs for loss in losses_of(method, runs, statistics)]
    figure = draw_losses([loss for loss in losses if loss.epoch is None])
    save_figure(figure, figure_dir / "figure_17", LOSSES, [loss.record() for loss in losses])


@styled
def draw_losses(losses: Sequence[Loss]) -> Figure:
    """Draw a panel for each measure and in it a row for each kind: the mean [-], its interval, and the single runs."""
    kinds = list(dict.fromkeys(loss.method for loss in losses))
    styles = looks(kinds)
    figure = Figure(figsize=(COLUMN_INCH, ROW_INCH * max(1, len(kinds)) + LABELS_INCH), layout="constrained")
    axes = figure.subplots(1, len(TITLES), sharex=True, sharey=True)
    for k, (axis, measure) in enumerate(zip(axes, dict.fromkeys(ENDS.values()), strict=True)):
        for loss in (loss for loss in losses if loss.measure == measure):
            _draw(axis, kinds.index(loss.method), loss, styles[loss.method])
        axis.set_xlabel("loss [-]")
        axis.tick_params(axis="y", length=0.0)
        entitle(axis, k, TITLES[measure])
    first, last = axes[0].get_xlim()
    axes[0].set_xlim(first, last + ROOM * (last - first))
    axes[0].set_yticks(range(len(kinds)), kinds)
    axes[0].set_ylim(len(kinds) - 0.5, -0.5)
    return figure


def _draw(axis: Axes, row: int, loss: Loss, look: Look) -> None:
    """Draw a loss in its row with its number [-]."""
    value, low, high = np.array(loss.number.range, dtype=np.float64)
    axis.plot([low, high], [row, row], color=look.colour, linewidth=1.6, solid_capstyle="butt")
    axis.plot(loss.runs, [row] * len(loss.runs), "|", color=look.colour, markersize=7.0, markeredgewidth=0.7)
    axis.plot([value], [row], marker=look.marker, color=look.colour, markersize=3.2)
    axis.annotate(loss.number.text(), (max(high, *loss.runs), row), (4.0, 0.0), textcoords="offset points",
                  va="center", fontsize=NUMBER_POINTS)  # fmt: skip
