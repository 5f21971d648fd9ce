"""What an observer's error is made of: its error with every source on, and how much goes with one of them off."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import ERRORS, Score
from mobnet.core.config import load_layout
from mobnet.evaluation.measure.averages import Column, columns_of
from mobnet.evaluation.measure.metrics import PERCENT
from mobnet.evaluation.number.files import read_rows
from mobnet.evaluation.number.grid import Wanted, run_grid
from mobnet.evaluation.number.intervals import mean, summarise
from mobnet.evaluation.number.number import Number
from mobnet.evaluation.tables.layout import RULE, Line, Table, write_table

METRIC, GONE = "rmse", "gone"
DIGITS = {METRIC: 2, GONE: 0}
SIGN = {METRIC: "", GONE: " %"}

Cells = Mapping[tuple[str, str, str, str], Number]  # scenario, level, method, METRIC or GONE


def error_budget(config: Mapping[str, Any], scores_csv: Path, out_dir: Path) -> None:
    """Write error_budget.csv, .tex and .md: RMSE [N m] of joints with one source of error off, and the share [%] gone.

    Args:
        config: resolved configuration: `robot`, `evaluation.error_budget` (`joints`, given as a table's columns, and
            `tests`, of which the first has every source on) and what intervals need.
        scores_csv: scores of the tests' scenario.
        out_dir: gets the three files.

    Raises:
        DataError: a run is missing.
    """
    settings, layout = config["evaluation"]["error_budget"], load_layout(Path(config["robot"]))
    scores = read_rows(scores_csv, Score)
    budgets = {
        part: cells_of(config, part, settings["tests"], scores) for part in columns_of(layout, settings["joints"])
    }
    records = [
        (*run, part.name, ours.runs, metric, *ours.with_ends, ours.unit, None)
        for part, cells in budgets.items()
        for (*run, metric), ours in cells.items()
    ]
    first, *others = (test["label"] for test in settings["tests"])
    header = ["Joint", "Unit", first, *(text for label in others for text in (label, "gone"))]
    lines = budget_lines(budgets, config["evaluation"]["confidence"])
    write_table(out_dir / "error_budget", Table(ERRORS, records, header, lines, left=2))


def cells_of(
    config: Mapping[str, Any], part: Column, tests: Sequence[Mapping[str, Any]], scores: Sequence[Score]
) -> Cells:
    """Return, test by test, the RMSE [N m] of a joint or a mean and the share [%] of the square that a source makes.

    Raises:
        DataError: a run is missing.
    """
    full: list[NDArray[np.float64]] = []
    cells = {}
    for test in tests:
        scenario, level, method = test["scenario"], test["level"], test["methods"][0]
        wanted = [Wanted(scenario, limb, level, method, joint, METRIC) for limb, joint in part.joints]
        grids = [run_grid(scores, each) for each in wanted]
        cells[scenario, level, method, METRIC] = summarise(grids, config, mean, part.unit)
        if full:
            squares = [grid**2 for grid in (*full, *grids)]
            cells[scenario, level, method, GONE] = summarise(squares, config, share_gone, "%")
        full = full or grids
    return cells


def share_gone(means: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how much less [%] the last half of squares (2 n, ...) is in sum than the first half, (...)."""
    before, after = np.split(means, 2)
    return PERCENT * (1.0 - after.sum(axis=0) / before.sum(axis=0))


def budget_lines(budgets: Mapping[Column, Cells], confidence: float) -> list[Line]:
    """Return the lines of text, RMSE [N m] and share gone [%] in turn; intervals and a rule below each mean.

    Args:
        budgets: numbers of each joint or mean, test by test.
        confidence: of the intervals, a share [-].
    """
    lines: list[Line] = []
    for part, cells in budgets.items():
        own = [(metric, ours) for (*_, metric), ours in cells.items()]
        lines.append([part.name, part.unit, *(ours.text(DIGITS[metric]) + SIGN[metric] for metric, ours in own)])
        if len(part.joints) > 1:
            if own[0][1].low is not None:
                lines.append([f"{confidence:.0%}", "", *(ours.interval(DIGITS[metric]) for metric, ours in own)])
            lines.append(RULE)
    return lines[:-1] if lines[-1] == RULE else lines
