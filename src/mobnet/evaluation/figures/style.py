"""What all figures share: colours, sizes, the legend, and one saver whose PDF and PNG never change."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mobnet.core.files import atomic_path

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
SET_COLOURS = ("#E69F00", "#56B4E9", "#009E73")  # of data sets
LETTERS = "abcdefghijkl"


def look_of(label: str) -> Mapping[str, Any]:
    """Return colour and dashes of a line."""
    return KNOWN.get(label, {"color": COLOURS.get(label, OTHER), "linestyle": DASHES.get(label, "-")})


def legend(figure: Figure, axes: Sequence[Axes], columns: int | None = None, last: str = "", **look: float) -> None:
    """Put one legend of everything drawn above the panels, each label as it is drawn first.

    Args:
        figure: holds the panels.
        axes: the panels.
        columns: entries in a row at most; None for all in one.
        last: label that stands at the end.
        look: other lengths of Matplotlib's legend than here [font size].
    """
    found: dict[str, Any] = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels(), strict=True):
            found.setdefault(label, handle)
    if last in found:
        found[last] = found.pop(last)
    look = {"handlelength": 1.8, "columnspacing": 0.9, "handletextpad": 0.4, **look}
    ncols = max(1, min(columns or len(found), len(found)))
    figure.legend(found.values(), found.keys(), loc="outside upper center", ncols=ncols, frameon=False, **look)


def save_figure(figure: Figure, stem: Path) -> None:
    """Write `stem.pdf` (vector, fonts embedded) and `stem.png`, without dates, so equal numbers give equal files."""
    with mpl.rc_context(STYLE):
        for suffix, metadata in ((".pdf", {"CreationDate": None, "Producer": None}), (".png", {"Software": None})):
            with atomic_path(stem.with_suffix(suffix)) as temporary:
                figure.savefig(temporary, format=suffix[1:], metadata=metadata)
