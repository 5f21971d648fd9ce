"""How all drawings look: sizes of text and lines, and widths on a page."""

import functools
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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
PLACE_DIGITS = 6  # of the edges of panels, in shares of the figure: a hundred-thousandth of an inch


def styled(function: Callable[Parameters, Value]) -> Callable[Parameters, Value]:
    """Return a function that draws in this style."""

    @functools.wraps(function)
    def drawn(*args: Parameters.args, **kwargs: Parameters.kwargs) -> Value:
        import matplotlib as mpl  # here: a command refuses a wrong word before the third of a second that this takes

        with mpl.rc_context(STYLE):
            return function(*args, **kwargs)

    return drawn


def settle(figure: "Figure") -> None:
    """Lay a figure out once and for all, with its panels at the same places in every process and in every file format.

    Matplotlib's layout asks kiwisolver for the edges of the panels. It adds terms up in the order of its variables'
    addresses in memory, which depend on all that the process did before, and so do the last bits of the edges. They
    are rounded here: else they would show in the bytes of a saved figure.
    """
    if figure.get_layout_engine() is None:
        return
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    for axis in figure.axes:
        left, bottom, width, height = axis.get_position(original=True).bounds
        edges = (_placed(left), _placed(bottom), _placed(width), _placed(height))
        axis.set_position(edges)


def _placed(edge: float) -> float:
    return round(float(edge), PLACE_DIGITS)
