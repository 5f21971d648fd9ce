"""How all drawings look: sizes of text and lines, and widths on a page."""

import functools
from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

Parameters = ParamSpec("Parameters")
Value = TypeVar("Value")

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
COLUMN_INCH, PAGE_INCH = 3.4, 7.0  # width of one column of the paper and of two


def styled(function: Callable[Parameters, Value]) -> Callable[Parameters, Value]:
    """Return a function that draws in this style."""

    @functools.wraps(function)
    def drawn(*args: Parameters.args, **kwargs: Parameters.kwargs) -> Value:
        import matplotlib as mpl  # here: a command refuses a wrong word before the third of a second that this takes

        with mpl.rc_context(STYLE):
            return function(*args, **kwargs)

    return drawn
