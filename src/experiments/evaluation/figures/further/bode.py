"""Gain and phase of every method over frequency, at each joint of a leg, against the observer's own low-pass."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from experiments.evaluation.figures.style import Look, entitle, legend, looks, save_figure
from experiments.evaluation.measure.estimates.bode import GAIN, PHASE, observer_response
from experiments.evaluation.number.frames import read_scores, records_of, rows_of
from experiments.evaluation.number.scored import CELL, numbers_of
from experiments.settings.measures import Bode
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import RESPONSE
from mobnet.core.arrays import Array
from mobnet.core.joints import JointLayout
from mobnet.core.style import PAGE_INCH, STYLE, styled
from mobnet.settings.data import Push
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.plant import Rates

REFERENCE = "low-pass of (11)"  # the observer's response to what it sees without any error
REFERENCE_LOOK: Mapping[str, Any] = {"color": "0.6", "linewidth": 2.0, "zorder": 1.0}
TICKS_HZ = (0.5, 2.0, 10.0, 50.0)
SHOWN_INCH, ALL_INCH, LEGEND_INCH = 1.45, 1.45, 0.6  # height of a row, of some joints or all; of legend and labels
ACROSS = 2  # joints in a row
QUANTITIES = {"gain": (GAIN, "relative gain [-]"), "phase": (PHASE, "relative phase [deg]")}
ENDS = {"gain": (0.0, 1.25), "phase": (-45.0, 20.0)}  # of the axes; what lies beyond is cut
PERFECT = {"gain": 1.0, "phase": 0.0}  # an estimate without any error

Response = Callable[[NDArray[np.float64]], Array]  # frequencies (n,) [Hz] -> the low-pass's response (n,), complex [-]


def bode(
    settings: Bode,
    pushes: Mapping[str, Push],
    layout: JointLayout,
    observer: ObserverSettings,
    rates: Rates,
    statistics: Statistics,
    scores: Sequence[Path],
    figure_dir: Path,
) -> None:
    """Write gain [-] and phase [deg] over frequency [Hz] of each method, as PDF, PNG and CSV.

    The figure has them relative to the low-pass's, the CSV file as they are. `bode` has the joints that the settings
    show, `bode_all` every joint of the leg.
    """
    lines = {push.joint: push.sines.frequency_hz for push in pushes.values() if push.joint and push.sines}
    joints = [joint for joint in layout.limb(settings.limb) if joint in lines]
    asked: list[tuple[str | float, ...]] = []
    for method, joint, quantity in product(settings.methods, joints, QUANTITIES):
        for band_hz, frequency_hz in zip(settings.bands_hz, lines[joint], strict=True):
            cell = settings.scenario, settings.limb, settings.level, method, joint
            asked.append((quantity, frequency_hz, *cell, QUANTITIES[quantity][0].format(band_hz)))
    cells = pd.DataFrame(asked, columns=["quantity", "frequency_hz", *CELL])
    answers = numbers_of(read_scores(*scores), cells, statistics).dropna(subset="value")
    response = partial(observer_response, gain_hz=observer.gain_hz, rate_hz=rates.data_hz)
    for name, shown, row_inch in (("bode", settings.shown, SHOWN_INCH), ("bode_all", joints, ALL_INCH)):
        shown_answers = answers[answers["joint"].isin(shown)]
        save_figure(
            draw_bode(shown_answers, shown, response, row_inch),
            figure_dir / name,
            RESPONSE,
            records_of(shown_answers, RESPONSE),
        )


@styled
def draw_bode(answers: pd.DataFrame, joints: Sequence[str], response: Response, row_inch: float) -> Figure:
    """Draw a panel of gain [-] and one of phase [deg] for each joint, two joints in a row, relative to a low-pass.

    Rows of the answers are those of `RESPONSE`. An estimate without any error lies on the grey line.
    """
    styles = looks(answers["method"].unique())
    across = min(ACROSS, len(joints))
    rows = -(-len(joints) // across)
    figure = Figure(figsize=(PAGE_INCH, row_inch * rows + LEGEND_INCH), layout="constrained")
    panels = figure.subplots(rows, across * len(QUANTITIES), sharex=True, squeeze=False)
    axes: list[Axes] = panels.ravel().tolist()
    drawn = list(product(joints, QUANTITIES))
    for k, (axis, (joint, quantity)) in enumerate(zip(axes, drawn, strict=False)):
        axis.axhline(PERFECT[quantity], label=REFERENCE, **REFERENCE_LOOK)
        for method, of_method in rows_of(answers, joint=joint, quantity=quantity).groupby("method", sort=False):
            _draw(axis, of_method, str(method), styles[str(method)], response)
        axis.set_xscale("log")
        axis.set_xticks(TICKS_HZ, [f"{tick:g}" for tick in TICKS_HZ])
        axis.minorticks_off()
        axis.set(ylim=ENDS[quantity], ylabel=QUANTITIES[quantity][1])
        entitle(axis, k, f"{joint}, {quantity}")
    # The last row may have fewer joints than places.
    for axis in axes[len(drawn) :]:
        axis.set_visible(False)
    figure.supxlabel("frequency [Hz]", fontsize=STYLE["axes.labelsize"])
    legend(figure, axes)
    return figure


def _draw(axis: Axes, answers: pd.DataFrame, method: str, look: Look, response: Response) -> None:
    """Draw the relative gain [-] or phase [deg] of a method with its intervals, which the legend does not show."""
    x = answers["frequency_hz"].to_numpy()
    values = answers[["value", "low", "high"]].T.fillna(answers["value"]).to_numpy()
    perfect = response(x)
    is_gain = answers["quantity"].iloc[0] == "gain"
    mean, low, high = values / np.abs(perfect) if is_gain else values - np.angle(perfect, deg=True)
    axis.plot(x, mean, label=method, marker=look.marker, markersize=3.0, **look.line)
    axis.vlines(x, low, high, color=look.colour, linewidth=0.8, zorder=look.order)
