"""Figure 7: upper body and base while a load hangs on a hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from mobnet.core.columns import PUSHED
from mobnet.core.config import load_layout
from mobnet.evaluation.figures.drawing.curves import draw_panels, write_panels
from mobnet.evaluation.figures.style import save_figure
from mobnet.evaluation.measure.curves import read_curves

SIDE_BY_SIDE = 2


def figure_07(config: Mapping[str, Any], entries: Sequence[Mapping[str, Any]], out_dir: Path) -> None:
    """Write Figure 7, external torque of joints [N m] and force on the base [N] under a load on a hand.

    Args:
        config: resolved configuration: `robot`, `evaluation.figure_07` (joints, start_s, end_s, every: samples from one
            drawn to the next).
        entries: a mapping a method: method, and the stems `recording`, `residual`, `estimate` of one recording.
        out_dir: gets figure_07.pdf, .png and .csv.

    Raises:
        DataError: a file is missing or damaged.
        ConfigError: a joint is not estimated by a method.
    """
    settings, robot = config["evaluation"]["figure_07"], Path(config["robot"])
    curves = read_curves(robot, entries, settings["joints"], {"push": PUSHED})
    start, end = (round(settings[key] * curves.rate_hz) for key in ("start_s", "end_s"))
    rows, layout = slice(start, end, settings["every"]), load_layout(robot)
    panels = [curves.panel(f"{joint} [{layout.unit(joint)}]", joint, rows, band=True) for joint in settings["joints"]]
    write_panels(out_dir / "figure_07.csv", panels)
    figure = draw_panels(panels, "time [s]", "external torque or force", SIDE_BY_SIDE)
    save_figure(figure, out_dir / "figure_07")
