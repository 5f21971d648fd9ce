"""Figures 7 and 12, a hand that is loaded or pushed: joints of the upper body and of the base, and errors by method."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import pandas as pd

from experiments.evaluation.compare.curves import ZERO, compared, read_curves, without_zero
from experiments.evaluation.figures.drawing.compared import (
    bars_by_joint,
    draw_relative_columns,
    save_compared,
    with_drawn,
)
from experiments.evaluation.number.frames import ordered, read_scores
from experiments.evaluation.number.laws import measured
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.scored import CELL, joint_errors, number_of, runs_of
from experiments.intervals.crossed import Formula
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
    read = read_scores(*scores)
    errors = joint_errors(read, layout, settings, joints, settings.metric, statistics, published, settings.place)
    drawn = {joint: pair.rmse for joint, pair in zip(joints, pairs, strict=True)}
    limbs = dict(limb_of(layout, joint) for joint in joints)
    relative = relative_errors(read, layout, settings, limbs, statistics)
    by_limb = bars_by_joint(relative, {})
    titles = [limb_of(layout, joint)[0] for joint in joints]
    bars = [by_limb.get(title, []) for title in titles]
    figure = draw_relative_columns(pairs, bars, units, settings.errors_of, "time [s]", titles)
    written = pd.concat([with_drawn(errors, drawn), relative])
    save_compared(figure, figure_dir / name, [pair.torque for pair in pairs], written)


def limb_of(layout: JointLayout, joint: str) -> tuple[str, list[str]]:
    """Return the limb of a joint and its joints of the same unit; where there are others too, the name says which."""
    limb = layout.limb_of[joint]
    every = layout.limb(limb)
    alike = [each for each in every if layout.unit(each) == layout.unit(joint)]
    return (limb if len(alike) == len(every) else f"{alike[0]} to {alike[-1]}"), alike


def relative_errors(
    scores: pd.DataFrame,
    layout: JointLayout,
    settings: HandFigure,
    limbs: Mapping[str, Sequence[str]],
    statistics: Statistics,
) -> pd.DataFrame:
    """Return the mean error of each limb by method, over that of an estimate of no torque [-].

    A limb has its joints. The columns are those of `JOINT_ERRORS` up to the paper's number, a limb in place of a joint.
    """
    metric = settings.metric
    asked: list[tuple[str, ...]] = []
    for title, joints in limbs.items():
        for method in settings.methods:
            for each in (method, ZERO) if method != ZERO else ():
                for joint in joints:
                    cell = settings.scenario, layout.limb_of[joint], settings.level, each, joint, metric
                    asked.append((title, method, *cell))
    runs = runs_of(scores, pd.DataFrame(asked, columns=["title", "shown", *CELL]), may_lack=True)
    runs = ordered(runs, title=list(limbs), shown=settings.methods)

    def law(same: pd.DataFrame) -> Number:
        return replace(number_of(same, statistics, Formula(over_zero, positive=True)), unit="-")

    numbers = measured(runs, ["title", "shown"], {RELATIVE.format(metric, ZERO): law})
    names = {"title": "joint", "shown": "method", "quantity": "metric"}
    named = numbers.drop(columns="published").rename(columns=names)
    return named.astype({"joint": str, "method": str}).assign(scenario=settings.scenario, level=settings.level)


def over_zero(means: Array) -> Array:
    """Return the sum of the first half of means over that of the second half, as one number [-]."""
    count = len(means) // 2
    return (means[:count].sum(axis=0) / means[count:].sum(axis=0))[None]
