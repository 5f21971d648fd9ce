"""Errors and other measures of estimates, a row for each joint, run and metric."""

import logging
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import astuple
from itertools import groupby
from math import isnan
from pathlib import Path

import numpy as np

from mobnet.core.columns import SCORES, Score
from mobnet.core.joints import JointLayout
from mobnet.evaluation.measure.estimates import Pair, read_pair, read_std
from mobnet.evaluation.measure.holding import holding
from mobnet.evaluation.measure.measured import Measured, Measures
from mobnet.evaluation.measure.metrics import METRICS, PUSH, PUSHED, RAW, Spans, rmse
from mobnet.evaluation.measure.peaks import push_measures
from mobnet.evaluation.measure.response import responses
from mobnet.evaluation.measure.scene import Scene
from mobnet.evaluation.measure.spread import spreads
from mobnet.evaluation.measure.strata import masks_of, push_masks, stratified
from mobnet.evaluation.measure.windows import push_windows
from mobnet.evaluation.number.files import write_csv
from mobnet.plan.runs import Run
from mobnet.settings.evaluation import Runs, Scoring

log = logging.getLogger(__name__)

AVERAGE = "avg"


def score(layout: JointLayout, runs: Sequence[Run], asked: Scoring, out: Path) -> None:
    """Score every run of a test and write one CSV, a row of `Score` for each joint, run and metric.

    The error is `tau_ext` of the estimate minus `tau_ext_lp` of the residual file, the truth behind the observer's
    low-pass (15): what a residual can follow at best (section 5.1, on Figure 6). `rmse_raw` is that to `tau_ext` of the
    recording. `asked` says what else is measured, and on which runs. Rows come recording by recording.
    """
    rows: list[Score] = []
    for recording, own in groupby(sorted(runs, key=lambda run: str(run.recording)), lambda run: run.recording):
        scene = Scene(recording, layout)
        rows += [row for run in own for row in score_run(layout, run, asked, scene)]
    write_csv(out, SCORES, [astuple(row) for row in rows])
    log.info("%s: %d runs, %d rows", out, len(runs), len(rows))


def score_run(layout: JointLayout, run: Run, asked: Scoring, scene: Scene | None = None) -> list[Score]:
    """Return the rows of one run: each joint, then the average of each limb, for each metric.

    A metric has no row of a joint for which it is not defined, and none of a push that the run is too short for. A limb
    whose network has run under an earlier seed has no row: it counts once.
    """
    pair = read_pair(run, layout)
    names = run.scenario, run.level, run.method, run.network_seed, run.test_seed
    rows: list[Score] = []
    for metric, numbers, pattern, average_only in measured(pair, scene or Scene(run.recording, layout), asked):
        values = {joint: value for joint, value in zip(pair.joints, numbers.tolist(), strict=True) if not isnan(value)}
        rows += [
            Score(*names, limb, joint, metric, value, pattern.format(unit))
            for limb, joint, value, unit in limb_values(layout, values)
            if limb not in run.repeated and (joint == AVERAGE or not average_only)
        ]
    return rows


def measured(pair: Pair, scene: Scene, asked: Scoring) -> Measures:
    """Yield the measures (n,) of a run, then those of its pushes, and those that are asked for."""
    for metric, (measure, pattern) in METRICS.items():
        yield Measured(metric, measure(pair.estimate, pair.truth, pair.spans, pair.rate_hz), pattern)
    raw = scene.external[:, scene.layout.columns(pair.joints)]
    yield Measured(RAW, rmse(pair.estimate, raw, pair.spans))
    if asked.window:
        yield from _around_pushes(pair, push_windows(scene.stem, len(raw), asked.window.before_s, asked.window.after_s))
    if asked.peaks and _shown(asked.peaks.tests, pair.run):
        yield from push_measures(pair, scene, asked.peaks)
    if asked.bode and _shown([asked.bode], pair.run):
        yield from responses(pair, scene, asked.lines, asked.bode.bands_hz)
    if asked.drift and _shown(asked.drift.tests.values(), pair.run):
        yield from holding(pair, scene, asked.drift, asked.touch_down_s)
    yield from _in_parts(pair, scene, asked)


def _around_pushes(pair: Pair, windows: Spans) -> Measures:
    """Yield the error in the windows around all pushes together, and of each push alone; nothing without a push."""
    pushes = {PUSHED: windows, **{PUSH.format(k): (window,) for k, window in enumerate(windows, start=1)}}
    for metric, spans in pushes.items() if windows else ():
        yield Measured(metric, rmse(pair.estimate, pair.truth, spans))


def _in_parts(pair: Pair, scene: Scene, asked: Scoring) -> Measures:
    """Yield errors and standard deviations in parts of a walk."""
    with_errors = asked.phases and _shown(asked.phases.tests, pair.run)
    sigma = asked.sigma if asked.sigma and _shown(asked.sigma.tests.values(), pair.run) else None
    if not with_errors and not sigma:
        return
    masks = masks_of(pair, scene, asked.touch_down_s, asked.stuck_rad_s)
    if with_errors:
        yield from stratified(pair, masks)
    std = read_std(pair.run, pair.joints) if sigma else None
    if sigma and std is not None:
        yield from spreads(pair, std, {**masks, **push_masks(pair, scene)}, asked.cover_share, sigma)


def _shown(tests: Iterable[Runs], run: Run) -> bool:
    """Return whether one of a product's tests shows a run."""
    return any((t.scenario, t.level) == (run.scenario, run.level) and run.method in t.methods for t in tests)


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
