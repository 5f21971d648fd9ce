"""How much of a push that lasts an estimate shows, step by step since it began, in swing and stance."""

from collections.abc import Sequence
from itertools import product
from pathlib import Path

import pandas as pd

from experiments.evaluation.compare.scene import STANCE, SWINGING
from experiments.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from experiments.evaluation.figures.style import save_figure
from experiments.evaluation.measure.estimates.drift import HELD_STEP
from experiments.evaluation.number.frames import read_scores, records_of, rows_of
from experiments.evaluation.number.laws import numbers_by
from experiments.evaluation.number.scored import AVERAGE, CELL, numbers_of
from experiments.settings.measures import Drift
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import DRIFT

X_LABEL = "number of the step since the push began"
Y_LABEL = "share of the push [-]"
ENDS = (0.0, 1.3)  # of the axis
COLUMNS, PANEL_INCH, APART = 4, 2.0, 0.07  # panels in a row, their height, distance of marks at a step


def drift(settings: Drift, statistics: Statistics, scores: Sequence[Path], figure_dir: Path) -> None:
    """Write the share of long pushes [-] that each method shows, step by step, as PDF, PNG and CSV."""
    asked: list[tuple[str | int, ...]] = []
    for title, test in settings.tests.items():
        for phase, method in product((SWINGING, STANCE), test.methods):
            for step in range(1, settings.steps + 1):
                cell = test.scenario, settings.limb, test.level, method, AVERAGE, HELD_STEP.format(phase, step)
                asked.append((title, phase, step, *cell))
    cells = pd.DataFrame(asked, columns=["panel", "phase", "step", *CELL])
    # Pushes may have fewer steps than are asked for.
    rows = numbers_of(read_scores(*scores), cells, statistics).dropna(subset="value")
    panels: list[LinePanel] = []
    for title, phase in product(settings.tests, (SWINGING, STANCE)):
        panels.append(panel_of(f"{title}, {phase}", rows_of(rows, panel=title, phase=phase)))
    figure = draw_lines(panels, min(COLUMNS, len(panels)), PANEL_INCH)
    save_figure(figure, figure_dir / "drift", DRIFT, records_of(rows.rename(columns={"value": "share"}), DRIFT))


def panel_of(title: str, rows: pd.DataFrame) -> LinePanel:
    """Return the panel of a phase: a line for each method that has a share there."""
    lines: list[Line] = []
    for method, of_method in rows.groupby("method", sort=False):
        numbers = numbers_by(of_method, "step")
        lines.append(Line(str(method), list(numbers), list(numbers.values())))
    return LinePanel(
        title,
        X_LABEL,
        Y_LABEL,
        lines,
        guide=1.0,
        ends=ENDS,
        note=beyond(rows),
        logarithmic=False,
        dodge=APART,
    )


def beyond(rows: pd.DataFrame) -> str:
    """Return the shares outside of the axis, a line for each method."""
    outside = rows[~rows["value"].between(*ENDS)]
    texts: list[str] = []
    for method, of_method in outside.groupby("method", sort=False):
        texts.append(f"beyond: {method} {', '.join(f'{value:.2f}' for value in of_method['value'])}")
    return "\n".join(texts)
