"""Horizontal bars of errors with the method's name on the axis and the number at the end of the row. Drawing only."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from experiments.evaluation.compare.curves import ZERO
from experiments.evaluation.figures.style import looks
from experiments.evaluation.number.number import Number, shown_name

MINUS = "\N{MINUS SIGN}"
BAR_INCH = 0.135  # height that a bar takes
BAR_SHARE = 0.72  # of it that is filled
NUMBER_POINTS = 7.0  # size of names and numbers
PAPER = {"marker": "D", "markersize": 3.2, "color": "white", "markeredgecolor": "black", "markeredgewidth": 0.7}
DRAWN = {"marker": "o", "markersize": 2.6, "color": "white", "markeredgecolor": "black", "markeredgewidth": 0.5}
LINE = {"color": "0.4", "linewidth": 0.7, "linestyle": (0, (2, 2)), "zorder": 1.0}  # at a number to compare with
NUMBER_ROOM = 0.42  # right of the longest bar, for numbers [of its length]
CUT_ABOVE = 2.5  # bars of `zero` are cut where they are so many times longer than all others
DRAWN_LABEL = "RMSE of the curves above"
PAPER_LABEL = {False: "RMSE in the original", True: "RMSE in the original (robot)"}  # whether it measured its robot


@dataclass(frozen=True)
class NamedBar:
    """A method's error [N m], V1..V3 [N], perhaps with errors that are marked on it; or its share or delay of pushes.

    Attributes:
        name: text on the axis.
        method: whose look the bar has.
        number: the error with its interval, and the paper's.
        marks: errors that are marked on it, such as that of the curve above.
    """

    name: str
    method: str
    number: Number
    marks: Sequence[float] = ()

    @property
    def text(self) -> str:
        """The number as it is written at the end of the row, with three digits."""
        value = round(self.number.value or 0.0, 2)  # 9.999 is 10.0
        digits = 2 - (abs(value) >= 10.0) - (abs(value) >= 100.0) + (0.0 < abs(value) < 0.1)
        return self.number.text(digits).replace("-", MINUS)


def draw_named_bars(
    axis: Axes, bars: Sequence[NamedBar], unit: str, *, source: str = PAPER_LABEL[False], marked: str = DRAWN_LABEL
) -> None:
    """Draw bars [unit] below one another, the first on top; the legend calls the paper's numbers `source`."""
    styles = looks(bar.method for bar in bars)
    value, low, high, published = ends_of(bars)
    reach, is_cut = reach_of(bars, np.fmax(high, published))
    places = range(len(bars))
    axis.barh(places, value, BAR_SHARE, color=[styles[bar.method].colour for bar in bars], linewidth=0.0)
    spread = [np.nan_to_num(value - low), np.nan_to_num(high - value)]
    axis.errorbar(value, places, xerr=spread, linestyle="", color="black", linewidth=0.7, capsize=1.5)
    dots: list[tuple[float, int]] = []
    for place, bar in zip(places, bars, strict=True):
        dots += [(mark, place) for mark in bar.marks]
    if dots:
        axis.plot(*np.array(dots).T, linestyle="", label=marked, zorder=4, **DRAWN)
    if np.isfinite(published).any():
        axis.plot(published, places, linestyle="", label=source, zorder=5, **PAPER)
    axis.set_xlim(0.0, reach * (1.0 + NUMBER_ROOM))
    for place, bar in zip(places, bars, strict=True):
        _number(axis, bar, place, is_cut=is_cut and bar.method == ZERO)
    axis.set_yticks(places, [shown_name(bar.name) for bar in bars], fontsize=NUMBER_POINTS)
    axis.tick_params(axis="y", length=0.0)
    axis.set(ylim=(len(bars) - 0.4, -0.6), xlabel=f"RMSE [{unit}]")


def draw_named_dots(axis: Axes, rows: Sequence[NamedBar], x_label: str, at: float | None, compared: str = "") -> None:
    """Draw numbers as dots with intervals below one another, each with its text, and a line at a number to compare.

    The legend calls that number `compared`.
    """
    styles = looks(row.method for row in rows)
    value, low, high, _ = ends_of(rows)
    if at is not None:
        axis.axvline(at, label=compared or None, **LINE)
    axis.set_yticks(range(len(rows)), [shown_name(row.name) for row in rows], fontsize=NUMBER_POINTS)
    axis.grid(axis="y", linewidth=0.3, color="0.85")
    axis.set_axisbelow(True)
    axis.tick_params(axis="y", length=0.0)
    axis.set(ylim=(len(rows) - 0.4, -0.6), xlabel=x_label)
    # Without a number there is nothing to make room for.
    if not np.isfinite(value).any():
        return
    for place, row in enumerate(rows):
        if row.number.value is not None:
            ends = [[value[place] - low[place]], [high[place] - value[place]]]
            look = styles[row.method]
            axis.errorbar(
                value[place],
                place,
                xerr=ends,
                marker=look.marker,
                markersize=3.5,
                color=look.colour,
                ecolor="black",
                elinewidth=0.7,
                capsize=1.5,
                markeredgecolor="black",
                markeredgewidth=0.4,
                zorder=4,
            )
            _number(axis, row, place)
    # Room for the numbers, right of the interval that ends farthest to the right.
    left, right = axis.get_xlim()
    axis.set_xlim(left, right + NUMBER_ROOM / 2 * (right - left))


def ends_of(bars: Sequence[NamedBar]) -> NDArray[np.float64]:
    """Return value, lower and upper end and the paper's number of bars (4, n) [N m], V1..V3 [N]; nan where none is."""
    rows = [(*bar.number.range, bar.number.published) for bar in bars]
    return np.array(rows, dtype=np.float64).reshape(-1, 4).T


def reach_of(bars: Sequence[NamedBar], tops: NDArray[np.float64]) -> tuple[float, bool]:
    """Return how far an axis must reach to hold bars that end at `tops` (n,), and whether it cuts that of `zero`."""
    whole = float(np.nanmax(tops, initial=0.0)) or 1.0
    others = [top for bar, top in zip(bars, tops.tolist(), strict=True) if bar.method != ZERO and np.isfinite(top)]
    most = max(others, default=whole)
    return (most, True) if 0.0 < CUT_ABOVE * most < whole else (whole, False)


def _number(axis: Axes, bar: NamedBar, place: int, *, is_cut: bool = False) -> None:
    """Write a bar's number at the end of its row, apart from all marks; with an arrow where the bar goes on there."""
    look: dict[str, Any] = {"textcoords": "offset points", "va": "center_baseline", "fontsize": NUMBER_POINTS}
    text = f"{bar.text} \N{RIGHTWARDS ARROW}" if is_cut else bar.text
    axis.annotate(text, (1.0, place), (-1.0, 0.0), xycoords=axis.get_yaxis_transform(), ha="right", **look)
