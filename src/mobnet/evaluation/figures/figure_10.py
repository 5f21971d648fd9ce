"""Figure 10: pushes on the knee of a leg in the air and on the ground, and the error of each."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mobnet.core.columns import Score
from mobnet.evaluation.figures.drawing.pushes import PushGroup, save_pushes
from mobnet.evaluation.measure.pushes import Entries, collision_errors, read_pushes
from mobnet.evaluation.number.files import read_rows

ROBOT = "paper (robot)"  # name of numbers that the paper measured on its robot


def figure_10(
    config: Mapping[str, Any], entries: Mapping[str, Entries], scores: Mapping[str, Path], out_dir: Path
) -> None:
    """Write Figure 10, pushes on the knee of a leg in the air and on the ground [N m]: curves and errors of each.

    Args:
        config: resolved configuration: `robot`, `published`, `evaluation.figure_10` (joint, before_s, after_s, tests:
            title -> scenario, level, methods; against: the same of what the average error is compared with) and what
            intervals need.
        entries: title of a test -> a mapping a method, as in Figure 6.
        scores: scenario -> its scores.
        out_dir: gets figure_10.pdf, .png, .csv and figure_10_bars.csv.

    Raises:
        DataError: a file is missing or damaged, or a run is missing.
    """
    settings = config["evaluation"]["figure_10"]
    rows = [row for path in scores.values() for row in read_rows(path, Score)]
    groups = []
    for title, test in settings["tests"].items():
        errors = collision_errors(config, settings, test, rows)
        panels = read_pushes(config, settings, entries[title], f"{title} {{}}")
        groups.append(PushGroup(test["scenario"], panels, errors, f"{title}: error by push", ROBOT))
    save_pushes(groups, settings["joint"], out_dir / "figure_10")
