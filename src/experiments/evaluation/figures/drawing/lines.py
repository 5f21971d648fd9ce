"""Panels of lines over a few sizes, lengths or steps, with intervals, bands of constants and notes. Drawing only."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from experiments.evaluation.figures.style import NAME, Look, entitle, legend, looks, stacked
from experiments.evaluation.number.number import Number
from mobnet.core.style import STYLE, styled

PANEL_INCH, LEGEND_INCH = 1.6, 0.45  # height of a panel and of the legend above all
LEAST_APART = 0.08  # between the names of two places [share of the axis]
NOTE_POINTS = 6.5  # size of a note
BAND_ALPHA = 0.25  # opacity of a constant's interval
LEGEND: Mapping[str, Any] = {"columns": 3, "handlelength": 2.6, "columnspacing": 1.2, "handletextpad": 0.5}
GUIDE: Mapping[str, Any] = {"color": "0.6", "linewidth": 0.6, "zorder": 0.5}
FROM_ZERO = (0.0, None)  # ends of an axis that begins at zero and ends where its lines need it
ROOM = 1.05  # such an axis is longer by this factor, so that marks of the highest line are whole
ARROW_SHARE = 0.025  # distance of an arrow from the end of the axis [share of its length]


@dataclass(frozen=True)
class Line:
    """A number with its interval at sizes, lengths or steps (n,) [units of the panel]."""

    label: str
    x: Sequence[float]
    numbers: Sequence[Number]

    @property
    def columns(self) -> NDArray[np.float64]:
        """Value and the ends of its interval, or itself where it has none (3, n) [unit of the panel]."""
        return np.array([number.range for number in self.numbers], dtype=np.float64).T


@dataclass(frozen=True)
class LinePanel:
    """Lines over a few places.

    Attributes:
        bands: what is the same at all places: label -> a number, drawn as a line across the panel in its interval.
        guide: a value [unit of y] that a thin grey line marks.
        upright: a place [unit of x] that a thin grey line marks, and `upright_name` what stands at it.
        ends: of the y axis [its unit], None for what the lines need; with both, a value outside is an arrow.
        note: a text in the lower left corner.
        scale: panels of one scale share their y axis.
        logarithmic: whether the x axis is.
        dodge: distance between the marks of two lines at one place [unit of x, decades of a logarithmic axis].
    """

    title: str
    x_label: str
    y_label: str
    lines: Sequence[Line]
    bands: Mapping[str, Number] = field(default_factory=dict[str, Number])
    guide: float | None = None
    upright: float | None = None
    upright_name: str = ""
    ends: tuple[float | None, float | None] = FROM_ZERO
    note: str = ""
    scale: str = ""
    logarithmic: bool = True
    dodge: float = 0.0


@styled
def draw_lines(panels: Sequence[LinePanel], columns: int = 1, panel_inch: float = PANEL_INCH) -> Figure:
    """Draw panels below one another in the width of a column, or so many `columns` of them in that of the page.

    A label that all panels share stands once, below all or at the left of each row.
    """
    labels: list[str] = []
    for panel in panels:
        labels += [*panel.bands, *(line.label for line in panel.lines)]
    styles = looks(labels)
    figure, axes = stacked([panel.scale for panel in panels], panel_inch, LEGEND_INCH, columns)
    one_x = len({panel.x_label for panel in panels}) == 1
    for k, (axis, panel) in enumerate(zip(axes, panels, strict=True)):
        _draw(axis, panel, styles)
        entitle(axis, k, panel.title)
        axis.set_xlabel("" if one_x else panel.x_label)
        axis.set_ylabel(panel.y_label if k % columns == 0 else "")
    tops = [axis.get_ylim()[1] for axis in axes]  # once all axes that share a scale have their lines
    for axis, panel, top in zip(axes, panels, tops, strict=True):
        axis.set_ylim(*panel.ends)
        if panel.ends == FROM_ZERO:
            axis.set_ylim(top=ROOM * top)
    if one_x:
        figure.supxlabel(panels[0].x_label, fontsize=STYLE["axes.labelsize"])
    legend(figure, axes, **{**LEGEND, "columns": None if columns > 1 else LEGEND["columns"]})
    return figure


def _draw(axis: Axes, panel: LinePanel, styles: Mapping[str, Look]) -> None:
    """Draw the bands, lines, places and the note of a panel."""
    if panel.guide is not None:
        axis.axhline(panel.guide, **GUIDE)
    if panel.upright is not None:
        axis.axvline(panel.upright, **GUIDE)
        at = {"xy": (panel.upright, 0.04), "xycoords": axis.get_xaxis_transform()}
        axis.annotate(panel.upright_name, xytext=(-3.0, 0.0), ha="right", **at, **NAME)
    for label, number in panel.bands.items():
        mean, low, high = number.range
        if mean is not None and low is not None and high is not None:
            axis.axhspan(low, high, color=styles[label].colour, alpha=BAND_ALPHA, linewidth=0.0, zorder=1.0)
            axis.axhline(mean, label=label, **{**styles[label].line, "zorder": 1.5})
    for k, line in enumerate(panel.lines):
        off = panel.dodge * (k - (len(panel.lines) - 1) / 2.0)
        _line(axis, line, styles[line.label], _moved(line.x, off, panel.logarithmic), panel.ends)
    _places(axis, panel)
    axis.text(0.03, 0.04, panel.note, transform=axis.transAxes, fontsize=NOTE_POINTS, ha="left", va="bottom")


def _moved(x: Sequence[float], off: float, logarithmic: bool) -> NDArray[np.float64]:
    """Return places (n,) moved by a distance [their unit, or decades]."""
    places = np.asarray(x, dtype=np.float64)
    return places * 10.0**off if logarithmic else places + off


def _line(axis: Axes, line: Line, look: Look, x: NDArray[np.float64], ends: tuple[float | None, float | None]) -> None:
    """Draw a line with marks at places (n,), its intervals, and arrows where it leaves the axis."""
    mean, low, high = line.columns
    axis.plot(x, mean, label=line.label, marker=look.marker, markersize=3.5, **look.line)
    axis.vlines(x, low, high, color=look.colour, linewidth=0.8, zorder=look.order)
    bottom, top = ends
    if bottom is None or top is None:
        return
    for outside, end, marker in ((mean > top, top, "^"), (mean < bottom, bottom, "v")):
        inwards = end + ARROW_SHARE * (bottom + top - 2.0 * end)
        axis.plot(x[outside], np.full(np.sum(outside), inwards), marker, markersize=4.0, color=look.colour, zorder=5)


def _places(axis: Axes, panel: LinePanel) -> None:
    """Name the places that there are."""
    if not panel.lines:
        return
    places = np.unique(np.concatenate([line.x for line in panel.lines]))
    if panel.logarithmic:
        axis.set_xscale("log")
    axis.minorticks_off()
    named = _apart(places, np.log(places) if panel.logarithmic else places)
    axis.set_xticks(named, [f"{place:.0f}" for place in named])


def _apart(places: NDArray[np.float64], drawn: NDArray[np.float64]) -> list[float]:
    """Return the places (n,) of which each is drawn so far right of the one before that both can be named."""
    kept = [0]
    for k in range(1, len(places)):
        if drawn[k] - drawn[kept[-1]] >= LEAST_APART * np.ptp(drawn):
            kept.append(k)
    return places[kept].tolist()
