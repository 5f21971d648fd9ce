"""Figure 5: one gait cycle of one joint, by uncertainty level and method."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mobnet.evaluation.figures.drawing.curves import FROM_LIFT_OFF, draw_panels, write_panels
from mobnet.evaluation.figures.style import save_figure
from mobnet.evaluation.measure.curves import Panel
from mobnet.evaluation.measure.gait import Entries, read_cycle
from mobnet.evaluation.number.published import read_published


def figure_05(config: Mapping[str, Any], entries: Entries, out_dir: Path) -> None:
    """Write Figure 5, one gait cycle of one joint [N m], as PDF, PNG and the plotted numbers as CSV.

    Args:
        config: resolved configuration: `evaluation.figure_05` (joint, start_s), `sizes.figure_start_s` instead of
            start_s where a scale is too short for it, `published` for the names of the levels.
        entries: a mapping a panel, in order: level, method, and the stems `recording`, `residual`, `estimate`.
        out_dir: gets figure_05.pdf, .png and .csv.

    Raises:
        DataError: a file is missing or damaged, or no whole cycle follows the start.
        ConfigError: the joint belongs to no leg.
    """
    settings = config["evaluation"]["figure_05"]
    labels = read_published(Path(config["published"]), "table_05")["labels"]
    panels = [read_panel(config, entry, labels.get(entry["level"], entry["level"])) for entry in entries]
    y_label = f"external torque of {settings['joint']} [N m]"
    write_panels(out_dir / "figure_05.csv", panels)
    save_figure(draw_panels(panels, FROM_LIFT_OFF, y_label, one_scale=True), out_dir / "figure_05")


def read_panel(config: Mapping[str, Any], entry: Mapping[str, Any], label: str) -> Panel:
    """Return one panel of Figure 5: the first whole gait cycle after the start.

    Raises:
        DataError: a file is missing or damaged, or no whole cycle follows the start.
    """
    settings = config["evaluation"]["figure_05"]
    curves, rows = read_cycle(config, settings, [entry], [settings["joint"]])
    title = f"{entry['method']}, {label[:1].lower()}{label[1:]}"
    return curves.panel(title, settings["joint"], rows, zero=rows.start)
