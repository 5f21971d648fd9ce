"""Errors of estimates around pushes on a leg (Figures 6 and 10): of each push, and their increase over calm walking."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.config import load_layout
from mobnet.evaluation.bars import BarPanel
from mobnet.evaluation.intervals import Combine, mean, summarise
from mobnet.evaluation.metrics import PUSH
from mobnet.evaluation.published import published_value, read_published
from mobnet.evaluation.rows import Score
from mobnet.evaluation.runs import Wanted, run_grid

ALL, AVERAGE, INCREASE = "all windows", "avg", "increase"  # pushes of an error that is not one push's
MINUS = "\N{MINUS SIGN}"


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


def bar_panel(title: str, errors: Sequence[PushError], source: str = "paper") -> BarPanel:
    """Return a panel: a group for each push and for what is made of all, in each a bar a method [N m].

    Args:
        title: of the panel.
        errors: method by method, those of an increase last.
        source: name of the paper's numbers.
    """
    shown = [error for error in errors if error.push != INCREASE]
    rows = by_method(shown)
    return BarPanel(
        title,
        list(dict.fromkeys(error.push for error in shown)),
        {method: np.array([error.rmse_nm for error in row]) for method, row in rows.items()},
        {method: spans_of(row) for method, row in rows.items()},
        {method: printed_of(row) for method, row in rows.items()},
        source,
        {method: notes_of(row) for method, row in by_method(errors).items()},
    )


def by_method(errors: Iterable[PushError]) -> dict[str, list[PushError]]:
    """Return method -> its errors, in order."""
    rows: dict[str, list[PushError]] = {}
    for error in errors:
        rows.setdefault(error.method, []).append(error)
    return rows


def spans_of(errors: Sequence[PushError]) -> NDArray[np.float64]:
    """Return the ends of errors' intervals (2, n) [N m], the error itself where it has none."""
    ends = [(e.rmse_nm, e.rmse_nm) if e.low is None or e.high is None else (e.low, e.high) for e in errors]
    return np.array(ends).T


def printed_of(errors: Sequence[PushError]) -> NDArray[np.float64]:
    """Return the paper's numbers (n,) [N m]; nan where it prints none."""
    return np.array([np.nan if error.published is None else error.published for error in errors])


def notes_of(errors: Sequence[PushError]) -> list[str]:
    """Return what stands above a method's bars: at the last its error [N m] and, if that is known, its increase."""
    *own, last = errors
    text = f"{last.rmse_nm:.1f}"
    if last.push == INCREASE:
        *own, average = own
        text = f"{average.rmse_nm:.1f} ({last.rmse_nm:+.1f})"
    return [""] * len(own) + [text.replace("-", MINUS)]
