"""Figure 6: estimates around a step of torque on a swinging hip, and their errors in the windows that are scored."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mobnet.core.columns import Score
from mobnet.evaluation.figures.drawing.pushes import PushGroup, save_pushes
from mobnet.evaluation.measure.metrics import PUSHED
from mobnet.evaluation.measure.pushes import ALL, Entries, read_pushes, wanted_of
from mobnet.evaluation.number.files import read_rows
from mobnet.evaluation.number.grid import number_of
from mobnet.evaluation.number.published import published_value, read_published


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
    published, joint = read_published(Path(config["published"]), "figure_06"), settings["joint"]
    errors = {}
    for method in settings["methods"]:
        wanted = wanted_of(config, settings, method, joint, PUSHED)
        printed = published_value(published, wanted.level, method, joint)
        errors[method] = {ALL: number_of(scores, [wanted], config, published=printed)}
    panels = read_pushes(config, settings, entries, f"step {{}} on {joint}")[:1]
    group = PushGroup(settings["scenario"], panels, errors, "error around the steps")
    save_pushes([group], joint, out_dir / "figure_06")
