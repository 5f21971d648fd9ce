"""A push as methods feel it: torque and error of one joint, before and after the push and close to it. Drawing only."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from experiments.evaluation.compare.curves import TRUTH, Panel, TorqueCurve
from experiments.evaluation.figures.drawing.curves import draw_panel
from experiments.evaluation.figures.style import entitle, legend, looks
from mobnet.core.arrays import Array
from mobnet.core.files import atomic_path
from mobnet.core.style import PAGE_INCH, STYLE, settle, styled

HEIGHT_INCH, WIDTHS = 4.4, (1.3, 1.0)  # of the figure; of its columns, side by side
LINE = 9  # from one line of a note to the next [points]
NOTED = 0.25  # share of a panel's height that the lines of notes take
ALARM = {"color": "#CC79A7", "linewidth": 1.2}
# ending -> what is left out, so that equal numbers give equal files
METADATA = {".png": {"Software": None}, ".pdf": {"CreationDate": None, "Producer": None}, ".svg": {"Date": None}}


@dataclass(frozen=True)
class FeltPush:
    """What is drawn of a push, over time from its beginning on (T,) [s].

    Attributes:
        joint: whose torque it is.
        time: from the beginning of the push on (T,) [s].
        truth: true external torque behind the observer's low-pass (T,) [N m].
        estimates: of methods, perhaps with a standard deviation (T,) [N m].
        notes: method -> what is said of it below the push, and below its error there.
        flags: swing and push, whether they hold (T,).
        alarm_s: when the detector says that something hits the leg [s]; None if it does not.
        detector: its name.
        close_s: ends of the time that is shown close [s].
    """

    joint: str
    time: Array
    truth: Array
    estimates: Sequence[TorqueCurve]
    notes: Mapping[str, tuple[str, str]]
    flags: Mapping[str, NDArray[np.bool_]]
    alarm_s: float | None
    detector: str
    close_s: tuple[float, float]

    def panels(self, rows: NDArray[np.bool_]) -> list[Panel]:
        """Return torque and error in some rows [N m]."""
        flags = {name: flag[rows] for name, flag in self.flags.items()}
        shown = [_some(curve, rows, 0.0) for curve in (*self.estimates, TorqueCurve(TRUTH, self.truth))]
        errors = [_some(curve, rows, self.truth) for curve in self.estimates]
        return [Panel("", self.time[rows], curves, flags) for curves in (shown, errors)]


def _some(curve: TorqueCurve, rows: NDArray[np.bool_], less: Array | float) -> TorqueCurve:
    """Return some rows of a curve less another one [N m]."""
    return replace(curve, values=(curve.values - less)[rows], std=None if curve.std is None else curve.std[rows])


@styled
def draw_felt(felt: FeltPush) -> Figure:
    """Draw torque above error [N m]: at the left all of the time, at the right close to the push."""
    figure = Figure(figsize=(PAGE_INCH, HEIGHT_INCH), layout="constrained")
    axes: list[list[Axes]] = figure.subplots(2, 2, sharex="col", sharey="row", width_ratios=WIDTHS).tolist()
    close = (felt.time >= felt.close_s[0]) & (felt.time <= felt.close_s[1])
    for column, rows in enumerate((np.ones(len(felt.time), dtype=bool), close)):
        for row, panel in enumerate(felt.panels(rows)):
            axis = axes[row][column]
            draw_panel(axis, panel)
            axis.axhline(0.0, color="0.6", linewidth=0.5, zorder=0)
            axis.set_xlim(panel.time[0], panel.time[-1])
            if felt.alarm_s is not None:
                axis.axvline(felt.alarm_s, NOTED * column, label=f"alarm of {felt.detector}", **ALARM)
            if column:
                _notes(axis, felt, row)
        axes[1][column].set_xlabel("time from the beginning of the push [s]")
    every = [axis for row in axes for axis in row]
    titles = f"external torque of {felt.joint}", "close to the push", "estimate minus truth", "close to the push"
    for k, (axis, title) in enumerate(zip(every, titles, strict=True)):
        entitle(axis, k, title)
    axes[0][0].set_ylabel("torque [N m]")
    axes[1][0].set_ylabel("error [N m]")
    legend(figure, every)
    return figure


def _notes(axis: Axes, felt: FeltPush, row: int) -> None:
    """Write what is said of each method into the lower part of a panel, in its colour."""
    styles = looks(curve.label for curve in felt.estimates)
    for k, (method, notes) in enumerate(reversed(list(felt.notes.items()))):
        place: dict[str, Any] = {"xytext": (0, LINE * k), "textcoords": "offset points", "ha": "right"}
        look = {"color": styles[method].colour, "fontsize": STYLE["legend.fontsize"]}
        axis.annotate(f"{method}: {notes[row]}", (0.98, 0.03), xycoords="axes fraction", **place, **look)


def save_felt(felt: FeltPush, out: Path) -> None:
    """Write the picture of a push as PNG, PDF or SVG, as the ending of its name says."""
    figure = draw_felt(felt)
    with mpl.rc_context(STYLE), atomic_path(out) as temporary:
        settle(figure)
        figure.savefig(temporary, format=out.suffix[1:], metadata=METADATA[out.suffix])
