"""Boxes, circles and straight arrows of a block diagram, in inches of the page. Drawing only."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, FancyArrowPatch, FancyBboxPatch

Place = tuple[float, float]
INK, PALE = "#1B1F24", "#5B6470"
CORNER, SUM_RADIUS = 0.04, 0.085  # [inch]
DASHES = (0, (3, 2))
ARROW = {"arrowstyle": "-|>,head_length=3.2,head_width=1.7", "shrinkA": 0.0, "shrinkB": 0.0, "mutation_scale": 1.0}


@dataclass(frozen=True)
class Box:
    """A block with lines of text, the first one bold.

    Attributes:
        centre: of the block [inch].
        size: width and height [inch].
        lines: of text.
        colour: of its ground.
        dashed: whether it is part of a variant only.
    """

    centre: Place
    size: Place
    lines: Sequence[str]
    colour: str
    dashed: bool = False

    def side(self, x: float, y: float) -> Place:
        """Return a place on its border, from the centre in half widths and half heights [inch]."""
        return self.centre[0] + x * self.size[0] / 2, self.centre[1] + y * self.size[1] / 2


def sheet(width_inch: float, height_inch: float) -> tuple[Figure, Axes]:
    """Return a figure [inch] and axes that cover it, in inches."""
    figure = Figure(figsize=(width_inch, height_inch))
    axis = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axis.set(xlim=(0.0, width_inch), ylim=(0.0, height_inch))
    axis.set_axis_off()
    return figure, axis


def draw_box(axis: Axes, box: Box, line_inch: float = 0.125) -> None:
    """Draw a block."""
    (x, y) = box.centre
    (width, height) = box.size
    style = f"round,pad=0,rounding_size={CORNER}"
    outline = FancyBboxPatch(
        (x - width / 2, y - height / 2),
        width,
        height,
        boxstyle=style,
        facecolor=box.colour,
        edgecolor=INK,
        linewidth=0.7,
        linestyle=DASHES if box.dashed else "-",
        zorder=3,
    )
    axis.add_patch(outline)
    for k, text in enumerate(box.lines):
        look: dict[str, Any] = (
            {"fontweight": "bold", "fontsize": 7.5, "color": INK} if k == 0 else {"fontsize": 7, "color": INK}
        )
        axis.text(x, y + ((len(box.lines) - 1) / 2 - k) * line_inch, text, ha="center", va="center", zorder=4, **look)


def draw_sum(axis: Axes, centre: Place, signs: Sequence[tuple[str, float, float]]) -> None:
    """Draw a circle in which signals meet, each with its sign beside it, at an offset [inch]."""
    axis.add_patch(Circle(centre, SUM_RADIUS, facecolor="white", edgecolor=INK, linewidth=0.7, zorder=3))
    for sign, x, y in signs:
        axis.text(centre[0] + x, centre[1] + y, sign, ha="center", va="center", fontsize=8, zorder=4)


def draw_path(
    axis: Axes,
    places: Sequence[Place],
    text: str = "",
    at: Place = (0.0, 0.0),
    *,
    dashed: bool = False,
    ha: str = "center",
    headed: bool = True,
) -> None:
    """Draw a line through places [inch] that ends in an arrow, and a text at a place beside it."""
    look: dict[str, Any] = {"color": INK, "linewidth": 0.8, "linestyle": DASHES if dashed else "-", "zorder": 2}
    corners = np.array(places)
    axis.plot(*corners[:-1].T, solid_capstyle="round", **look)
    if headed:
        axis.add_patch(FancyArrowPatch(places[-2], places[-1], **ARROW, **{**look, "linestyle": look["linestyle"]}))
    else:
        axis.plot(*corners[-2:].T, **look)
    if text:
        axis.text(*at, text, ha=ha, va="center", fontsize=7, color=PALE, zorder=4)
