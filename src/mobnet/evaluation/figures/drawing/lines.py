"""Panels of lines over epochs or sizes, with the spread of their runs. Drawing only."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from mobnet.evaluation.figures.style import Look, entitle, legend, looks, stacked, styled
from mobnet.evaluation.number.number import Number

PANEL_INCH, LEGEND_INCH = 1.6, 0.45  # height of a panel and of the legend above all
LEAST_APART = 0.08  # between the names of two places [share of the axis]
MARGIN = 0.08  # above and below all means [share of their range]
LEGEND: Mapping[str, Any] = {"columns": 3, "handlelength": 2.6, "columnspacing": 1.2, "handletextpad": 0.5}


@dataclass(frozen=True)
class Line:
    """A number at epochs or sizes (n,): mean over runs, lowest and highest run (n,) [units of the panel]."""

    label: str
    x: Sequence[float]
    numbers: Sequence[Number]

    @property
    def columns(self) -> NDArray[np.float64]:
        """Mean, lowest and highest run (3, n) [unit of the panel]."""
        return np.array([number.with_ends for number in self.numbers], dtype=np.float64).T


@dataclass(frozen=True)
class LinePanel:
    """Lines over epochs or sizes; few places, as sizes are, are marked, on a logarithmic axis if no panel has zero."""

    title: str
    x_label: str
    y_label: str
    lines: Sequence[Line]
    sizes: bool = False

    @property
    def unit(self) -> str:
        """Unit of the numbers, the end of their label."""
        return self.y_label.partition("[")[2].rstrip("]")


@styled
def draw_lines(panels: Sequence[LinePanel], columns: int = 1) -> Figure:
    """Draw panels of lines with the spread of their runs below one another (Figures 17 and 20), or in `columns`."""
    styles = looks(line.label for panel in panels for line in panel.lines)
    logarithmic = all(min(line.x) > 0.0 for panel in panels for line in panel.lines)
    figure, axes = stacked([panel.unit for panel in panels], PANEL_INCH, LEGEND_INCH, columns)
    for k, (axis, panel) in enumerate(zip(axes, panels, strict=True)):
        for line in panel.lines:
            _line(axis, line, styles[line.label], panel.sizes)
        axis.set(xlabel=panel.x_label, ylabel=panel.y_label)
        entitle(axis, k, panel.title)
        _places(axis, panel, logarithmic)
    if not any(panel.sizes for panel in panels):
        axes[0].set_ylim(*_range_of_means(panels))
    legend(figure, axes, **LEGEND)
    return figure


def _range_of_means(panels: Sequence[LinePanel]) -> tuple[float, float]:
    """Return the ends of an axis [its unit] that shows all means: a single run that leaps would flatten every line."""
    means = np.concatenate([line.columns[0] for panel in panels for line in panel.lines])
    margin = MARGIN * float(np.ptp(means)) or 1.0
    return float(means.min()) - margin, float(means.max()) + margin


def _line(axis: Axes, line: Line, look: Look, marked: bool) -> None:
    """Draw a line (n,) and what its runs spread over: bars at marked places, else a band behind it."""
    style: dict[str, Any] = {**look.line, "label": line.label, "zorder": 3}
    mean, low, high = line.columns
    if marked:
        axis.errorbar(line.x, mean, [mean - low, high - mean], marker=look.marker, markersize=3.5, capsize=2.0, **style)
        return
    axis.plot(line.x, mean, marker=look.marker if len(line.x) == 1 else "", **style)
    axis.fill_between(line.x, low, high, color=look.colour, alpha=0.18, linewidth=0.0)


def _places(axis: Axes, panel: LinePanel, logarithmic: bool) -> None:
    """Mark whole epochs, or the sizes there are."""
    if not panel.sizes:
        axis.xaxis.set_major_locator(MaxNLocator(integer=True))
        return
    places = np.unique(np.concatenate([line.x for line in panel.lines]))
    if logarithmic:
        axis.set_xscale("log")
    axis.minorticks_off()
    named = _apart(places, np.log(places) if logarithmic else places)
    axis.set_xticks(named, [f"{place:.0f}" for place in named])


def _apart(places: NDArray[np.float64], drawn: NDArray[np.float64]) -> list[float]:
    """Return the places (n,) of which each is drawn so far right of the one before that both can be named."""
    kept = [0]
    for k in range(1, len(places)):
        if drawn[k] - drawn[kept[-1]] >= LEAST_APART * np.ptp(drawn):
            kept.append(k)
    return places[kept].tolist()
