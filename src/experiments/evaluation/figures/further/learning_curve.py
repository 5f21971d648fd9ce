"""The learning curve: error on the development walks over the processor time of the training, by recipe."""

from collections.abc import Mapping, Sequence
from dataclasses import astuple
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from experiments.evaluation.figures.style import LOOKS, Look, beside, entitle, legend, looks, save_figure
from experiments.evaluation.measure.estimates.scores import AVERAGE
from experiments.evaluation.number.number import number_text
from experiments.records.trial_errors import TRIALS, TrialError
from experiments.settings.figures import LearningCurve
from mobnet.core.rows import read_rows
from mobnet.core.style import STYLE, styled

MILLION = 1e6
HEIGHT_INCH = 2.0
NOTE: Mapping[str, Any] = {"fontsize": STYLE["legend.fontsize"], "textcoords": "offset points"}
SECONDS = (10, 20, 50, 100, 200, 500)  # that an axis names, where it has them
ERRORS = (0.5, 1, 1.5, 2, 3, 4, 6, 10, 15, 20, 30)
ROOM = 1.5  # on each side of all that is drawn [share of a value]
NEAR = 3.0  # an error so many times the largest one of the networks is no line, but a note
Curve = dict[float, list[TrialError]]  # time steps learned from -> the networks that did


def learning_curve(settings: LearningCurve, kept: Path, figure_dir: Path) -> None:
    """Write the figure as PDF, PNG and CSV: RMSE [N m], the mean over the limb's joints, over processor time [s].

    `kept` is the table that `./reproduce lengths` made. A training that diverged has no place.
    """
    rows = [row for row in read_rows(kept, TrialError) if row.joint == AVERAGE and not row.state]
    tasks: dict[str, list[TrialError]] = {}
    for row in rows:
        tasks.setdefault(row.task, []).append(row)
    figure = draw_learning(settings, tasks)
    save_figure(figure, figure_dir / "learning_curve", TRIALS, [astuple(row) for row in rows])


def curves_of(settings: LearningCurve, rows: Sequence[TrialError]) -> dict[str, Curve]:
    """Return recipe, as the legend calls it -> its trainings by length, the shortest first."""
    curves: dict[str, Curve] = {}
    for row in sorted((row for row in rows if row.recipe), key=lambda row: row.steps or 0):
        label = f"{row.method}, {settings.recipes.get(row.recipe, row.recipe)}"
        curves.setdefault(label, {}).setdefault(row.steps or 0.0, []).append(row)
    return curves


@styled
def draw_learning(settings: LearningCurve, tasks: Mapping[str, Sequence[TrialError]]) -> Figure:
    """Draw a panel for each task: every training by processor time [s], and errors of methods that do not learn."""
    figure, axes = beside(len(tasks), HEIGHT_INCH)
    curves = {task: curves_of(settings, rows) for task, rows in tasks.items()}
    labels: list[str] = []
    for of_task in curves.values():
        labels += of_task
    styles = looks(labels)
    for k, (axis, (task, rows)) in enumerate(zip(axes, tasks.items(), strict=True)):
        for label, curve in curves[task].items():
            _draw(axis, label, curve, styles[label])
        lines, far = beside_of(settings, rows)
        for row in lines:
            _line(axis, settings.beside[row.method], row)
        note = [f"{settings.beside[row.method]}: {number_text(row.rmse_nm)} N m" for row in far]
        axis.annotate("\n".join(note), (0.03, 0.04), (0.0, 0.0), xycoords="axes fraction", va="bottom", **NOTE)
        _scale(axis, [row for row in rows if row.recipe], lines)
        entitle(axis, k, settings.titles[task])
    axes[0].set_ylabel("RMSE [N m]")
    legend(figure, axes)
    return figure


def beside_of(settings: LearningCurve, rows: Sequence[TrialError]) -> tuple[list[TrialError], list[TrialError]]:
    """Return the errors of methods that do not learn: those near the networks', and those far above them.

    An error of zero, where nothing pushes, is none of them.
    """
    most = max((row.rmse_nm for row in rows if row.recipe), default=0.0)
    known = [row for row in rows if row.method in settings.beside and row.rmse_nm > 0.0]
    near = [row for row in known if row.rmse_nm <= NEAR * most]
    return near, [row for row in known if row not in near]


def _draw(axis: Axes, label: str, curve: Curve, look: Look) -> None:
    """Draw every training of a recipe, a line through the means, and beside them the time steps [million]."""
    seconds: list[float] = []
    means: list[float] = []
    for steps, rows in curve.items():
        times = [row.seconds or 0.0 for row in rows]
        errors = [row.rmse_nm for row in rows]
        axis.plot(times, errors, look.marker, markersize=3.5, color=look.colour, markeredgewidth=0.0, alpha=0.6)
        seconds.append(float(np.mean(times)))
        means.append(float(np.mean(errors)))
        axis.annotate(f"{steps / MILLION:g} M", (max(times), max(errors)), (3.0, 0.0), color=look.colour, **NOTE)
    # Each training has a mark, so that the line needs none but in the legend.
    axis.plot(seconds, means, label=label, marker=look.marker, markersize=3.5, markevery=[], **look.line)


def _line(axis: Axes, name: str, row: TrialError) -> None:
    """Draw the error of a method that does not learn as a line across the panel, named at its right end."""
    look = LOOKS[row.method]
    axis.axhline(row.rmse_nm, color=look.colour, linestyle=look.dash, linewidth=1.0, zorder=1.0)
    at = (0.99, row.rmse_nm)
    across = axis.get_yaxis_transform()
    axis.annotate(f"{name}: {number_text(row.rmse_nm)} N m", at, (0.0, 2.0), xycoords=across, ha="right", **NOTE)


def _scale(axis: Axes, trained: Sequence[TrialError], lines: Sequence[TrialError]) -> None:
    """Let both logarithmic axes end beyond all that is drawn, and name places on them in plain numbers."""
    axis.set(xscale="log", yscale="log", xlabel="processor time of a training [s]")
    axis.minorticks_off()
    times = [row.seconds for row in trained if row.seconds]
    errors = [row.rmse_nm for row in (*trained, *lines)]
    for side, values, places in ((axis.xaxis, times, SECONDS), (axis.yaxis, errors, ERRORS)):
        low = min(values, default=1.0) / ROOM
        high = max(values, default=1.0) * ROOM
        named = [place for place in places if low <= place <= high]
        side.set_ticks(named, [f"{place:g}" for place in named])
        side.axes.set(**{f"{side.axis_name}lim": (low, high)})
