"""Fine-tuning to a changed robot (section 8.2): error over the seconds of new data."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from experiments.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from experiments.evaluation.figures.style import save_figure
from experiments.evaluation.measure.estimates.run_errors import ERROR
from experiments.evaluation.number.frames import read_scores, records_of
from experiments.evaluation.number.laws import numbers_by
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.scored import CELL, numbers_of
from experiments.settings.figures import FineTuning, TunedTest
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import TUNED
from mobnet.settings.methods import swept_name

BEFORE = "not fine-tuned"
KNOWN = "on its own robot"
X_LABEL = "data of the changed robot [s]"
Y_LABEL = "RMSE [N m]"
COLUMNS = 4
PANEL_INCH = 2.0
APART = 0.02  # between two marks at one place [decades]


def fine_tuning(
    settings: FineTuning, seconds: Sequence[int], statistics: Statistics, scores: Sequence[Path], figure_dir: Path
) -> None:
    """Write the figure as PDF, PNG and CSV: RMSE [N m] of networks on changed robots over their new data [s].

    Two bands stand beside them: the networks before, and on the robot that they learned from.
    """
    asked: list[tuple[str | int, ...]] = []
    for title, test in settings.tests.items():
        for line, time, level, method in shown_of(settings, seconds, test):
            asked.append((title, line, time, test.scenario, settings.limb, level, method, settings.joint, ERROR))
    cells = pd.DataFrame(asked, columns=["panel", "line", "seconds", *CELL])
    rows = numbers_of(read_scores(*scores), cells, statistics, may_lack=False)
    panels = [panel_of(str(title), of_panel) for title, of_panel in rows.groupby("panel", sort=False)]
    figure = draw_lines(panels, min(COLUMNS, len(panels)), PANEL_INCH)
    save_figure(figure, figure_dir / "fine_tuning", TUNED, records_of(rows, TUNED))


def panel_of(title: str, rows: pd.DataFrame) -> LinePanel:
    """Return the panel of a test: of each line the error by seconds; those that need none of these are bands."""
    bands: dict[str, Number] = {}
    lines: list[Line] = []
    for line, of_line in rows.groupby("line", sort=False):
        errors = numbers_by(of_line, "seconds")
        if line in (BEFORE, KNOWN):
            bands[str(line)] = next(iter(errors.values()))
        else:
            lines.append(Line(str(line), list(errors), list(errors.values())))
    return LinePanel(title, X_LABEL, Y_LABEL, lines, bands, dodge=APART)


def shown_of(settings: FineTuning, seconds: Sequence[int], test: TunedTest) -> list[tuple[str, int, str, str]]:
    """Return line, seconds, level and method of what is looked at, line by line."""
    (before,) = test.methods
    shown = [(BEFORE, time, test.level, before) for time in seconds]
    for line, base in test.tuned.items():
        shown += [(line, time, test.level, swept_name(base, settings.sweep, time)) for time in seconds]
    return [*shown, *((KNOWN, time, test.known, before) for time in seconds)]
