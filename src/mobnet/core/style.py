"""How all drawings look: sizes of text and lines, and widths on a page."""

from typing import Any

import matplotlib as mpl

STYLE: dict[Any, Any] = {
    "font.size": 8,
    "axes.labelsize": 8,
    "axes.titlesize": 8,
    "legend.fontsize": 7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.6,
    "lines.linewidth": 0.9,
    "hatch.linewidth": 0.5,
    "pdf.fonttype": 42,
    "svg.hashsalt": "mobnet",  # names of parts of a drawing, the same in every run
    "savefig.dpi": 200,
}
styled = mpl.rc_context(STYLE)  # decorates functions that draw
COLUMN_INCH, PAGE_INCH = 3.4, 7.0  # width of one column of the paper and of two
