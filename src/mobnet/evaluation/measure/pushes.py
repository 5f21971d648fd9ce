"""Errors of estimates around pushes on a leg (Figures 6 and 10): of each push, and their increase over calm walking."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.config import load_layout
from mobnet.evaluation.measure.curves import Panel, read_curves
from mobnet.evaluation.measure.gait import SWING, foot_of
from mobnet.evaluation.measure.metrics import PUSH
from mobnet.evaluation.measure.windows import push_windows
from mobnet.evaluation.number.grid import Wanted, run_grid
from mobnet.evaluation.number.intervals import Combine, mean, summarise
from mobnet.evaluation.number.published import published_value, read_published
from mobnet.evaluation.number.rows import Score

ALL, AVERAGE, INCREASE = "all windows", "avg", "increase"  # pushes of an error that is not one push's
Entries = Sequence[Mapping[str, Any]]


@dataclass(frozen=True)
class PushError:
    """One error around pushes: a row of figure_06_bars.csv and figure_10_bars.csv.

    Attributes:
        scenario: the test.
        method: estimator.
        push: number of the push in its recording; `all windows`: those together; `avg`: mean of the errors of each;
            `increase`: that mean less the error where nothing pushes.
        runs: network seeds times test seeds.
        rmse_nm: mean over runs [N m].
        low: lower end of its interval [N m]; None with a single run.
        high: upper end of its interval [N m]; None with a single run.
        published: the paper's number [N m]; None where it prints none.
    """

    scenario: str
    method: str
    push: str
    runs: int
    rmse_nm: float
    low: float | None
    high: float | None
    published: float | None


def wanted_of(
    config: Mapping[str, Any], test: Mapping[str, Any], method: str, joint: str, metric: str = "rmse"
) -> Wanted:
    """Return which error of a joint [N m] of a test (scenario, level) is wanted."""
    groups = load_layout(Path(config["robot"])).groups
    limb = next(name for name, joints in groups.items() if joint in joints)
    return Wanted(test["scenario"], limb, test["level"], method, joint, metric)


def collision_errors(
    config: Mapping[str, Any], settings: Mapping[str, Any], test: Mapping[str, Any], scores: Sequence[Score]
) -> list[PushError]:
    """Return the errors of a test [N m], method by method: of each push, their average, and its increase.

    Raises:
        DataError: a run is missing.
    """
    published, joint = read_published(Path(config["published"]), "figure_10"), settings["joint"]
    errors = []
    for method in test["methods"]:
        own = [wanted_of(config, test, method, joint, metric) for metric in push_metrics(scores, test["scenario"])]
        calm = wanted_of(config, settings["against"], method, joint)
        printed = published_value(published, test["scenario"], method, AVERAGE)
        errors += [push_error(config, wanted, str(k), [wanted], scores) for k, wanted in enumerate(own, start=1)]
        if own:
            errors.append(push_error(config, own[0], AVERAGE, own, scores, printed, mean))
            errors.append(push_error(config, own[0], INCREASE, [*own, calm], scores, None, increase))
    return errors


def push_metrics(scores: Sequence[Score], scenario: str) -> list[str]:
    """Return the names of the errors of single pushes that a scenario was scored for, in order."""
    found = {row.metric for row in scores if row.scenario == scenario}
    return [PUSH.format(k) for k in range(1, len(found) + 1) if PUSH.format(k) in found]


def push_error(
    config: Mapping[str, Any],
    test: Wanted,
    push: str,
    wanted: Sequence[Wanted],
    scores: Sequence[Score],
    published: float | None = None,
    combine: Combine = mean,
) -> PushError:
    """Return a number made of errors [N m] of the runs of a test, with its interval.

    Raises:
        DataError: a run is missing.
    """
    ours = summarise([run_grid(scores, one) for one in wanted], config, combine)
    return PushError(test.scenario, test.method, push, ours.count, ours.value, ours.low, ours.high, published)


def increase(means: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the mean of all errors but the last, less the last, (n, ...) -> (...) [N m]."""
    return means[:-1].mean(axis=0) - means[-1]


def read_pushes(config: Mapping[str, Any], settings: Mapping[str, Any], entries: Entries, title: str) -> list[Panel]:
    """Return a panel for each push of a recording, in order: truth and estimates of a joint [N m], time from the push.

    Args:
        config: resolved configuration: `robot`.
        settings: joint, before_s and after_s [s]: what is shown around a push.
        entries: a mapping a method, all of one recording.
        title: of the panels; the number of the push takes the place of the braces.

    Raises:
        DataError: a file is missing or damaged.
        ConfigError: the joint belongs to no leg, or is not estimated.
    """
    robot, joint = Path(config["robot"]), settings["joint"]
    curves = read_curves(robot, entries, [joint], {"swing": SWING + foot_of(robot, joint), "push": "pushed"})
    recording = Path(entries[0]["recording"])
    windows = push_windows(recording, len(curves.truth), settings["before_s"], settings["after_s"])
    panels = []
    for k, (start, end) in enumerate(windows, start=1):
        zero = start + int(np.argmax(curves.flags["push"][start:end]))
        panels.append(curves.panel(title.format(k), joint, slice(start, end), zero=zero))
    return panels
