"""Figures: pure drawing functions take arrays and return a Figure; one saver writes PDF and PNG that never change."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mobnet.core.files import atomic_path

# Okabe and Ito's colours, told apart by colour-blind readers; shades differ in print without colour too.
COLOURS = {"truth": "black", "swing": "#009E73", "MOB": "#0072B2", "MOB-Net": "#D55E00", "FTS-e2e": "#CC79A7"}
OTHER = "#56B4E9"
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
COLUMN_INCH = 3.4  # width of one column of the paper
PANEL_INCH = 1.1


@dataclass(frozen=True)
class Panel:
    """One panel of Figure 5.

    Attributes:
        title: level and method.
        method: estimator; chooses the colour.
        time: time from lift-off (T,) [s].
        swing: 1 while the foot is planned to be in the air (T,).
        truth: low-passed external torque (T,) [N m].
        estimate: estimated external torque (T,) [N m].
    """

    title: str
    method: str
    time: NDArray[Any]
    swing: NDArray[Any]
    truth: NDArray[Any]
    estimate: NDArray[Any]


def draw_gait_cycle(panels: Sequence[Panel], joint: str) -> Figure:
    """Draw one gait cycle of a joint, a panel for each level and method, swing shaded (Figure 5).

    Args:
        panels: arrays (T,), torque in [N m], time in [s].
        joint: name for the axis label.
    """
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(COLUMN_INCH, PANEL_INCH * len(panels) + 0.5), layout="constrained")
        axes = figure.subplots(len(panels), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
        for letter, axis, panel in zip("abcdefgh", axes, panels, strict=False):
            draw_panel(axis, panel)
            axis.set_title(f"({letter}) {panel.title}", loc="left", pad=3)
        axes[-1].set_xlabel("time from lift-off [s]")
        figure.supylabel(f"external torque of {joint} [N m]", fontsize=STYLE["axes.labelsize"])
        axes[0].set_xlim(0.0, max(float(panel.time[-1]) for panel in panels))
        legend(figure, axes.tolist())
    return figure


def draw_panel(axis: Axes, panel: Panel) -> None:
    """Draw truth and estimate [N m] of one panel and shade the swing phase."""
    axis.fill_between(
        panel.time, 0.0, 1.0, where=panel.swing.astype(bool), transform=axis.get_xaxis_transform(),
        color=COLOURS["swing"], alpha=0.15, linewidth=0.0, label="swing",
    )  # fmt: skip
    axis.plot(panel.time, panel.truth, color=COLOURS["truth"], linestyle=":", linewidth=1.1, label="truth", zorder=3)
    axis.plot(panel.time, panel.estimate, color=COLOURS.get(panel.method, OTHER), label=panel.method)


def legend(figure: Figure, axes: Sequence[Axes], columns: int | None = None, **look: float) -> None:
    """Put one legend of everything drawn above the panels.

    Args:
        figure: holds the panels.
        axes: the panels.
        columns: entries in a row at most [-]; None for all in one.
        look: other lengths of Matplotlib's legend than here [font size].
    """
    found: dict[str, Any] = {}
    for axis in axes:
        handles, labels = axis.get_legend_handles_labels()
        found.update(zip(labels, handles, strict=True))
    look = {"handlelength": 1.4, "columnspacing": 0.9, "handletextpad": 0.4, **look}
    ncols = min(columns or len(found), len(found))
    figure.legend(found.values(), found.keys(), loc="outside upper center", ncols=ncols, frameon=False, **look)


def save_figure(figure: Figure, stem: Path) -> None:
    """Write `stem.pdf` (vector, fonts embedded) and `stem.png`, without dates, so equal numbers give equal files."""
    with mpl.rc_context(STYLE):
        for suffix, metadata in ((".pdf", {"CreationDate": None, "Producer": None}), (".png", {"Software": None})):
            with atomic_path(stem.with_suffix(suffix)) as temporary:
                figure.savefig(temporary, format=suffix[1:], metadata=metadata)


def curve_rows(panels: Sequence[Panel]) -> list[tuple[str, float, int, float, float]]:
    """Return the plotted numbers: title, time [s], swing, truth [N m], estimate [N m] of every sample."""
    rows = []
    for panel in panels:
        columns = (panel.time, panel.swing.astype(np.int64), panel.truth, panel.estimate)
        rows += [(panel.title, *values) for values in zip(*(column.tolist() for column in columns), strict=True)]
    return rows
