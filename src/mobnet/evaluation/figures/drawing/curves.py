"""Panels of curves over time, and the plotted numbers as CSV. Drawing only."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mobnet.evaluation.compare.curves import Panel
from mobnet.evaluation.figures.style import COLUMN_INCH, PAGE_INCH, STYLE, entitle, legend, looks, styled
from mobnet.evaluation.number.files import Field

FLAGS: Mapping[str, tuple[float, Mapping[str, Any]]] = {  # name -> lower edge of its mark [of the height], its look
    "swing": (0.0, {"color": "#009E73", "alpha": 0.15}),
    "push": (0.95, {"color": "0.35"}),
}
PANEL_INCH, LEGEND_INCH = 1.1, 0.5  # height of a panel, and of legend and labels together
BAND_ALPHA = 0.35
FROM_LIFT_OFF = "time from lift-off [s]"
SIDE_BY_SIDE, HEIGHT_INCH = 3, 1.5  # panels of a leg's joints


@styled
def draw_panels(
    panels: Sequence[Panel], x_label: str, y_label: str, columns: int = 1, *, height_inch: float = PANEL_INCH,
    one_scale: bool = False,
) -> Figure:  # fmt: skip
    """Draw panels in rows, one column of the paper wide or, with several side by side, two (Figures 5, 7, 8 and 9).

    The curves are torque [N m] or force [N], (T,); with `one_scale`, all panels have the same vertical scale.
    """
    rows = -(-len(panels) // columns)
    size = COLUMN_INCH if columns == 1 else PAGE_INCH, height_inch * rows + LEGEND_INCH
    figure = Figure(figsize=size, layout="constrained")
    grid = figure.subplots(rows, columns, sharex=True, sharey=one_scale, squeeze=False)
    axes: list[Axes] = grid.ravel().tolist()
    for spare in axes[len(panels) :]:
        spare.set_visible(False)
    for k, (axis, panel) in enumerate(zip(axes, panels, strict=False)):
        draw_panel(axis, panel)
        entitle(axis, k, panel.title)
    axes[0].set_xlim(min(panel.time[0] for panel in panels), max(panel.time[-1] for panel in panels))
    figure.supxlabel(x_label, fontsize=STYLE["axes.labelsize"])
    figure.supylabel(y_label, fontsize=STYLE["axes.labelsize"])
    legend(figure, axes[: len(panels)])
    return figure


def draw_panel(axis: Axes, panel: Panel) -> None:
    """Draw the curves (T,) [N m] of one panel with their bands, and mark where its flags hold."""
    across = axis.get_xaxis_transform()
    for name, flags in panel.flags.items():
        bottom, mark = FLAGS[name]
        if np.any(flags):
            axis.fill_between(
                panel.time, bottom, 1.0, where=flags.astype(bool), transform=across, linewidth=0.0, label=name, **mark
            )
    styles = looks(curve.label for curve in panel.curves)
    for curve in panel.curves:
        look = styles[curve.label]
        axis.plot(panel.time, curve.values, label=curve.label, **look.line)
        if curve.std is not None:
            low, high = curve.values - curve.std, curve.values + curve.std
            axis.fill_between(
                panel.time, low, high, color=look.colour, alpha=BAND_ALPHA, linewidth=0.0, zorder=1.5,
                label=f"{curve.label} \N{PLUS-MINUS SIGN} 1 std",
            )  # fmt: skip


def draw_leg(panels: Sequence[Panel], y_label: str) -> Figure:
    """Draw the joints of a leg [N m] over a gait cycle (Figures 8 and 9)."""
    return draw_panels(panels, FROM_LIFT_OFF, y_label, SIDE_BY_SIDE, height_inch=HEIGHT_INCH)


def table_of(panels: Sequence[Panel]) -> tuple[list[str], list[tuple[Field, ...]]]:
    """Return columns and rows of the plotted numbers, a row for each panel and sample: time [s], flags, curves [N m].

    A curve that another panel has and this one has not leaves its field empty.
    """
    columns = [columns_of(panel) for panel in panels]
    names = list(dict.fromkeys(name for own in columns for name in own))
    rows: list[tuple[Field, ...]] = []
    for panel, own in zip(panels, columns, strict=True):
        values = [own[name].tolist() if name in own else [None] * len(panel.time) for name in names]
        rows += [(panel.title, *row) for row in zip(*values, strict=True)]
    return ["panel", *names], rows


def columns_of(panel: Panel) -> dict[str, NDArray[Any]]:
    """Return name -> plotted numbers (T,): time [s], flags, curves and their deviations [N m], V1..V3 [N]."""
    columns = {"time_s": panel.time, **{name: flags.astype(np.int64) for name, flags in panel.flags.items()}}
    for curve in panel.curves:
        columns[curve.label] = curve.values
        if curve.std is not None:
            columns[f"{curve.label} std"] = curve.std
    return columns
