"""Groups of bars, one for each method, with intervals. Drawing only."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mobnet.evaluation.figures.drawing.lines import LEGEND, LEGEND_INCH, PANEL_INCH
from mobnet.evaluation.figures.style import entitle, legend, looks, stacked, styled
from mobnet.evaluation.number.number import Number

BAR_SHARE = 0.8  # of the distance between two groups of bars


@dataclass(frozen=True)
class BarPanel:
    """One panel of Figure 18: n groups of bars, in which a method has its number [N m] with its interval (n,)."""

    title: str
    groups: Sequence[str]
    bars: Mapping[str, Sequence[Number]]


@styled
def draw_bars(panels: Sequence[BarPanel], y_label: str) -> Figure:
    """Draw groups of bars [N m], one for each method with its interval, and a panel for each test (Figure 18)."""
    figure, axes = stacked([y_label] * len(panels), PANEL_INCH, LEGEND_INCH)
    for k, (axis, panel) in enumerate(zip(axes, panels, strict=True)):
        draw_bar_panel(axis, panel)
        axis.set(ylabel=y_label)
        entitle(axis, k, panel.title)
    legend(figure, axes, **LEGEND)
    return figure


def draw_bar_panel(axis: Axes, panel: BarPanel) -> None:
    """Draw a panel's bars [N m] side by side in their groups."""
    places, width = np.arange(len(panel.groups)), BAR_SHARE / max(1, len(panel.bars))
    styles = looks(panel.bars)
    for k, (method, numbers) in enumerate(panel.bars.items()):
        x = places + (k - (len(panel.bars) - 1) / 2) * width
        heights, low, high = columns_of(numbers)
        axis.bar(
            x, heights, width, label=method, hatch=styles[method].hatch, edgecolor="black", linewidth=0.4,
            color=styles[method].colour, yerr=[heights - low, high - heights],
            error_kw={"linewidth": 0.8, "capsize": 2.0},
        )  # fmt: skip
    axis.set_xticks(places, panel.groups)
    axis.tick_params(axis="x", length=0.0)


def columns_of(numbers: Sequence[Number]) -> NDArray[np.float64]:
    """Return value, lower and upper end (3, n) [N m]; where there is no interval, its ends are the value."""
    return np.array([number.range for number in numbers], dtype=np.float64).reshape(-1, 3).T
