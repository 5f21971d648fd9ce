"""Figure 17: loss in training, loss and error in validation by kind of network, by one recipe and by each kind's own.

All have learned from equally many time steps.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from experiments.evaluation.figures.style import Look, entitle, looks, save_figure
from experiments.evaluation.measure.learning.losses import ENDS, Loss, losses_of
from experiments.evaluation.measure.learning.trainings import kind_of_each, read_trainings, sound
from experiments.settings.figures import Figure17
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import LOSSES
from mobnet.core.style import PAGE_INCH, styled

ROW_INCH, LABELS_INCH = 0.3, 0.85  # height of a kind, and of legend, titles and labels
NUMBER_POINTS = 7.0  # size of a number
ROOM = 0.2  # of an axis for numbers at its right [share]
APART = 0.2  # of a recipe from the middle of its kind's row [share of a row]
MARK: Mapping[str, Any] = {"markersize": 4.5, "zorder": 4.0}  # on top of strokes and intervals
STROKE: Mapping[str, Any] = {"marker": "|", "linestyle": "", "markersize": 7.0, "markeredgewidth": 0.7}
TITLES = {"training loss": "training", "validation loss": "validation", "validation RMSE": "validation"}
LABELS = {"training loss": "loss [-]", "validation loss": "loss [-]", "validation RMSE": "RMSE [N m]"}


def figure_17(settings: Figure17, folders: Sequence[Path], statistics: Statistics, figure_dir: Path) -> None:
    """Write Figure 17, losses (22) [-] and errors [N m] of each kind of network, as PDF, PNG and CSV.

    Trainings that diverged are left out. The figure has those at the end, the CSV file those of every epoch too.
    """
    trained = {method: sound(trainings) for method, trainings in read_trainings(folders).items()}
    losses: list[Loss] = []
    for method, runs in trained.items():
        if runs:  # of a method whose trainings all diverged nothing is left
            losses += losses_of(method, runs, statistics)
    figure = draw_losses([loss for loss in losses if loss.epoch is None], kind_of_each(settings))
    save_figure(figure, figure_dir / "figure_17", LOSSES, [loss.record() for loss in losses])


@styled
def draw_losses(losses: Sequence[Loss], kinds: Mapping[str, str]) -> Figure:
    """Draw a panel for each measure and in it a row for each kind: the mean, its interval, and the single runs.

    Args:
        losses: of methods, losses [-] and errors [N m].
        kinds: method -> its kind. The method that has the kind's name, the best of it, is drawn hollow below the other.
    """
    rows = list(dict.fromkeys(kinds[loss.method] for loss in losses))
    styles = looks(rows)
    figure = Figure(figsize=(PAGE_INCH, ROW_INCH * max(1, len(rows)) + LABELS_INCH), layout="constrained")
    axes = figure.subplots(1, len(TITLES), sharey=True)
    for k, (axis, measure) in enumerate(zip(axes, dict.fromkeys(ENDS.values()), strict=True)):
        for loss in (loss for loss in losses if loss.measure == measure):
            kind = kinds[loss.method]
            is_best = loss.method == kinds[loss.method]
            _draw(axis, rows.index(kind) + (APART if is_best else -APART), loss, styles[kind], hollow=is_best)
        axis.set_xlabel(LABELS[measure])
        axis.tick_params(axis="y", length=0.0)
        entitle(axis, k, TITLES[measure])
    axes[1].sharex(axes[0])
    axes[0].autoscale(axis="x")
    for axis in (axes[0], axes[2]):
        first, last = axis.get_xlim()
        axis.set_xlim(first, last + ROOM * (last - first))
    axes[0].set_yticks(range(len(rows)), rows)
    axes[0].set_ylim(len(rows) - 0.5, -0.5)
    _key(figure)
    return figure


def _key(figure: Figure) -> None:
    """Say on top of the figure what filled and hollow marks, lines and strokes are."""
    look = {"color": "0.3", "linestyle": "", "marker": "o", "markersize": MARK["markersize"]}
    handles = [
        Line2D([], [], label="one recipe for all kinds, mean over robots", **look),
        Line2D([], [], label="the kind's best recipe, first robot", markerfacecolor="white", **look),
        Line2D([], [], color="0.3", linewidth=1.6, label="interval"),
        Line2D([], [], color="0.3", label="a robot", **STROKE),
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles), frameon=False, borderpad=0.0)


def _draw(axis: Axes, row: float, loss: Loss, look: Look, *, hollow: bool) -> None:
    """Draw a loss [-] or an error [N m] at its place with its number."""
    value, low, high = np.array(loss.number.range, dtype=np.float64)
    axis.plot([low, high], [row, row], color=look.colour, linewidth=1.6, solid_capstyle="butt")
    axis.plot(loss.runs, [row] * len(loss.runs), color=look.colour, **STROKE)
    filling = "white" if hollow else look.colour
    axis.plot([value], [row], marker=look.marker, color=look.colour, markerfacecolor=filling, **MARK)
    axis.annotate(
        loss.number.text(),
        (max(high, *loss.runs), row),
        (6.0, 0.0),
        textcoords="offset points",
        va="center",
        fontsize=NUMBER_POINTS,
    )
