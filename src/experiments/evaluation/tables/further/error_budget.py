"""What an observer's error is made of: its error with every source on, and how much goes with one of them off."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from experiments.evaluation.compare.rmse import PERCENT
from experiments.evaluation.number.frames import ordered, read_scores, records_of
from experiments.evaluation.number.laws import measured
from experiments.evaluation.number.number import Number, interval_text, number_text
from experiments.evaluation.number.scored import columns_of, number_of, runs_of
from experiments.evaluation.tables.layout import RULE, Line, Table, write_table
from experiments.intervals.crossed import Array, Formula
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import ERRORS, RUN
from experiments.settings.tables import ErrorBudget
from mobnet.core.joints import JointLayout

METRIC = "rmse"
GONE = "gone"
DIGITS = {METRIC: 2, GONE: 0}
SIGN = {METRIC: "", GONE: " %"}
PLACE = ["column", "label"]  # of a number: a joint or a mean, and the test


def error_budget(
    settings: ErrorBudget,
    statistics: Statistics,
    layout: JointLayout,
    scores: Sequence[Path],
    table_dir: Path,
) -> None:
    """Write error_budget.csv, .tex and .md: RMSE [N m] of joints with one source of error off, and the share [%] gone.

    The first test of `settings` has every source on.
    """
    tests = pd.DataFrame([(test.label, test.scenario, test.level, *test.methods) for test in settings.tests])
    tests.columns = ["label", *RUN]
    columns = columns_of(layout, settings.joints)
    cells = tests.merge(columns, how="cross").assign(metric=METRIC)
    runs = ordered(runs_of(read_scores(*scores), cells), label=list(tests["label"]))
    numbers = numbers_of(runs, statistics)
    first, *others = tests["label"]
    header = ["Joint", "Unit", first]
    for label in others:
        header += [label, GONE]
    rows = numbers.assign(joint=numbers["column"], metric=numbers["quantity"], label=numbers["label"].astype(str))
    rows = rows.merge(tests, how="left", on="label")
    joints = columns["column"].value_counts()
    means = list(joints[joints > 1].index)
    lines = budget_lines(numbers, means, statistics.confidence)
    write_table(table_dir / "error_budget", Table(ERRORS, records_of(rows, ERRORS), header, lines, left=2))


def numbers_of(runs: pd.DataFrame, statistics: Statistics) -> pd.DataFrame:
    """Return the RMSE [N m] of each joint or mean, test by test, and the share [%] of its square that is gone."""
    every = runs[runs["label"] == runs["label"].iloc[0]]
    one_off = runs[runs["label"] != runs["label"].iloc[0]]
    gone_of = Formula(share_left, lambda left: PERCENT * (1.0 - left), positive=True)

    def gone(part: pd.DataFrame) -> Number:
        full = every[every["column"] == part["column"].iloc[0]]
        squares = pd.concat([full, part])
        squares["value"] = squares["value"] ** 2
        return replace(number_of(squares, statistics, gone_of), unit="%")

    errors = measured(runs, PLACE, {METRIC: lambda same: number_of(same, statistics)})
    shares = measured(one_off, PLACE, {GONE: gone})
    return pd.concat([errors, shares]).sort_values(PLACE, kind="stable", ignore_index=True)


def share_left(means: Array) -> Array:
    """Return the sum of the last half of squares (2 n, ...) over that of the first half, (1, ...) [-]."""
    before, after = np.split(means, 2)
    return after.sum(axis=0, keepdims=True) / before.sum(axis=0, keepdims=True)


def budget_lines(numbers: pd.DataFrame, means: Sequence[str], confidence: float) -> list[Line]:
    """Return the lines of text, RMSE [N m] and share gone [%] in turn; intervals and a rule below each mean."""
    lines: list[Line] = []
    for name, of_column in numbers.groupby("column", observed=True):
        texts: list[str] = []
        intervals: list[str] = []
        for metric, value, low, high in of_column[["quantity", "value", "low", "high"]].itertuples(index=False):
            texts.append(number_text(value, DIGITS[metric]) + SIGN[metric])
            intervals.append(interval_text(low, high, DIGITS[metric]))
        lines.append([str(name), of_column["unit"].iloc[0], *texts])
        if name in means:
            lines += [[f"{confidence:.0%}", "", *intervals]] if intervals[0] else []
            lines.append(RULE)
    return lines[:-1] if lines[-1] == RULE else lines
