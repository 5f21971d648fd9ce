"""Figure 6: estimates around a step of torque on a swinging hip, and their errors in the windows that are scored."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mobnet.evaluation.figures.drawing.pushes import PushGroup, bar_panel, save_pushes
from mobnet.evaluation.measure.metrics import PUSHED
from mobnet.evaluation.measure.pushes import (
    ALL,
    Entries,
    push_error,
    read_pushes,
    wanted_of,
)
from mobnet.evaluation.number.published import published_value, read_published
from mobnet.evaluation.number.rows import Score, read_rows


def figure_06(config: Mapping[str, Any], entries: Entries, scores_csv: Path, out_dir: Path) -> None:
    """Write Figure 6, a step of torque on a swinging hip [N m]: curves around the first, errors in all windows.

    Args:
        config: resolved configuration: `robot`, `published`, `evaluation.figure_06` (scenario, level, methods, joint,
            before_s, after_s) and what intervals need.
        entries: a mapping a method: method, and the stems `recording`, `residual`, `estimate` of one recording.
        scores_csv: scores of the scenario.
        out_dir: gets figure_06.pdf, .png, .csv and figure_06_bars.csv.

    Raises:
        DataError: a file is missing or damaged, or a run is missing.
    """
    settings, scores = config["evaluation"]["figure_06"], read_rows(scores_csv, Score)
    published = read_published(Path(config["published"]), "figure_06")
    joint = settings["joint"]
    errors = [
        push_error(
            config, wanted, ALL, [wanted], scores, published_value(published, wanted.level, wanted.method, joint)
        )
        for wanted in (wanted_of(config, settings, method, joint, PUSHED) for method in settings["methods"])
    ]
    panels = read_pushes(config, settings, entries, f"step {{}} on {joint}")[:1]
    save_pushes(
        [PushGroup(panels, bar_panel("error around the steps", errors))], errors, settings, out_dir / "figure_06"
    )
