"""What an observer's error is made of: its error with every source on, and how much goes with one of them off."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from experiments.evaluation.compare.rmse import PERCENT
from experiments.evaluation.number.grid import Column, Wanted, columns_of, run_grid
from experiments.evaluation.number.intervals import Array, Formula, RunGrid, summarise
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import Field, read_scores
from experiments.evaluation.tables.layout import RULE, Line, Table, write_table
from experiments.settings.runs import Statistics
from experiments.settings.tables import BudgetRow, ErrorBudget
from mobnet.core.columns import ERRORS, Score
from mobnet.core.joints import JointLayout

METRIC = "rmse"
GONE = "gone"
DIGITS = {METRIC: 2, GONE: 0}
SIGN = {METRIC: "", GONE: " %"}

Cells = Mapping[tuple[str, str, str, str], Number]  # scenario, level, method, METRIC or GONE


def error_budget(
    settings: ErrorBudget,
    statistics: Statistics,
    layout: JointLayout,
    scores: Sequence[Path],
    table_dir: Path,
) -> None:
    """Write error_budget.csv, .tex and .md: RMSE [N m] of joints with one source of error off, and the share [%] gone.

    The first test of `settings` has every source on.
    """
    rows = read_scores(*scores)
    parts = columns_of(layout, settings.joints)
    budgets = {part: cells_of(part, settings.tests, rows, statistics) for part in parts}
    records: list[tuple[Field, ...]] = []
    for part, cells in budgets.items():
        for (*run, metric), ours in cells.items():
            records.append((*run, part.name, metric, *ours.with_ends, *ours.spread, ours.unit, None))
    first, *others = (test.label for test in settings.tests)
    header = ["Joint", "Unit", first]
    for label in others:
        header += [label, GONE]
    lines = budget_lines(budgets, statistics.confidence)
    write_table(table_dir / "error_budget", Table(ERRORS, records, header, lines, left=2))


def cells_of(part: Column, tests: Sequence[BudgetRow], scores: Sequence[Score], statistics: Statistics) -> Cells:
    """Return, test by test, the RMSE [N m] of a joint or a mean and the share [%] of the square that a source makes."""
    full: list[RunGrid] = []
    gone = Formula(share_left, lambda left: PERCENT * (1.0 - left), positive=True)
    cells = {}
    for test in tests:
        run = test.scenario, test.level, test.methods[0]
        wanted = [Wanted(run[0], limb, *run[1:], joint, METRIC) for limb, joint in part.joints]
        grids = [run_grid(scores, each) for each in wanted]
        cells[*run, METRIC] = summarise(grids, statistics, unit=part.unit)
        if full:
            squares = [replace(grid, values=grid.values**2) for grid in (*full, *grids)]
            cells[*run, GONE] = summarise(squares, statistics, gone, "%")
        full = full or grids
    return cells


def share_left(means: Array) -> Array:
    """Return the sum of the last half of squares (2 n, ...) over that of the first half, (1, ...) [-]."""
    before, after = np.split(means, 2)
    return after.sum(axis=0, keepdims=True) / before.sum(axis=0, keepdims=True)


def budget_lines(budgets: Mapping[Column, Cells], confidence: float) -> list[Line]:
    """Return the lines of text, RMSE [N m] and share gone [%] in turn; intervals and a rule below each mean."""
    lines: list[Line] = []
    for part, cells in budgets.items():
        own = [(metric, ours) for (*_, metric), ours in cells.items()]
        lines.append([part.name, part.unit, *(ours.text(DIGITS[metric]) + SIGN[metric] for metric, ours in own)])
        if len(part.joints) > 1:
            if own[0][1].low is not None:
                lines.append([f"{confidence:.0%}", "", *(ours.interval(DIGITS[metric]) for metric, ours in own)])
            lines.append(RULE)
    return lines[:-1] if lines[-1] == RULE else lines
