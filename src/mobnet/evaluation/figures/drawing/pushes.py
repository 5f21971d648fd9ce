"""Curves around pushes above the bars of their errors (Figures 6 and 10)."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mobnet.evaluation.figures.drawing.bars import BarPanel, draw_bar_panel
from mobnet.evaluation.figures.drawing.curves import LEGEND_INCH, draw_panel, write_panels
from mobnet.evaluation.figures.style import COLUMN_INCH, LETTERS, PAGE_INCH, STYLE, legend, save_figure
from mobnet.evaluation.measure.curves import Panel
from mobnet.evaluation.measure.pushes import (
    INCREASE,
    PushError,
)
from mobnet.evaluation.number.rows import write_rows

log = logging.getLogger(__name__)

MINUS = "\N{MINUS SIGN}"
CURVES_INCH, BARS_INCH = 1.4, 1.7  # height of a row of curves and of the bars
LEGEND_COLUMNS = 4  # entries in a row, in one column of the paper


def bar_panel(title: str, errors: Sequence[PushError], source: str = "paper") -> BarPanel:
    """Return a panel: a group for each push and for what is made of all, in each a bar a method [N m].

    Args:
        title: of the panel.
        errors: method by method, those of an increase last.
        source: name of the paper's numbers.
    """
    shown = [error for error in errors if error.push != INCREASE]
    rows = by_method(shown)
    return BarPanel(
        title,
        list(dict.fromkeys(error.push for error in shown)),
        {method: np.array([error.rmse_nm for error in row]) for method, row in rows.items()},
        {method: spans_of(row) for method, row in rows.items()},
        {method: printed_of(row) for method, row in rows.items()},
        source,
        {method: notes_of(row) for method, row in by_method(errors).items()},
    )


def by_method(errors: Iterable[PushError]) -> dict[str, list[PushError]]:
    """Return method -> its errors, in order."""
    rows: dict[str, list[PushError]] = {}
    for error in errors:
        rows.setdefault(error.method, []).append(error)
    return rows


def spans_of(errors: Sequence[PushError]) -> NDArray[np.float64]:
    """Return the ends of errors' intervals (2, n) [N m], the error itself where it has none."""
    ends = [(e.rmse_nm, e.rmse_nm) if e.low is None or e.high is None else (e.low, e.high) for e in errors]
    return np.array(ends).T


def printed_of(errors: Sequence[PushError]) -> NDArray[np.float64]:
    """Return the paper's numbers (n,) [N m]; nan where it prints none."""
    return np.array([np.nan if error.published is None else error.published for error in errors])


def notes_of(errors: Sequence[PushError]) -> list[str]:
    """Return what stands above a method's bars: at the last its error [N m] and, if that is known, its increase."""
    *own, last = errors
    text = f"{last.rmse_nm:.1f}"
    if last.push == INCREASE:
        *own, average = own
        text = f"{average.rmse_nm:.1f} ({last.rmse_nm:+.1f})"
    return [""] * len(own) + [text.replace("-", MINUS)]


def save_pushes(
    groups: Sequence[PushGroup], errors: Sequence[PushError], settings: Mapping[str, Any], stem: Path
) -> None:
    """Write curves and errors [N m] as CSV, and the figure."""
    across, note_deg = (1, 0) if len(groups) == 1 else (2, 90)
    write_panels(stem.with_suffix(".csv"), [panel for group in groups for panel in group.panels])
    write_rows(stem.with_name(f"{stem.name}_bars.csv"), PushError, errors)
    save_figure(draw_pushes(groups, settings["joint"], across, note_deg), stem)
    log.info("%s.pdf: %d errors", stem, len(errors))


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
