"""The learning curve: error on the development walks over the length of the training, by recipe."""

from collections.abc import Callable, Sequence
from dataclasses import astuple
from pathlib import Path

import numpy as np

from experiments.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from experiments.evaluation.figures.style import save_figure
from experiments.evaluation.measure.estimates.scores import AVERAGE
from experiments.evaluation.number.number import Number, number_text
from experiments.settings.figures import LearningCurve
from mobnet.core.columns import TRIALS, TrialError
from mobnet.core.rows import read_rows

MILLION = 1e6
PANEL_INCH = 1.7
Y_LABEL = "RMSE [N m]"
AXES: dict[str, Callable[[TrialError], float | None]] = {  # label -> place of a training on it
    "time steps learned from [million]": lambda row: row.steps and row.steps / MILLION,
    "processor time [s]": lambda row: row.seconds,
}


def learning_curve(settings: LearningCurve, kept: Path, figure_dir: Path) -> None:
    """Write the figure as PDF, PNG and CSV: RMSE [N m], the mean over the limb's joints, over steps and over time.

    `kept` is the table that `./reproduce lengths` made. A training that diverged has no place.
    """
    rows = [row for row in read_rows(kept, TrialError) if row.joint == AVERAGE and not row.state]
    tasks: dict[str, list[TrialError]] = {}
    for row in rows:
        tasks.setdefault(row.task, []).append(row)
    panels: list[LinePanel] = []
    for label, place in AXES.items():
        for task, own in tasks.items():
            curves = curves_of(settings, own, place)
            note = beside(settings, own)
            title = settings.titles[task]
            panels.append(LinePanel(title, label, Y_LABEL, curves, scale=task, note=note, note_below=True))
    figure = draw_lines(panels, len(tasks), PANEL_INCH)
    save_figure(figure, figure_dir / "learning_curve", TRIALS, [astuple(row) for row in rows])


def curves_of(
    settings: LearningCurve, rows: Sequence[TrialError], place: Callable[[TrialError], float | None]
) -> list[Line]:
    """Return the errors of each method by each recipe: over the mean place of the networks of a length."""
    found: dict[str, dict[str, list[TrialError]]] = {}
    for row in sorted((row for row in rows if row.recipe), key=lambda row: row.steps or 0):
        label = f"{row.method}, {settings.recipes.get(row.recipe, row.recipe)}"
        found.setdefault(label, {}).setdefault(row.tried, []).append(row)
    return [_line(label, list(lengths.values()), place) for label, lengths in found.items()]


def _line(label: str, lengths: Sequence[Sequence[TrialError]], place: Callable[[TrialError], float | None]) -> Line:
    """Return a line: the mean over the networks of each length, and each of them."""
    places: list[float] = []
    dots: list[list[float]] = []
    for rows in lengths:
        places.append(float(np.mean([place(row) or 0.0 for row in rows])))
        dots.append([row.rmse_nm for row in rows])
    return Line(label, places, [Number(float(np.mean(own))) for own in dots], dots)


def beside(settings: LearningCurve, rows: Sequence[TrialError]) -> str:
    """Return the errors of methods that do not learn, a line each; none for an error of zero where nothing pushes."""
    errors = {row.method: row.rmse_nm for row in rows if row.method in settings.beside and row.rmse_nm > 0.0}
    return "\n".join(f"{settings.beside[method]}: {number_text(error)} N m" for method, error in errors.items())
