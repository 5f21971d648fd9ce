"""Figure 8: uncertainty torque of the joints of a leg over one gait cycle, and what a network predicts of it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mobnet.evaluation.figures.drawing.curves import save_leg
from mobnet.evaluation.measure.gait import Entries, read_leg
from mobnet.evaluation.measure.metrics import rmse_in_spans


def figure_08(config: Mapping[str, Any], entries: Entries, out_dir: Path) -> None:
    """Write Figure 8, uncertainty torque of a leg over one gait cycle [N m]: the target and what a network predicts.

    The error told in a panel's title is that over the whole recording, as the paper tells it.

    Args:
        config: resolved configuration: `robot`, `evaluation.figure_08` (limb, start_s), `sizes.figure_start_s`.
        entries: a mapping a method: method, and the stems `recording`, `residual`, `estimate` of one recording.
        out_dir: gets figure_08.pdf, .png and .csv.

    Raises:
        DataError: a file is missing or damaged, or no whole cycle follows the start.
    """
    curves, rows = read_leg(config, "figure_08", entries)
    (estimate,) = curves.estimates.values()
    errors = rmse_in_spans(estimate, curves.truth, curves.spans, curves.rate_hz).tolist()
    panels = [
        curves.uncertainty_panel(f"{joint}, RMSE {error:.2f} N m", joint, rows, zero=rows.start)
        for joint, error in zip(curves.joints, errors, strict=True)
    ]
    save_leg(panels, "uncertainty torque [N m]", out_dir / "figure_08")
