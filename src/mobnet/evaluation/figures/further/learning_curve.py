"""The learning curve: error on the development walks over the length of the training, by recipe."""

from collections.abc import Callable, Sequence
from dataclasses import astuple
from pathlib import Path

import numpy as np

from mobnet.core.columns import TRIALS, TrialError
from mobnet.core.rows import read_rows
from mobnet.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from mobnet.evaluation.figures.style import save_figure
from mobnet.evaluation.measure.estimates.scores import AVERAGE
from mobnet.evaluation.number.single import extremes
from mobnet.settings.evaluation import LearningCurve

MILLION = 1e6
AXES: dict[str, Callable[[TrialError], float | None]] = {  # label -> place of a training on it
    "time steps learned from [million]": lambda row: row.steps and row.steps / MILLION,
    "processor time [s]": lambda row: row.seconds,
}


def learning_curve(settings: LearningCurve, kept: Path, figure_dir: Path) -> None:
    """Write the figure as PDF, PNG and CSV: RMSE [N m], the mean over the limb's joints, over steps and over time.

    `kept` is the table that `./reproduce lengths` made. A training that diverged has no place.
    """
    rows = [row for row in read_rows(kept, TrialError) if row.joint == AVERAGE and row.recipe and not row.state]
    tasks = {task: [row for row in rows if row.task == task] for task in dict.fromkeys(row.task for row in rows)}
    panels = [
        LinePanel(settings.titles[task], label, "RMSE [N m]", curves_of(own, place), sizes=True)
        for label, place in AXES.items()
        for task, own in tasks.items()
    ]
    figure = draw_lines(panels, columns=len(tasks))
    save_figure(figure, figure_dir / "learning_curve", TRIALS, [astuple(row) for row in rows])


def curves_of(rows: Sequence[TrialError], place: Callable[[TrialError], float | None]) -> list[Line]:
    """Return the errors of each method by each recipe: over the mean place of the networks of a length."""
    found: dict[str, dict[str, list[TrialError]]] = {}
    for row in sorted(rows, key=lambda row: row.steps or 0):
        found.setdefault(f"{row.method}, {row.recipe}", {}).setdefault(row.tried, []).append(row)
    return [_line(label, list(lengths.values()), place) for label, lengths in found.items()]


def _line(label: str, lengths: Sequence[Sequence[TrialError]], place: Callable[[TrialError], float | None]) -> Line:
    """Return a line: the mean over the networks of each length, the smallest and the largest."""
    places = [float(np.mean([place(row) or 0.0 for row in rows])) for rows in lengths]
    return Line(label, places, [extremes(np.array([row.rmse_nm for row in rows])[:, None])[0] for rows in lengths])
