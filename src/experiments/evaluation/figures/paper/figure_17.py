"""Figure 17: loss in training, loss and error in validation by kind of network, by one recipe and by each kind's own.

All have learned from equally many time steps.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from experiments.evaluation.figures.drawing.named_bars import MINUS
from experiments.evaluation.figures.style import Look, entitle, looks, save_figure
from experiments.evaluation.measure.learning.losses import ENDS, losses_of, runs_of
from experiments.evaluation.measure.learning.trainings import kind_of_each, read_trainings
from experiments.evaluation.number.frames import records_of, rows_of
from experiments.evaluation.number.laws import numbers_by
from experiments.evaluation.number.number import Number
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
    networks, epochs = read_trainings(folders)
    runs = runs_of(networks[~networks["diverged"]], epochs[~epochs["diverged"]])
    losses = losses_of(runs, statistics)
    at_end = losses["at_end"]
    figure = draw_losses(losses[at_end], runs[runs["at_end"]], kind_of_each(settings))
    shown = losses.rename(columns={"value": "mean", "count": "runs"})
    shown["epoch"] = shown["epoch"].astype("Int64").mask(at_end)
    save_figure(figure, figure_dir / "figure_17", LOSSES, records_of(shown, LOSSES))


@styled
def draw_losses(losses: pd.DataFrame, runs: pd.DataFrame, kinds: Mapping[str, str]) -> Figure:
    """Draw a panel for each measure and in it a row for each kind: the mean, its interval, and the single runs.

    Args:
        losses: of methods, losses [-] and errors [N m] at the end, a row for each `measure` and `method`.
        runs: those of single runs.
        kinds: method -> its kind. The method that has the kind's name, the best of it, is drawn hollow below the other.
    """
    rows = list(dict.fromkeys(kinds[method] for method in losses["method"]))
    styles = looks(rows)
    figure = Figure(figsize=(PAGE_INCH, ROW_INCH * max(1, len(rows)) + LABELS_INCH), layout="constrained")
    axes = figure.subplots(1, len(TITLES), sharey=True)
    for k, (axis, measure) in enumerate(zip(axes, dict.fromkeys(ENDS.values()), strict=True)):
        for method, number in numbers_by(rows_of(losses, measure=measure), "method").items():
            kind = kinds[method]
            is_best = method == kind
            row = rows.index(kind) + (APART if is_best else -APART)
            single = rows_of(runs, measure=measure, method=method)["value"].tolist()
            _draw(axis, row, number, single, styles[kind], hollow=is_best)
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


def _draw(axis: Axes, row: float, number: Number, runs: Sequence[float], look: Look, *, hollow: bool) -> None:
    """Draw a loss [-] or an error [N m] at its place with its number."""
    value, low, high = np.array(number.range, dtype=np.float64)
    axis.plot([low, high], [row, row], color=look.colour, linewidth=1.6, solid_capstyle="butt")
    axis.plot(runs, [row] * len(runs), color=look.colour, **STROKE)
    filling = "white" if hollow else look.colour
    axis.plot([value], [row], marker=look.marker, color=look.colour, markerfacecolor=filling, **MARK)
    axis.annotate(
        number.text().replace("-", MINUS),
        (max(high, *runs), row),
        (6.0, 0.0),
        textcoords="offset points",
        va="center",
        fontsize=NUMBER_POINTS,
    )
