"""The learning curve: error on the development walks over the number of time steps that networks learned from."""

from dataclasses import astuple
from pathlib import Path

import numpy as np

from mobnet.core.columns import TRIALS, TrialError
from mobnet.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from mobnet.evaluation.figures.style import save_figure
from mobnet.evaluation.number.files import read_rows
from mobnet.evaluation.number.single import extremes
from mobnet.settings.evaluation import LearningCurve

MILLION = 1e6


def learning_curve(settings: LearningCurve, kept: Path, figure_dir: Path) -> None:
    """Write the figure as PDF, PNG and CSV: RMSE [N m], the mean over the limb's joints, over steps [million].

    `kept` is the table that `./reproduce lengths` made. Of the rates tried for a length the best is shown; a training
    that diverged has no place.
    """
    rows = [row for row in read_rows(kept, TrialError) if row.joint == settings.joint and row.best and not row.state]
    lines = [curve_of(method, rows) for method in dict.fromkeys(row.method for row in rows)]
    panel = LinePanel("development walks", "time steps learned from [million]", "RMSE [N m]", lines, sizes=True)
    save_figure(draw_lines([panel]), figure_dir / "learning_curve", TRIALS, [astuple(row) for row in rows])


def curve_of(method: str, rows: list[TrialError]) -> Line:
    """Return a method's errors over steps: the mean over networks, the smallest and the largest."""
    own: dict[int, list[float]] = {}
    for row in sorted((row for row in rows if row.method == method), key=lambda row: row.steps or 0):
        own.setdefault(row.steps or 0, []).append(row.rmse_nm)
    numbers = [extremes(np.array(errors)[:, None])[0] for errors in own.values()]
    return Line(method, [steps / MILLION for steps in own], numbers)
