"""Figures 7 and 12, a hand that is loaded or pushed: joints of the upper body and of the base, and errors by method."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from experiments.evaluation.compare.curves import ZERO, compared, read_curves, without_zero
from experiments.evaluation.figures.drawing.compared import bars_of, draw_relative_columns, save_compared
from experiments.evaluation.measure.estimates.run_errors import error_rows, joint_errors
from experiments.evaluation.number.grid import Lookup, Wanted, read_lookup
from experiments.evaluation.number.intervals import Formula
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import Field
from experiments.plan.runs import Run
from experiments.settings.figures import HandFigure
from experiments.settings.published import PublishedTable
from experiments.settings.runs import Statistics
from mobnet.core.arrays import Array
from mobnet.core.columns import PUSHED
from mobnet.core.joints import JointLayout
from mobnet.settings.detection import Detection

RELATIVE = "{} over that of {}"  # metric of a limb in the CSV file


def hand_figure(
    settings: HandFigure,
    name: str,
    layout: JointLayout,
    detection: Detection,
    statistics: Statistics,
    published: PublishedTable,
    runs: Sequence[Run],
    scores: Sequence[Path],
    figure_dir: Path,
) -> None:
    """Write a figure as PDF, SVG, PNG and CSV: external torque of joints [N m], force on the base [N], and errors.

    The runs are one of each method, all of one recording, whose curves are drawn behind the low-pass of the detector;
    the bars are errors of limbs over all recordings, as shares of the error without any estimate [-].
    """
    joints = settings.joints
    curves = read_curves(layout, without_zero(runs), joints, {settings.called: PUSHED})
    curves = curves.low_passed(detection.low_pass_hz)
    start, end = (round(time_s * curves.rate_hz) for time_s in (settings.start_s, settings.end_s))
    rows = slice(start, end, settings.every)
    units = [layout.unit(joint) for joint in joints]
    pairs = [
        compared(curves.panel(f"{joint} [{unit}]", joint, rows, band=True), settings.called)
        for joint, unit in zip(joints, units, strict=True)
    ]
    lookup = read_lookup(scores, statistics)
    errors = joint_errors(lookup, layout, settings, joints, settings.metric, published, settings.place)
    drawn = {joint: pair.rmse for joint, pair in zip(joints, pairs, strict=True)}
    limbs = [limb_of(layout, joint) for joint in joints]
    relative = {limb: relative_errors(lookup, layout, settings, own) for limb, own in limbs}
    bars = [bars_of(relative[limb], {}) for limb, _ in limbs]
    figure = draw_relative_columns(pairs, bars, units, settings.errors_of, "time [s]", [limb for limb, _ in limbs])
    written = error_rows(settings, settings.metric, errors, drawn)
    written += relative_rows(settings, relative)
    save_compared(figure, figure_dir / name, [pair.torque for pair in pairs], written)


def limb_of(layout: JointLayout, joint: str) -> tuple[str, list[str]]:
    """Return the limb of a joint and its joints of the same unit; where there are others too, the name says which."""
    limb = layout.limb_of[joint]
    every = layout.limb(limb)
    own = [each for each in every if layout.unit(each) == layout.unit(joint)]
    return (limb if len(own) == len(every) else f"{own[0]} to {own[-1]}"), own


def relative_errors(
    lookup: Lookup, layout: JointLayout, settings: HandFigure, joints: Sequence[str]
) -> dict[str, Number]:
    """Return the mean error of joints by method, over that of an estimate of no torque [-]."""
    count = len(joints)

    def over(means: Array) -> Array:
        return (means[:count].sum(axis=0) / means[count:].sum(axis=0))[None]

    found: dict[str, Number] = {}
    for method in settings.methods:
        if method == ZERO:
            continue
        wanted = [
            Wanted(settings.scenario, layout.limb_of[joint], settings.level, each, joint, settings.metric)
            for each in (method, ZERO)
            for joint in joints
        ]
        found[method] = replace(lookup.number(wanted, Formula(over, positive=True)), unit="-")
    return found


def relative_rows(settings: HandFigure, relative: dict[str, dict[str, Number]]) -> list[tuple[Field, ...]]:
    """Return rows of `JOINT_ERRORS`, a limb in place of a joint."""
    metric = RELATIVE.format(settings.metric, ZERO)
    rows: list[tuple[Field, ...]] = []
    for limb, own in relative.items():
        for method, number in own.items():
            of = settings.scenario, settings.level, method, limb, metric
            rows.append((*of, *number.with_ends, *number.spread, number.unit, None, None))
    return rows
