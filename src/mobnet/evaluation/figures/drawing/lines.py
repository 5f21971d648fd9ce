"""Panels of lines over epochs or sizes, with the spread of their runs. Drawing only."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from mobnet.evaluation.figures.style import COLUMN_INCH, STYLE, legend

PANEL_INCH, LEGEND_INCH = 1.6, 0.45  # height of a panel and of the legend above all
# Okabe and Ito's colours; dashes and markers tell the lines apart in print without colour too.
COLOURS = ("#D55E00", "#0072B2", "#009E73", "#CC79A7", "#E69F00", "black", "#56B4E9")
DASHES: Sequence[Any] = ("-", (0, (5, 1.5)), (0, (1, 1)), (0, (5, 1, 1, 1)), (0, (3, 1, 1, 1, 1, 1)), (0, (8, 2)), "-")
MARKERS = "osD^vPX"
MARGIN = 0.08  # above and below all means [share of their range]
LEGEND: Mapping[str, Any] = {"columns": 3, "handlelength": 2.6, "columnspacing": 1.2, "handletextpad": 0.5}


@dataclass(frozen=True)
class Line:
    """A number over epochs or sizes: mean of some runs, and what they spread over.

    Attributes:
        label: name in the legend; the same name has the same colour in every panel.
        x: places (n,) [unit of the panel].
        mean: mean over runs (n,) [unit of the panel].
        low: lowest run (n,) [unit of the panel].
        high: highest run (n,) [unit of the panel].
    """

    label: str
    x: NDArray[Any]
    mean: NDArray[Any]
    low: NDArray[Any]
    high: NDArray[Any]


@dataclass(frozen=True)
class LinePanel:
    """One panel of Figures 17 and 20.

    Attributes:
        title: what is shown.
        x_label: name and unit of the places.
        y_label: name and unit of the numbers.
        lines: what is drawn.
        sizes: whether x is a size: few places, marked, on a logarithmic axis.
    """

    title: str
    x_label: str
    y_label: str
    lines: Sequence[Line]
    sizes: bool = False


def draw_lines(panels: Sequence[LinePanel]) -> Figure:
    """Draw panels of lines with the spread of their runs below one another (Figures 17 and 20).

    Args:
        panels: arrays (n,), unit as in each panel's labels.
    """
    labels = list(dict.fromkeys(line.label for panel in panels for line in panel.lines))
    with mpl.rc_context(STYLE):
        figure, axes = stacked(len(panels))
        for letter, axis, panel in zip("abcdefgh", axes, panels, strict=False):
            for line in panel.lines:
                _line(axis, line, labels.index(line.label) % len(COLOURS), panel.sizes)
            axis.set(xlabel=panel.x_label, ylabel=panel.y_label)
            axis.set_title(f"({letter}) {panel.title}", loc="left", pad=3)
            _places(axis, panel)
        if not any(panel.sizes for panel in panels):
            axes[0].set_ylim(*_range_of_means(panels))
        legend(figure, axes, **LEGEND)
    return figure


def _range_of_means(panels: Sequence[LinePanel]) -> tuple[float, float]:
    """Return the ends of an axis [its unit] that shows all means: a single run that leaps would flatten every line."""
    means = np.concatenate([line.mean for panel in panels for line in panel.lines])
    margin = MARGIN * float(np.ptp(means)) or 1.0
    return float(means.min()) - margin, float(means.max()) + margin


def _line(axis: Axes, line: Line, style: int, marked: bool) -> None:
    """Draw a line (n,) and what its runs spread over: bars at marked places, else a band behind it."""
    look: dict[str, Any] = {"color": COLOURS[style], "linestyle": DASHES[style], "label": line.label, "zorder": 3}
    if marked:
        spread = [line.mean - line.low, line.high - line.mean]
        axis.errorbar(line.x, line.mean, spread, marker=MARKERS[style], markersize=3.5, capsize=2.0, **look)
        return
    axis.plot(line.x, line.mean, marker=MARKERS[style] if len(line.x) == 1 else "", **look)
    axis.fill_between(line.x, line.low, line.high, color=COLOURS[style], alpha=0.18, linewidth=0.0)


def _places(axis: Axes, panel: LinePanel) -> None:
    """Mark whole epochs, or the sizes there are."""
    if not panel.sizes:
        axis.xaxis.set_major_locator(MaxNLocator(integer=True))
        return
    places = np.unique(np.concatenate([line.x for line in panel.lines]))
    axis.set_xscale("log")
    axis.minorticks_off()
    axis.set_xticks(places, [f"{place:.0f}" for place in places])


def stacked(count: int) -> tuple[Figure, list[Axes]]:
    """Return a figure of one column's width with panels of one scale below one another."""
    figure = Figure(figsize=(COLUMN_INCH, PANEL_INCH * count + LEGEND_INCH), layout="constrained")
    return figure, figure.subplots(count, 1, squeeze=False, sharey=True)[:, 0].tolist()
