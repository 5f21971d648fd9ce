"""Figure 9: external torque of the joints of a leg over one gait cycle, by method."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mobnet.evaluation.figures.drawing.curves import save_leg
from mobnet.evaluation.measure.gait import Entries, read_leg


def figure_09(config: Mapping[str, Any], entries: Entries, out_dir: Path) -> None:
    """Write Figure 9, external torque of a leg over one gait cycle by method [N m].

    Args:
        config: resolved configuration: `robot`, `evaluation.figure_09` (limb, start_s), `sizes.figure_start_s`.
        entries: a mapping a method: method, and the stems `recording`, `residual`, `estimate` of one recording.
        out_dir: gets figure_09.pdf, .png and .csv.

    Raises:
        DataError: a file is missing or damaged, or no whole cycle follows the start.
    """
    curves, rows = read_leg(config, "figure_09", entries)
    panels = [curves.panel(joint, joint, rows, zero=rows.start) for joint in curves.joints]
    save_leg(panels, "external torque [N m]", out_dir / "figure_09")
