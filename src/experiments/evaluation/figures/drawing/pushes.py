"""Curves around pushes, above numbers of each method: error, share of the push that it shows, delay. Drawing only."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import lcm
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from experiments.evaluation.compare.curves import Panel
from experiments.evaluation.figures.drawing.curves import draw_panel
from experiments.evaluation.figures.drawing.named_bars import BAR_INCH, NamedBar, draw_named_bars, draw_named_dots
from experiments.evaluation.figures.style import entitle, legend, with_joint_name
from mobnet.core.style import COLUMN_INCH, PAGE_INCH, styled

STEP_INCH, HIT_INCH = 1.0, 0.9  # height of curves in one column of the paper and in two
STEP_REST_INCH, LABELS_INCH = 0.8, 1.35  # of legend, titles and labels in one column and in two
FROM_PUSH = "time from push [s]"
EACH = "RMSE of each push"
COMPARED = "whole push; delay of an observer without errors"  # what the dashed lines are
MARKED = ("push",)  # flags that are drawn where the title says the phase


@dataclass(frozen=True)
class PushGroup:
    """Curves of the pushes of a test, a panel each [N m], and a row for each method.

    Attributes:
        panels: curves of each push.
        title: of the numbers.
        errors: RMSE [N m], with that of each push as marks.
        shares: shares of the pushes that a method shows [-].
        delays: delays of the rise [ms].
        observer_ms: delay of an observer without errors [ms]; None where nothing pushes.
    """

    panels: Sequence[Panel]
    title: str
    errors: Sequence[NamedBar]
    shares: Sequence[NamedBar]
    delays: Sequence[NamedBar]
    observer_ms: float | None


@styled
def draw_step(panels: Sequence[Panel], bars: Sequence[NamedBar], joint: str, title: str) -> Figure:
    """Draw curves around a push on a joint [N m], none if nothing pushes, above the RMSE of each method [N m].

    It is as wide as a column of the paper.
    """
    heights = STEP_INCH, BAR_INCH * len(bars)
    figure = Figure(figsize=(COLUMN_INCH, sum(heights) + STEP_REST_INCH), layout="constrained")
    curves, below = figure.subplots(2, 1, height_ratios=heights).tolist()
    for panel in panels:
        # The push alone is marked: all of what is shown is in the phase that the title names.
        flags = {name: flag for name, flag in panel.flags.items() if name in MARKED}
        _curves(curves, replace(panel, flags=flags))
        entitle(curves, 0, panel.title)
    curves.set(xlabel=FROM_PUSH, ylabel=f"{joint} [N m]")
    draw_named_bars(below, bars, "N m", source="RMSE of original", marked="RMSE of (a)")
    entitle(below, 1, f"{title} [N m]")
    # The numbers at the bars say what an axis would, in less room.
    below.set_xlabel("")
    below.set_xticks([])
    below.spines["bottom"].set_visible(False)
    legend(figure, [curves, below], 4)
    return figure


@styled
def draw_hits(group: PushGroup, joint: str, source: str) -> Figure:
    """Draw a test's pushes as wide as a page: curves [N m] side by side on one scale, below them numbers by method.

    The legend calls the paper's numbers `source`.
    """
    heights = HIT_INCH, BAR_INCH * max(len(group.errors), 1)
    figure = Figure(figsize=(PAGE_INCH, sum(heights) + LABELS_INCH), layout="constrained")
    axes = figure.subplot_mosaic(_places(len(group.panels)), height_ratios=heights)
    curves = [axes[str(k)] for k in range(max(len(group.panels), 1))]
    errors, shares, delays = (axes[name] for name in NUMBERS)
    _row(curves, group, joint)
    entitle(curves[0], 0, curves[0].get_title(loc="left"))
    draw_named_bars(errors, group.errors, "N m", source=source, marked=EACH)
    entitle(errors, 1, group.title)
    draw_named_dots(shares, group.shares, "share of the push shown [-]", 1.0, COMPARED)
    draw_named_dots(delays, group.delays, "delay of the rise [ms]", group.observer_ms, COMPARED)
    # The rows of all three are the methods, which the first one names.
    for axis in (shares, delays):
        axis.tick_params(labelleft=False)
    legend(figure, list(axes.values()))
    return figure


NUMBERS = ("errors", "shares", "delays")  # panels below the curves


def _places(count: int) -> list[Any]:
    """Return the places of all panels: a row of so many curves, or of an empty panel, and a row of numbers."""
    curves = [str(k) for k in range(max(count, 1))]
    # so many columns that the panels of each row get equally many of them
    width = lcm(len(NUMBERS), len(curves))
    return [np.repeat(curves, width // len(curves)).tolist(), np.repeat(NUMBERS, width // len(NUMBERS)).tolist()]


def _row(axes: Sequence[Axes], group: PushGroup, joint: str) -> None:
    """Draw a test's curves [N m] on one scale; only the first panel names it."""
    for axis, panel in zip(axes, group.panels, strict=False):
        _curves(axis, panel)
        axis.set_title(panel.title, loc="left", pad=3)
        axis.set_xlabel(FROM_PUSH)
    ends = [end for axis in axes for end in axis.get_ylim()]
    for axis in axes:
        axis.set_ylim(min(ends), max(ends))
        axis.tick_params(labelleft=axis is axes[0])
    axes[0].set_ylabel(with_joint_name(f"{joint} [N m]", "\n"))


def _curves(axis: Axes, panel: Panel) -> None:
    """Draw the curves of a panel over its whole time."""
    draw_panel(axis, panel)
    axis.set_xlim(panel.time[0], panel.time[-1])
