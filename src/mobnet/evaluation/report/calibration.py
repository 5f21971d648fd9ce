"""Table and figure of the standard deviations' calibration, which share what is read: rule `calibration`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from mobnet.core.config import load_layout
from mobnet.evaluation.figures.calibration import nominal_points, panels_of, reliability
from mobnet.evaluation.measure.calibration import held_out, in_tests
from mobnet.evaluation.tables.calibration import trust_table


def calibration(
    config: Mapping[str, Any],
    folders: Sequence[str],
    tests: Sequence[Mapping[str, Any]],
    table_dir: Path,
    figure_dir: Path,
) -> None:
    """Write calibration.csv, .tex and .md, and the reliability plot as calibration.pdf, .png and .csv.

    Args:
        config: resolved configuration: `robot`, `seed`, and of `evaluation`: `calibration` (levels [-], points of a
            line, methods, share and tolerance [-] of the bar), `coverage` for pushes, and what intervals need.
        folders: of all trained networks.
        tests: scenario, level, limbs, `pushed` and `runs` of each test.
        table_dir: gets the table.
        figure_dir: gets the figure.

    Raises:
        DataError: a file is missing or damaged.
    """
    settings = config["evaluation"]["calibration"]
    levels, points = settings["levels"], nominal_points(settings["points"])
    grids = in_tests(config, tests, [*levels, *points])
    held = held_out(load_layout(Path(config["robot"])), folders, levels)
    trust_table(config, [*held, *grids], table_dir)
    reliability(panels_of(grids, settings["methods"], len(levels), points), figure_dir)
