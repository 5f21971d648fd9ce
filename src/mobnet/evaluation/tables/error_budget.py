"""What an observer's error is made of: its error with every source on, and how much goes with one of them off."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.config import load_layout
from mobnet.core.files import write_text
from mobnet.evaluation.measure.averages import Column, columns_of
from mobnet.evaluation.measure.metrics import PERCENT
from mobnet.evaluation.number.grid import Wanted, run_grid
from mobnet.evaluation.number.intervals import mean, summarise
from mobnet.evaluation.number.rows import Cell, Score, read_rows, write_rows
from mobnet.evaluation.tables.layout import RULE, Line, markdown_table, number, span, text_table

log = logging.getLogger(__name__)

METRIC, GONE = "rmse", "gone"
DIGITS = {METRIC: 2, GONE: 0}


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
    parts, scores = columns_of(layout, settings["joints"]), read_rows(scores_csv, Score)
    cells = {part: list(cells_of(config, part, settings["tests"], scores)) for part in parts}
    first, *others = (test["label"] for test in settings["tests"])
    header = ["Joint", "Unit", first, *(text for label in others for text in (label, "gone"))]
    lines = budget_lines(cells, config["evaluation"]["confidence"])
    write_rows(out_dir / "error_budget.csv", Cell, [cell for own in cells.values() for cell in own])
    write_text(out_dir / "error_budget.tex", text_table("ll" + "r" * (len(header) - 2), header, lines))
    write_text(out_dir / "error_budget.md", markdown_table(header, lines, left=2))
    log.info("%s: %d joints and means", out_dir / "error_budget.csv", len(parts))


def cells_of(
    config: Mapping[str, Any], part: Column, tests: Sequence[Mapping[str, Any]], scores: Sequence[Score]
) -> Iterator[Cell]:
    """Yield, test by test, the RMSE [N m] of a joint or a mean and the share [%] of the square that a source makes.

    Raises:
        DataError: a run is missing.
    """
    full: list[NDArray[np.float64]] = []
    for test in tests:
        run = (test["scenario"], test["level"], test["methods"][0])
        grids = [run_grid(scores, Wanted(run[0], limb, *run[1:], joint, METRIC)) for limb, joint in part.joints]
        found = [(METRIC, part.unit, summarise(grids, config, mean))]
        if full:
            found.append((GONE, "%", summarise([grid**2 for grid in (*full, *grids)], config, share_gone)))
        for metric, unit, ours in found:
            yield Cell(*run, part.name, ours.count, metric, ours.value, ours.low, ours.high, unit, None)
        full = full or grids


def share_gone(means: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how much less [%] the last half of squares (2 n, ...) is in sum than the first half, (...)."""
    before, after = np.split(means, 2)
    return PERCENT * (1.0 - after.sum(axis=0) / before.sum(axis=0))


def budget_lines(cells: Mapping[Column, Sequence[Cell]], confidence: float) -> list[Line]:
    """Return the lines of text, RMSE [N m] and share gone [%] in turn; intervals and a rule below each mean.

    Args:
        cells: of each joint or mean, test by test.
        confidence: of the intervals, a share [-].
    """
    lines: list[Line] = []
    for part, own in cells.items():
        sign = {METRIC: "", GONE: " %"}
        lines.append([part.name, part.unit, *(number(c.value, DIGITS[c.metric]) + sign[c.metric] for c in own)])
        if len(part.joints) > 1:
            if own[0].low is not None:
                lines.append([f"{confidence:.0%}", "", *(span(c.low, c.high, DIGITS[c.metric]) for c in own)])
            lines.append(RULE)
    return lines[:-1] if lines[-1] == RULE else lines
