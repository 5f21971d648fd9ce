"""Figures: pure drawing functions take arrays and return a Figure; one saver writes PDF and PNG that never change."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mobnet.core.files import atomic_path, write_text
from mobnet.evaluation.rows import csv_text

# Okabe and Ito's colours, told apart by colour-blind readers; dashes and shades differ in print without colour too.
COLOURS = {
    "MOB": "#0072B2",
    "MOB-fric": "#56B4E9",
    "MOB-Net": "#D55E00",
    "FTS-e2e": "#CC79A7",
}
OTHER = "#56B4E9"
DASHES: Mapping[str, Any] = {"MOB-fric": (0, (4, 1)), "FTS-e2e": (0, (6, 1, 1.5, 1))}
KNOWN: Mapping[str, Mapping[str, Any]] = {  # looks of what is no estimate: on top of all, or wide below all
    "truth": {"color": "black", "linestyle": (0, (1, 1)), "linewidth": 1.1, "zorder": 3},
    "target": {"color": "0.72", "linewidth": 2.0, "zorder": 1},
}
FLAGS: Mapping[str, tuple[float, Mapping[str, Any]]] = {  # name -> lower edge of the mark on the panel [-], its look
    "swing": (0.0, {"color": "#009E73", "alpha": 0.15}),
    "push": (0.95, {"color": "0.35"}),
}
STYLE: dict[Any, Any] = {
    "font.size": 8,
    "axes.labelsize": 8,
    "axes.titlesize": 8,
    "legend.fontsize": 7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "lines.linewidth": 0.9,
    "pdf.fonttype": 42,
    "savefig.dpi": 200,
}
COLUMN_INCH, PAGE_INCH = 3.4, 7.0  # width of one column of the paper and of two
PANEL_INCH, LEGEND_INCH = 1.1, 0.5  # height of a panel and of what stands above and below all
BAND_ALPHA = 0.35
LETTERS = "abcdefghijkl"


@dataclass(frozen=True)
class Curve:
    """A line over time.

    Attributes:
        label: method or what else is drawn; chooses the look.
        values: torque (T,) [N m], V1..V3 [N].
        std: standard deviation, drawn as a band around the line (T,) [N m], V1..V3 [N]; None for no band.
    """

    label: str
    values: NDArray[Any]
    std: NDArray[Any] | None = None


@dataclass(frozen=True)
class Panel:
    """Curves of one joint over one stretch of time.

    Attributes:
        title: what is shown.
        time: time (T,) [s].
        curves: lines, the last on top.
        flags: name of `FLAGS` -> whether it holds (T,).
    """

    title: str
    time: NDArray[Any]
    curves: Sequence[Curve]
    flags: Mapping[str, NDArray[Any]]


def draw_panels(
    panels: Sequence[Panel],
    x_label: str,
    y_label: str,
    columns: int = 1,
    *,
    height_inch: float = PANEL_INCH,
    one_scale: bool = False,
) -> Figure:
    """Draw panels in rows, one column of the paper wide or, with several side by side, two (Figures 5, 7, 8 and 9).

    Args:
        panels: arrays (T,), torque in [N m], force in [N], time in [s].
        x_label: name and unit of the time.
        y_label: name and unit of the curves.
        columns: panels in a row.
        height_inch: height of a panel.
        one_scale: whether all panels have the same vertical scale.
    """
    rows = -(-len(panels) // columns)
    with mpl.rc_context(STYLE):
        size = COLUMN_INCH if columns == 1 else PAGE_INCH, height_inch * rows + LEGEND_INCH
        figure = Figure(figsize=size, layout="constrained")
        grid = figure.subplots(rows, columns, sharex=True, sharey=one_scale, squeeze=False)
        axes: list[Axes] = grid.ravel().tolist()
        for spare in axes[len(panels) :]:
            spare.set_visible(False)
        for letter, axis, panel in zip(LETTERS, axes, panels, strict=False):
            draw_panel(axis, panel)
            axis.set_title(f"({letter}) {panel.title}", loc="left", pad=3)
        axes[0].set_xlim(min(panel.time[0] for panel in panels), max(panel.time[-1] for panel in panels))
        figure.supxlabel(x_label, fontsize=STYLE["axes.labelsize"])
        figure.supylabel(y_label, fontsize=STYLE["axes.labelsize"])
        legend(figure, axes[: len(panels)])
    return figure


def draw_panel(axis: Axes, panel: Panel) -> None:
    """Draw the curves (T,) [N m] of one panel with their bands, and mark where its flags hold."""
    across = axis.get_xaxis_transform()
    for name, flags in panel.flags.items():
        bottom, look = FLAGS[name]
        if np.any(flags):
            axis.fill_between(
                panel.time, bottom, 1.0, where=flags.astype(bool), transform=across, linewidth=0.0, label=name, **look
            )
    for curve in panel.curves:
        look = look_of(curve.label)
        axis.plot(panel.time, curve.values, label=curve.label, **look)
        if curve.std is not None:
            low, high = curve.values - curve.std, curve.values + curve.std
            axis.fill_between(
                panel.time, low, high, color=look["color"], alpha=BAND_ALPHA, linewidth=0.0, zorder=1.5,
                label=f"{curve.label} \N{PLUS-MINUS SIGN} 1 std",
            )  # fmt: skip


def look_of(label: str) -> Mapping[str, Any]:
    """Return colour and dashes of a line."""
    return KNOWN.get(label, {"color": COLOURS.get(label, OTHER), "linestyle": DASHES.get(label, "-")})


def legend(figure: Figure, axes: Sequence[Axes], columns: int | None = None, **look: float) -> None:
    """Put one legend of everything drawn above the panels, each label as it is drawn first.

    Args:
        figure: holds the panels.
        axes: the panels.
        columns: entries in a row at most [-]; None for all in one.
        look: other lengths of Matplotlib's legend than here [font size].
    """
    found: dict[str, Any] = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels(), strict=True):
            found.setdefault(label, handle)
    look = {"handlelength": 1.8, "columnspacing": 0.9, "handletextpad": 0.4, **look}
    ncols = max(1, min(columns or len(found), len(found)))
    figure.legend(found.values(), found.keys(), loc="outside upper center", ncols=ncols, frameon=False, **look)


def save_figure(figure: Figure, stem: Path) -> None:
    """Write `stem.pdf` (vector, fonts embedded) and `stem.png`, without dates, so equal numbers give equal files."""
    with mpl.rc_context(STYLE):
        for suffix, metadata in ((".pdf", {"CreationDate": None, "Producer": None}), (".png", {"Software": None})):
            with atomic_path(stem.with_suffix(suffix)) as temporary:
                figure.savefig(temporary, format=suffix[1:], metadata=metadata)


def write_panels(path: Path, panels: Sequence[Panel]) -> None:
    """Write the plotted numbers as CSV, a row a panel and sample: time [s], flags [-], curves [N m], V1..V3 [N].

    A curve that another panel has and this one has not leaves its field empty.
    """
    columns = [columns_of(panel) for panel in panels]
    names = list(dict.fromkeys(name for own in columns for name in own))
    rows: list[tuple[Any, ...]] = []
    for panel, own in zip(panels, columns, strict=True):
        values = [own[name].tolist() if name in own else [None] * len(panel.time) for name in names]
        rows += [(panel.title, *row) for row in zip(*values, strict=True)]
    write_text(path, csv_text(["panel", *names], rows))


def columns_of(panel: Panel) -> dict[str, NDArray[Any]]:
    """Return name -> plotted numbers (T,): time [s], flags [-], curves and their deviations [N m], V1..V3 [N]."""
    columns = {"time_s": panel.time, **{name: flags.astype(np.int64) for name, flags in panel.flags.items()}}
    for curve in panel.curves:
        columns[curve.label] = curve.values
        if curve.std is not None:
            columns[f"{curve.label} std"] = curve.std
    return columns
