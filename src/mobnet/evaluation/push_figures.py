"""Curves around pushes above the bars of their errors (Figures 6 and 10). Drawing only."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mobnet.evaluation.bars import BarPanel, draw_bar_panel
from mobnet.evaluation.figures import (
    COLUMN_INCH,
    LEGEND_INCH,
    LETTERS,
    PAGE_INCH,
    STYLE,
    Panel,
    draw_panel,
    legend,
)

CURVES_INCH, BARS_INCH = 1.4, 1.7  # height of a row of curves and of the bars
LEGEND_COLUMNS = 4  # entries in a row, in one column of the paper


@dataclass(frozen=True)
class PushGroup:
    """Curves of some pushes and the bars of their errors.

    Attributes:
        panels: a push each.
        bars: errors.
    """

    panels: Sequence[Panel]
    bars: BarPanel


def draw_pushes(groups: Sequence[PushGroup], joint: str, across: int = 1, note_deg: int = 0) -> Figure:
    """Draw groups side by side, one in one column of the paper and more in two: curves, and their bars below.

    Args:
        groups: curves [N m] over time from the push [s], bars [N m].
        joint: name for the axis label.
        across: panels of curves in a row of a group.
        note_deg: angle of the bars' notes [deg].
    """
    rows = max(1, *(-(-len(group.panels) // across) for group in groups))
    places: list[Any] = [
        [f"{k}.{row * across + i}" for k in range(len(groups)) for i in range(across)] for row in range(rows)
    ]
    places.append([f"{k}.bars" for k in range(len(groups)) for _ in range(across)])
    with mpl.rc_context({**STYLE, "hatch.linewidth": 0.5}):
        size = COLUMN_INCH if len(groups) == 1 else PAGE_INCH, CURVES_INCH * rows + BARS_INCH + LEGEND_INCH
        figure = Figure(figsize=size, layout="constrained")
        axes = figure.subplot_mosaic(places, height_ratios=[*[CURVES_INCH] * rows, BARS_INCH])
        for k, group in enumerate(groups):
            bars = axes[f"{k}.bars"]
            draw_bar_panel(bars, group.bars, note_deg)
            bars.set_title(f"({LETTERS[2 * k + 1]}) {group.bars.title}", loc="left", pad=3)
            bars.set_ylabel("RMSE [N m]")
            curves = [axes[f"{k}.{i}"] for i in range(rows * across)]
            _curves(curves, group, across, joint)
            curves[0].set_title(f"({LETTERS[2 * k]}) {curves[0].get_title(loc='left')}", loc="left", pad=3)
        legend(figure, list(axes.values()), LEGEND_COLUMNS * len(groups))
    return figure


def _curves(axes: Sequence[Axes], group: PushGroup, across: int, joint: str) -> None:
    """Draw a group's curves [N m] on one scale, `across` in a row; only outer panels have labels."""
    for axis in axes[len(group.panels) :]:
        axis.set_visible(False)
    used = axes[: len(group.panels)]
    for axis, panel in zip(used, group.panels, strict=True):
        draw_panel(axis, panel)
        axis.set_title(panel.title, loc="left", pad=3)
        axis.set_xlim(panel.time[0], panel.time[-1])
    ends = [end for axis in used for end in axis.get_ylim()]
    for i, axis in enumerate(used):
        axis.set_ylim(min(ends), max(ends))
        axis.tick_params(labelleft=i % across == 0)
        if i % across == 0:
            axis.set_ylabel(f"{joint} torque [N m]")
        if i + across >= len(used):
            axis.set_xlabel("time from push [s]")
