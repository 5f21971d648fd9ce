"""Errors of estimates around pushes on a leg (Figures 6 and 10): of each push, and their increase over calm walking."""

from collections.abc import Sequence

import numpy as np

from mobnet.core.columns import PUSHED, SWING, Score, foot_of
from mobnet.core.joints import JointLayout
from mobnet.evaluation.compare.curves import Panel, read_curves
from mobnet.evaluation.compare.rmse import PUSH
from mobnet.evaluation.compare.windows import push_windows
from mobnet.evaluation.number.grid import Wanted, number_of
from mobnet.evaluation.number.intervals import Formula
from mobnet.evaluation.number.number import Number, published_value
from mobnet.plan.runs import Run
from mobnet.settings.evaluation import Figure06, Figure10, PushedRuns, Runs, Statistics
from mobnet.settings.published import PublishedTable

ALL, AVERAGE, INCREASE = "all windows", "avg", "increase"  # of the windows together, the mean of each push's, and that
# mean less the error where nothing pushes
INCREASED = Formula(lambda means: means[:-1].mean(axis=0, keepdims=True) - means[-1:])  # mean of all but the last
PushErrors = dict[str, dict[str, Number]]  # method -> number of a push, ALL, AVERAGE or INCREASE -> error [N m]


def wanted_of(
    layout: JointLayout, test: Runs | PushedRuns | Figure06, method: str, joint: str, metric: str = "rmse"
) -> Wanted:
    """Return which error of a joint [N m] of a test is wanted."""
    limb = next(name for name, joints in layout.groups.items() if joint in joints)
    return Wanted(test.scenario, limb, test.level, method, joint, metric)


def collision_errors(
    layout: JointLayout, settings: Figure10, test: PushedRuns, published: PublishedTable, scores: Sequence[Score],
    statistics: Statistics,
) -> PushErrors:  # fmt: skip
    """Return the errors of a test [N m], method by method: of each push, their average, and its increase.

    Raises:
        DataError: a run is missing.
    """
    joint, metrics = settings.joint, push_metrics(scores, test.scenario)
    errors: PushErrors = {}
    for method in test.methods if metrics else ():
        own = [wanted_of(layout, test, method, joint, metric) for metric in metrics]
        calm = wanted_of(layout, settings.against, method, joint)
        printed = published_value(published, test.scenario, method, AVERAGE)
        errors[method] = {
            **{str(k): number_of(scores, [wanted], statistics) for k, wanted in enumerate(own, start=1)},
            AVERAGE: number_of(scores, own, statistics, published=printed),
            INCREASE: number_of(scores, [*own, calm], statistics, INCREASED),
        }
    return errors


def push_metrics(scores: Sequence[Score], scenario: str) -> list[str]:
    """Return the names of the errors of single pushes that a scenario was scored for, in order."""
    found = {row.metric for row in scores if row.scenario == scenario}
    return [PUSH.format(k) for k in range(1, len(found) + 1) if PUSH.format(k) in found]


def read_pushes(layout: JointLayout, settings: Figure06 | Figure10, runs: Sequence[Run], title: str) -> list[Panel]:
    """Return a panel for each push of a recording, in order: truth and estimates of a joint [N m], time from the push.

    The runs are one of each method; the number of the push takes the place of the braces in the title.

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
        panels.append(curves.panel(title.format(k), joint, slice(start, end), zero=zero))
    return panels
