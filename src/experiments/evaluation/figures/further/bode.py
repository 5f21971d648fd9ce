"""Gain and phase of every method over frequency, at each joint of a leg, beside the observer's own low-pass."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from experiments.evaluation.figures.style import LETTERS, Look, legend, looks, save_figure
from experiments.evaluation.measure.estimates.bode import GAIN, PHASE, observer_response
from experiments.evaluation.number.grid import Lookup, Wanted, read_lookup
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import Field
from experiments.settings.measures import Bode
from experiments.settings.runs import Statistics
from mobnet.core.columns import RESPONSE
from mobnet.core.joints import JointLayout
from mobnet.core.style import PAGE_INCH, STYLE, styled
from mobnet.settings.data import Push
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.plant import Rates

REFERENCE = "low-pass of (11)"  # the observer's response to what it sees without any error
REFERENCE_LOOK: Mapping[str, Any] = {"color": "0.6", "linewidth": 2.0, "zorder": 1.0}
POINTS = 200  # of the reference
TICKS_HZ = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0)
SHOWN_INCH, ALL_INCH, LEGEND_INCH = 1.75, 1.35, 0.5  # height of a row of panels, of some joints or all; of the legend
MOST_ACROSS = 3  # joints in a row
QUANTITIES = {"gain": (GAIN, "gain [-]"), "phase": (PHASE, "phase [deg]")}


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

    `bode` has the joints that the settings show, `bode_all` every joint of the leg.
    """
    lookup = read_lookup(scores, statistics)
    lines = {push.joint: push.sines.frequency_hz for push in pushes.values() if push.joint and push.sines}
    joints = [joint for joint in layout.limb(settings.limb) if joint in lines]
    answers: list[Answer] = []
    for method, joint, quantity in product(settings.methods, joints, QUANTITIES):
        answers.append(answer(lookup, settings, method, joint, quantity, lines[joint]))
    ends = min(min(own) for own in lines.values()), max(max(own) for own in lines.values())
    frequencies = np.geomspace(*ends, POINTS)
    response = observer_response(frequencies, observer.gain_hz, rates.data_hz)
    reference = frequencies, {"gain": np.abs(response), "phase": np.angle(response, deg=True)}
    for name, shown, row_inch in (("bode", settings.shown, SHOWN_INCH), ("bode_all", joints, ALL_INCH)):
        own = [one for one in answers if one.joint in shown]
        save_figure(draw_bode(own, shown, reference, row_inch), figure_dir / name, RESPONSE, rows_of(own))


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
def draw_bode(
    answers: Sequence[Answer], joints: Sequence[str], reference: tuple[Any, Mapping[str, Any]], row_inch: float
) -> Figure:
    """Draw a column of gain [-] and phase [deg] for each joint, at most three joints side by side.

    The reference is a low-pass: frequencies (n,) [Hz], and quantity -> (n,).
    """
    styles = looks(one.method for one in answers)
    across = min(MOST_ACROSS, len(joints))
    blocks = -(-len(joints) // across)
    figure = Figure(figsize=(PAGE_INCH, row_inch * 2 * blocks + LEGEND_INCH), layout="constrained")
    axes = figure.subplots(2 * blocks, across, sharex=True, squeeze=False)
    # The last block may have fewer joints than panels.
    for axis in axes.flat:
        axis.set_visible(False)
    for k, joint in enumerate(joints):
        for row, (quantity, (_, label)) in enumerate(QUANTITIES.items(), start=2 * (k // across)):
            axis: Axes = axes[row, k % across]
            axis.set_visible(True)
            axis.sharey(axes[row % 2, 0])  # a quantity has one scale
            axis.plot(reference[0], reference[1][quantity], label=REFERENCE, **REFERENCE_LOOK)
            for one in answers:
                if (one.joint, one.quantity) == (joint, quantity) and one.numbers:
                    _draw(axis, one, styles[one.method])
            axis.set_xscale("log")
            axis.set_xticks(TICKS_HZ, [f"{tick:g}" for tick in TICKS_HZ])
            axis.minorticks_off()
            if k % across == 0:
                axis.set_ylabel(label)
            if quantity == "gain":
                axis.set_title(f"({LETTERS[k]}) {joint}", loc="left", pad=3)
    axes[0, 0].set_ylim(0.0, None)
    figure.supxlabel("frequency [Hz]", fontsize=STYLE["axes.labelsize"])
    legend(figure, axes.ravel().tolist())
    return figure


def _draw(axis: Axes, one: Answer, look: Look) -> None:
    """Draw the gain [-] or phase [deg] of a method with its intervals, which the legend does not show."""
    x = list(one.numbers)
    mean, low, high = np.array([number.range for number in one.numbers.values()], dtype=np.float64).T
    axis.plot(x, mean, label=one.method, marker=look.marker, markersize=3.0, **look.line)
    axis.vlines(x, low, high, color=look.colour, linewidth=0.8, zorder=look.order)
