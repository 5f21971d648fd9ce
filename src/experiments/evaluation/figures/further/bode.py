"""Gain and phase of every method over frequency, at each joint of a leg, against the observer's own low-pass."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from experiments.evaluation.figures.style import Look, entitle, legend, looks, save_figure
from experiments.evaluation.measure.estimates.bode import GAIN, PHASE, observer_response
from experiments.evaluation.number.grid import Lookup, Wanted, read_lookup
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import Field
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


@dataclass(frozen=True)
class Answer:
    """What a method makes of the sines on a joint: at each frequency [Hz] its gain [-] or phase [deg]."""

    method: str
    joint: str
    quantity: str
    numbers: Mapping[float, Number]


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
    lookup = read_lookup(scores, statistics)
    lines = {push.joint: push.sines.frequency_hz for push in pushes.values() if push.joint and push.sines}
    joints = [joint for joint in layout.limb(settings.limb) if joint in lines]
    answers: list[Answer] = []
    for method, joint, quantity in product(settings.methods, joints, QUANTITIES):
        answers.append(answer(lookup, settings, method, joint, quantity, lines[joint]))
    response = partial(observer_response, gain_hz=observer.gain_hz, rate_hz=rates.data_hz)
    for name, shown, row_inch in (("bode", settings.shown, SHOWN_INCH), ("bode_all", joints, ALL_INCH)):
        own = [one for one in answers if one.joint in shown]
        save_figure(draw_bode(own, shown, response, row_inch), figure_dir / name, RESPONSE, rows_of(own))


def answer(lookup: Lookup, settings: Bode, method: str, joint: str, quantity: str, lines: Sequence[float]) -> Answer:
    """Return gain [-] or phase [deg] of a method at a joint's lines [Hz]."""
    numbers = {}
    for band_hz, frequency_hz in zip(settings.bands_hz, lines, strict=True):
        metric = QUANTITIES[quantity][0].format(band_hz)
        found = lookup.number([Wanted(settings.scenario, settings.limb, settings.level, method, joint, metric)])
        if found.value is not None:
            numbers[frequency_hz] = found
    return Answer(method, joint, quantity, numbers)


def rows_of(answers: Sequence[Answer]) -> Iterator[tuple[Field, ...]]:
    """Yield the rows of bode.csv."""
    for one in answers:
        for frequency_hz, number in one.numbers.items():
            of = one.method, one.joint, frequency_hz, one.quantity
            yield (*of, *number.with_ends, *number.spread, number.unit)


@styled
def draw_bode(answers: Sequence[Answer], joints: Sequence[str], response: Response, row_inch: float) -> Figure:
    """Draw a panel of gain [-] and one of phase [deg] for each joint, two joints in a row, relative to a low-pass.

    An estimate without any error lies on the grey line.
    """
    styles = looks(one.method for one in answers)
    across = min(ACROSS, len(joints))
    rows = -(-len(joints) // across)
    figure = Figure(figsize=(PAGE_INCH, row_inch * rows + LEGEND_INCH), layout="constrained")
    panels = figure.subplots(rows, across * len(QUANTITIES), sharex=True, squeeze=False)
    axes: list[Axes] = panels.ravel().tolist()
    drawn = list(product(joints, QUANTITIES))
    for k, (axis, (joint, quantity)) in enumerate(zip(axes, drawn, strict=False)):
        axis.axhline(PERFECT[quantity], label=REFERENCE, **REFERENCE_LOOK)
        for one in answers:
            if (one.joint, one.quantity) == (joint, quantity) and one.numbers:
                _draw(axis, one, styles[one.method], response)
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


def _draw(axis: Axes, one: Answer, look: Look, response: Response) -> None:
    """Draw the relative gain [-] or phase [deg] of a method with its intervals, which the legend does not show."""
    x = np.array(list(one.numbers))
    values = np.array([number.range for number in one.numbers.values()], dtype=np.float64).T
    perfect = response(x)
    is_gain = one.quantity == "gain"
    mean, low, high = values / np.abs(perfect) if is_gain else values - np.angle(perfect, deg=True)
    axis.plot(x, mean, label=one.method, marker=look.marker, markersize=3.0, **look.line)
    axis.vlines(x, low, high, color=look.colour, linewidth=0.8, zorder=look.order)
