"""Groups of bars, a bar a method, with intervals, the paper's numbers and short notes. Drawing only."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mobnet.evaluation.figures.drawing.lines import (
    LEGEND,
    stacked,
)
from mobnet.evaluation.figures.style import COLOURS, STYLE, legend

SHADES = ("#D55E00", "#56B4E9", "#E69F00", "#009E73")  # of methods without a colour of their own
HATCHES = ("", "////", "xxxx", "....")
BAR_SHARE = 0.8  # of the distance between two groups of bars
NOTE_POINTS = 6.0  # size of a note
NOTE_ROOM = {0: 0.15, 90: 0.6}  # angle of notes [deg] -> room for them above the highest bar, as a share of it [-]
PAPER = {"marker": "D", "markersize": 3.5, "color": "white", "markeredgecolor": "black", "markeredgewidth": 0.8}


def draw_bars(panels: Sequence[BarPanel], y_label: str) -> Figure:
    """Draw groups of bars, a bar a method with its interval, a panel a test (Figure 18).

    Args:
        panels: heights (n,) [N m] and intervals (2, n) [N m].
        y_label: name and unit of the heights.
    """
    with mpl.rc_context({**STYLE, "hatch.linewidth": 0.5}):
        figure, axes = stacked(len(panels))
        for letter, axis, panel in zip("abcdefgh", axes, panels, strict=False):
            draw_bar_panel(axis, panel)
            axis.set(ylabel=y_label)
            axis.set_title(f"({letter}) {panel.title}", loc="left", pad=3)
        legend(figure, axes, **LEGEND)
    return figure


@dataclass(frozen=True)
class BarPanel:
    """One panel of Figures 6, 10 and 18.

    Attributes:
        title: the test.
        groups: names of the groups of bars (n,).
        heights: method -> height of its bar in each group (n,) [N m].
        spans: method -> ends of the intervals (2, n) [N m]; equal to the height where there is none.
        published: method -> the paper's number in each group (n,) [N m]; nan where it prints none.
        source: name of those numbers in the legend.
        notes: method -> what is written above its bar in each group (n,).
    """

    title: str
    groups: Sequence[str]
    heights: Mapping[str, NDArray[Any]]
    spans: Mapping[str, NDArray[Any]]
    published: Mapping[str, NDArray[Any]] = field(default_factory=dict)
    source: str = "paper"
    notes: Mapping[str, Sequence[str]] = field(default_factory=dict)


def draw_bar_panel(axis: Axes, panel: BarPanel, note_deg: int = 0) -> None:
    """Draw a panel's bars (n,) [N m] side by side in their groups; `note_deg` is the angle of its notes [deg]."""
    places, width = np.arange(len(panel.groups)), BAR_SHARE / max(1, len(panel.heights))
    for k, (method, heights) in enumerate(panel.heights.items()):
        x = places + (k - (len(panel.heights) - 1) / 2) * width
        low, high = panel.spans[method]
        axis.bar(
            x, heights, width, label=method, hatch=HATCHES[k % len(HATCHES)], edgecolor="black", linewidth=0.4,
            color=COLOURS.get(method, SHADES[k % len(SHADES)]),
            yerr=[heights - low, high - heights], error_kw={"linewidth": 0.8, "capsize": 2.0},
        )  # fmt: skip
        if np.isfinite(panel.published.get(method, np.nan)).any():
            axis.plot(x + width / 4, panel.published[method], linestyle="", label=panel.source, zorder=4, **PAPER)
        if method in panel.notes:
            _notes(axis, x, panel, method, note_deg)
    axis.set_xticks(places, panel.groups)
    axis.tick_params(axis="x", length=0.0)


def _notes(axis: Axes, x: NDArray[Any], panel: BarPanel, method: str, angle_deg: int) -> None:
    """Write a method's notes at places (n,) [-]: above its bars, or, at an angle [deg], above all bars of the group."""
    ends = panel.spans if angle_deg else {method: panel.spans[method]}
    marks = [panel.published[name] for name in ends if name in panel.published]
    tops = np.nanmax([*(high for _, high in ends.values()), *marks], axis=0)
    for place, top, note in zip(x, tops, panel.notes[method], strict=True):
        axis.annotate(
            note, (place, top), (0.0, 4.0), textcoords="offset points", fontsize=NOTE_POINTS, rotation=angle_deg,
            ha="center", va="bottom",
        )  # fmt: skip
    axis.set_ylim(0.0, max(axis.get_ylim()[1], tops.max() * (1 + NOTE_ROOM[angle_deg])))
