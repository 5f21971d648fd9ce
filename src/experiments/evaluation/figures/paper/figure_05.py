"""Figure 5: one gait cycle of one joint at each uncertainty level: torque and errors by method, RMSE of all walks."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby
from pathlib import Path

import pandas as pd

from experiments.evaluation.compare.curves import Compared, Panel, compared, read_cycle, without_zero
from experiments.evaluation.figures.drawing.compared import bars_of, draw_stack, save_compared, with_drawn
from experiments.evaluation.figures.drawing.named_bars import NamedBar
from experiments.evaluation.measure.estimates.run_errors import ERROR
from experiments.evaluation.number.frames import read_scores
from experiments.evaluation.number.laws import numbers_by
from experiments.evaluation.number.scored import joint_errors
from experiments.plan.runs import Run
from experiments.settings.figures import Figure05
from experiments.settings.published import PublishedTable
from experiments.settings.runs import Runs, Statistics
from mobnet.core.joints import JointLayout


def figure_05(
    settings: Figure05,
    start_s: float,
    layout: JointLayout,
    statistics: Statistics,
    published: PublishedTable,
    runs: Sequence[Run],
    scores: Sequence[Path],
    figure_dir: Path,
) -> None:
    """Write Figure 5 as PDF, SVG, PNG and CSV: torque of one joint and errors over a gait cycle [N m] at each level.

    Its bars are errors over all walks.
    """
    joint = settings.joint
    read = read_scores(*scores)
    pairs: list[Compared] = []
    bars: list[NamedBar] = []
    rows: list[pd.DataFrame] = []
    for level, of_level in groupby(runs, lambda run: run.level):
        pair = compared(read_panel(layout, without_zero(of_level), joint, start_s))
        test = Runs(scenario=settings.scenario, level=level, methods=settings.panels[level])
        errors = joint_errors(read, layout, test, [joint], ERROR, statistics, published, level)
        short = f", {level.replace('_', ' ')}" if len(test.methods) == 1 else ""
        pairs.append(pair)
        bars += [replace(bar, name=bar.name + short) for bar in bars_of(numbers_by(errors, "method"), pair.rmse)]
        rows.append(with_drawn(errors, {joint: pair.rmse}))
    figure = draw_stack(pairs, bars, settings.errors_of, "RMSE over all walks", joint)
    save_compared(figure, figure_dir / "figure_05", [pair.torque for pair in pairs], pd.concat(rows))


def read_panel(layout: JointLayout, runs: Sequence[Run], joint: str, start_s: float) -> Panel:
    """Return truth and estimates of the runs of a level [N m]: the first whole gait cycle after the start [s]."""
    curves, rows = read_cycle(layout, runs, [joint], start_s)
    return curves.panel(runs[0].level.replace("_", " "), joint, rows, zero=rows.start)
