"""Estimates around pushes on a leg (Figures 6 and 10): curves, errors of each push and over calm walking, responses."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from experiments.evaluation.compare.curves import Panel, read_curves
from experiments.evaluation.compare.rmse import PUSH
from experiments.evaluation.compare.windows import push_windows
from experiments.evaluation.measure.estimates.peaks import DELAY, OBSERVER, SHARE
from experiments.evaluation.measure.estimates.run_errors import ERROR
from experiments.evaluation.number.frames import rows_of
from experiments.evaluation.number.laws import measured
from experiments.evaluation.number.number import Number, published_value
from experiments.evaluation.number.scored import AVERAGE, number_of, runs_of
from experiments.intervals.crossed import MEAN, Formula
from experiments.plan.runs import Run
from experiments.settings.figures import Figure06, Figure10
from experiments.settings.published import PublishedTable
from experiments.settings.runs import PushedRuns, Statistics
from mobnet.core.columns import PUSHED, SWING, foot_of
from mobnet.core.joints import JointLayout

INCREASE = "increase"  # the mean of the errors of pushes less the error where nothing pushes
INCREASED = Formula(lambda means: means[:-1].mean(axis=0, keepdims=True) - means[-1:])  # mean of all but the last


def push_numbers(
    scores: pd.DataFrame,
    layout: JointLayout,
    settings: Figure10,
    test: PushedRuns,
    published: PublishedTable,
    statistics: Statistics,
) -> pd.DataFrame:
    """Return what is known of the pushes of a test, columns `PUSH_ERRORS`, method by method; nothing without a push.

    These are errors [N m] of each push, their average and its increase over calm walking, and for all pushes together
    the share that the method shows [-] and the delay of its rise [ms], as `peaks` measures.
    """
    metrics = push_metrics(scores, test.scenario)
    against = settings.against
    errors = [(str(k), [metric]) for k, metric in enumerate(metrics, start=1)]
    asked: list[tuple[str, ...]] = []
    for method in test.methods if metrics else ():
        for push, names in (*errors, (AVERAGE, metrics), (INCREASE, metrics)):
            asked += [(method, push, ERROR, test.scenario, test.level, metric) for metric in names]
        # The last of these cells is subtracted.
        asked.append((method, INCREASE, ERROR, against.scenario, against.level, ERROR))
        for metric in (SHARE, DELAY, DELAY + OBSERVER):
            asked.append((method, AVERAGE, metric, test.scenario, test.level, metric))
    place = ["method", "push", "measure"]
    cells = pd.DataFrame(asked, columns=[*place, "scenario", "level", "metric"])
    cells = cells.assign(limb=layout.limb_of[settings.joint], joint=settings.joint)
    row = cells.groupby(place, sort=False).ngroup()
    runs = runs_of(scores, cells.assign(row=row), may_lack=True)

    def law(same: pd.DataFrame) -> Number:
        formula = INCREASED if same["push"].iloc[0] == INCREASE else MEAN
        return number_of(same, statistics, formula)

    numbers = measured(runs, ["row"], {"": law}).drop(columns="published")
    rows = pd.concat([cells[place].drop_duplicates(ignore_index=True), numbers], axis=1)
    averages = (rows["push"] == AVERAGE) & (rows["measure"] == ERROR)
    printed = [published_value(published, test.scenario, method, AVERAGE) for method in rows["method"]]
    return rows.assign(scenario=test.scenario, published=pd.Series(printed, dtype=float).where(averages))


def push_metrics(scores: pd.DataFrame, scenario: str) -> list[str]:
    """Return the names of the errors of single pushes that a scenario was scored for, in order."""
    scored = set(rows_of(scores, scenario=scenario)["metric"])
    return [PUSH.format(k) for k in range(1, len(scored) + 1) if PUSH.format(k) in scored]


def read_pushes(
    layout: JointLayout, settings: Figure06 | Figure10, runs: Sequence[Run], title: str, *, band: bool = False
) -> list[Panel]:
    """Return a panel for each push of a recording, in order: truth and estimates of a joint [N m], time from the push.

    The runs are one of each method; the number of the push takes the place of the braces in the title. With `band`, a
    standard deviation is shown where a method predicts it.

    Raises:
        DataError: a file is missing or damaged.
        ConfigError: the joint belongs to no leg, or is not estimated.
    """
    joint = settings.joint
    curves = read_curves(layout, runs, [joint], {"swing": f"{SWING}.{foot_of(layout, joint)}", "push": PUSHED})
    windows = push_windows(runs[0].recording, len(curves.truth), settings.before_s, settings.after_s)
    panels = []
    for k, (start, end) in enumerate(windows, start=1):
        zero = start + int(np.argmax(curves.flags["push"][start:end]))
        panels.append(curves.panel(title.format(k), joint, slice(start, end), zero=zero, band=band))
    return panels
