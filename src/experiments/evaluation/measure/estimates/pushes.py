"""Estimates around pushes on a leg (Figures 6 and 10): curves, errors of each push and over calm walking, responses."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from experiments.evaluation.compare.curves import Panel, read_curves
from experiments.evaluation.compare.rmse import PUSH
from experiments.evaluation.compare.windows import push_windows
from experiments.evaluation.measure.estimates.peaks import DELAY, OBSERVER, SHARE
from experiments.evaluation.measure.estimates.run_errors import ERROR
from experiments.evaluation.number.grid import AVERAGE, Lookup, Wanted
from experiments.evaluation.number.intervals import Formula
from experiments.evaluation.number.number import Number, published_value
from experiments.plan.runs import Run
from experiments.settings.figures import Figure06, Figure10
from experiments.settings.published import PublishedTable
from experiments.settings.runs import PushedRuns, Runs
from mobnet.core.columns import PUSHED, SWING, foot_of
from mobnet.core.joints import JointLayout

INCREASE = "increase"  # the mean of the errors of pushes less the error where nothing pushes
INCREASED = Formula(lambda means: means[:-1].mean(axis=0, keepdims=True) - means[-1:])  # mean of all but the last
PushErrors = dict[str, dict[str, Number]]  # method -> number of a push, AVERAGE or INCREASE -> error [N m]
Responses = Mapping[
    str, Mapping[str, Number]
]  # method -> share of pushes [-], delay of the rise and the observer's [ms]


def wanted_of(layout: JointLayout, test: Runs, method: str, joint: str, metric: str = ERROR) -> Wanted:
    """Return which number of a joint of a test is wanted, an error [N m] if no metric is named."""
    return Wanted(test.scenario, layout.limb_of[joint], test.level, method, joint, metric)


def collision_errors(
    layout: JointLayout, settings: Figure10, test: PushedRuns, published: PublishedTable, lookup: Lookup
) -> PushErrors:
    """Return the errors of a test [N m], method by method: of each push, their average, and its increase."""
    joint = settings.joint
    metrics = push_metrics(lookup, test.scenario)
    errors: PushErrors = {}
    for method in test.methods if metrics else ():
        own = [wanted_of(layout, test, method, joint, metric) for metric in metrics]
        calm = wanted_of(layout, settings.against, method, joint)
        printed = published_value(published, test.scenario, method, AVERAGE)
        errors[method] = {
            **{str(k): lookup.number([wanted]) for k, wanted in enumerate(own, start=1)},
            AVERAGE: replace(lookup.number(own), published=printed),
            INCREASE: lookup.number([*own, calm], INCREASED),
        }
    return errors


def push_metrics(lookup: Lookup, scenario: str) -> list[str]:
    """Return the names of the errors of single pushes that a scenario was scored for, in order."""
    found = {wanted.metric for wanted in lookup.scores if wanted.scenario == scenario}
    return [PUSH.format(k) for k in range(1, len(found) + 1) if PUSH.format(k) in found]


def responses_of(layout: JointLayout, lookup: Lookup, test: PushedRuns, joint: str) -> Responses:
    """Return the share of the pushes that each method shows [-] and the delay of its rise [ms], as `peaks` measures."""
    found: dict[str, dict[str, Number]] = {}
    for method in test.methods:
        numbers: dict[str, Number] = {}
        for metric in (SHARE, DELAY, DELAY + OBSERVER):
            numbers[metric] = lookup.number([wanted_of(layout, test, method, joint, metric)])
        found[method] = numbers
    return found


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
