"""Errors and other measures of estimates, a row for each joint, run and metric."""

import logging
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import astuple
from itertools import groupby
from math import isnan
from pathlib import Path

import numpy as np

from mobnet.core.columns import SCORES, Score
from mobnet.core.joints import JointLayout
from mobnet.core.metrics import unit_of_metric
from mobnet.evaluation.compare.errors import LABELLED, METRICS, PUSH, PUSHED, RAW, rmse
from mobnet.evaluation.compare.pair import Pair, read_pair, read_std
from mobnet.evaluation.compare.scene import Scene
from mobnet.evaluation.compare.values import Measured, Measures
from mobnet.evaluation.compare.windows import push_windows
from mobnet.evaluation.measure.estimates.bode import responses
from mobnet.evaluation.measure.estimates.changed import knowledge
from mobnet.evaluation.measure.estimates.drift import holding
from mobnet.evaluation.measure.estimates.peaks import push_measures
from mobnet.evaluation.measure.estimates.phases import parts_of, push_parts, stratified
from mobnet.evaluation.measure.estimates.sigma import spreads
from mobnet.evaluation.number.files import write_csv
from mobnet.plan.runs import Run
from mobnet.settings.evaluation import LimbRuns, Runs, Scoring, Window

log = logging.getLogger(__name__)

AVERAGE, ERROR = "avg", "rmse"


def score(layout: JointLayout, runs: Sequence[Run], asked: Scoring, out: Path) -> None:
    """Score every run of a test and write one CSV, a row of `Score` for each joint, run and metric.

    The error is `tau_ext` of the estimate minus `tau_ext_lp` of the residual file, the truth behind the observer's
    low-pass (15): what a residual can follow at best (section 5.1, on Figure 6). `rmse_raw` is that to `tau_ext` of the
    recording. `asked` says what else is measured, and on which runs. Rows come recording by recording.
    """
    rows: list[Score] = []
    for recording, own in groupby(sorted(runs, key=lambda run: str(run.recording)), lambda run: run.recording):
        scene = Scene(recording, layout, asked.touch_down_s)
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
    for part, measures in measured(pair, scene or Scene(run.recording, layout, asked.touch_down_s), asked):
        for metric, numbers, average_only in measures:
            values = dict(zip(part.joints, numbers.tolist(), strict=True))
            rows += [
                Score(*names, limb, joint, metric, value, unit_of_metric(metric, unit))
                for limb, joint, value, unit in limb_values(layout, {k: v for k, v in values.items() if not isnan(v)})
                if limb not in run.repeated and (joint == AVERAGE or not average_only)
            ]
    return rows


def measured(pair: Pair, scene: Scene, asked: Scoring) -> Iterator[tuple[Pair, Measures]]:
    """Yield the measures of a run, and those that are asked for of it, each with the joints that it has."""
    yield pair, errors(pair, scene, asked.window)
    if asked.peaks and (part := shown(pair, scene.layout, asked.peaks.tests)):
        yield part, push_measures(part, scene, asked.peaks)
    if asked.bode and (part := shown(pair, scene.layout, [asked.bode], [asked.bode.limb])):
        yield part, responses(part, scene, asked.lines, asked.bode.bands_hz)
    if asked.drift and (part := shown(pair, scene.layout, asked.drift.tests.values(), [asked.drift.limb])):
        yield part, holding(part, scene, asked.drift)
    if asked.phases and (part := shown(pair, scene.layout, asked.phases.tests)):
        yield part, stratified(part, parts_of(part, scene, asked.stuck_rad_s))
    if asked.sigma and (part := shown(pair, scene.layout, asked.sigma.tests.values())):
        masks = {**parts_of(part, scene, asked.stuck_rad_s), **push_parts(part, scene)}
        yield part, spreads(part, read_std(part.run, part.joints), masks, asked.cover_share, asked.sigma)
    if asked.changed and (part := shown(pair, scene.layout, asked.changed.tests.values())):
        yield part, knowledge(part, read_std(part.run, part.joints), scene, asked.cover_share, asked.changed)


def errors(pair: Pair, scene: Scene, window: Window | None) -> Measures:
    """Yield the errors of a whole run, then those around its pushes, together and one by one.

    Those against the raw truth and against the label of foot sensors have endings of their own.
    """
    for metric, measure in METRICS.items():
        yield Measured(metric, measure(pair.estimate, pair.truth, pair.spans, pair.rate_hz))
    raw = scene.external[:, scene.layout.columns(pair.joints)]
    yield Measured(ERROR + RAW, rmse(pair.estimate, raw, pair.spans))
    if pair.label is not None:
        yield Measured(ERROR + LABELLED, rmse(pair.estimate, pair.label, pair.spans))
    windows = push_windows(scene.stem, len(raw), window.before_s, window.after_s) if window else ()
    pushes = {PUSHED: windows, **{PUSH.format(k): (one,) for k, one in enumerate(windows, start=1)}}
    for metric, spans in pushes.items() if windows else ():
        for ending, truth in (("", pair.truth), (RAW, raw)):
            yield Measured(metric + ending, rmse(pair.estimate, truth, spans))


def shown(
    pair: Pair, layout: JointLayout, tests: Iterable[Runs | LimbRuns], limbs: Sequence[str] = ()
) -> Pair | None:  # fmt: skip
    """Return the joints of a run that a product shows, of some limbs or those of its test; None if it shows none."""
    run = pair.run
    for test in tests:
        if (test.scenario, test.level) == (run.scenario, run.level) and run.method in test.methods:
            named = test.limbs if isinstance(test, LimbRuns) else limbs
            return pair.only(layout.limbs(named))
    return None


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
