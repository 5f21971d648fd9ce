"""Errors of estimates against the low-passed truth, a row for each joint, run and metric."""

import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import astuple
from itertools import groupby
from math import isnan
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import SCORES, Score
from mobnet.core.joints import JointLayout
from mobnet.evaluation.measure.estimates import Pair, read_pair
from mobnet.evaluation.measure.metrics import METRICS, PUSH, PUSHED, Spans, rmse
from mobnet.evaluation.measure.windows import push_windows
from mobnet.evaluation.number.files import write_csv
from mobnet.plan.runs import Run
from mobnet.settings.evaluation import Window

log = logging.getLogger(__name__)

AVERAGE = "avg"


def score(layout: JointLayout, runs: Sequence[Run], window: Window | None, out: Path) -> None:
    """Score every run of a test and write one CSV, a row of `Score` for each joint, run and metric.

    The error is `tau_ext` of the estimate minus `tau_ext_lp` of the residual file, the truth behind the observer's
    low-pass (15): what a residual can follow at best (section 5.1, on Figure 6). Pushes have a window where they count.
    """
    rows = [row for run in runs for row in score_run(layout, run, window)]
    write_csv(out, SCORES, [astuple(row) for row in rows])
    log.info("%s: %d runs, %d rows", out, len(runs), len(rows))


def score_run(layout: JointLayout, run: Run, window: Window | None = None) -> list[Score]:
    """Return the rows of one run: each joint, then the average of each limb, for each metric.

    A metric has no row of a joint for which it is not defined, and none of a push that the run is too short for.
    """
    pair = read_pair(run, layout)
    names = run.scenario, run.level, run.method, run.network_seed, run.test_seed
    rows: list[Score] = []
    windows = push_windows(run.recording, len(pair.truth), window.before_s, window.after_s) if window else ()
    for metric, numbers, pattern in measured(pair, windows):
        values = {joint: value for joint, value in zip(pair.joints, numbers.tolist(), strict=True) if not isnan(value)}
        for limb, joint, value, unit in limb_values(layout, values):
            rows.append(Score(*names, limb, joint, metric, value, pattern.format(unit)))
    return rows


def measured(pair: Pair, windows: Spans) -> Iterator[tuple[str, NDArray[np.float64], str]]:
    """Yield metric, numbers (n,) [N m, or the metric's unit] and the unit's pattern: of a run, then of its pushes."""
    for metric, (measure, pattern) in METRICS.items():
        yield metric, measure(pair.estimate, pair.truth, pair.spans, pair.rate_hz), pattern
    pushes = {PUSHED: windows, **{PUSH.format(k): (window,) for k, window in enumerate(windows, start=1)}}
    for metric, spans in pushes.items() if windows else ():
        yield metric, rmse(pair.estimate, pair.truth, spans), METRICS["rmse"][1]


def limb_values(layout: JointLayout, values: Mapping[str, float]) -> list[tuple[str, str, float, str]]:
    """Return (limb, joint or `avg`, value, unit) of the joints' numbers given [N m], V1..V3 [N], limb by limb.

    The virtual joints have two averages, of N and of N m, as in Table 6.
    """
    rows: list[tuple[str, str, float, str]] = []
    for limb, members in layout.groups.items():
        present = [joint for joint in members if joint in values]
        rows += [(limb, joint, values[joint], layout.unit(joint)) for joint in present]
        for unit, same in groupby(present, key=layout.unit):
            rows.append((limb, AVERAGE, float(np.mean([values[joint] for joint in same])), unit))
    return rows
