"""The push of `evaluation.story`: what the robot does, what it estimates of the push, and what its detector says."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from experiments.evaluation.compare.curves import Curves, read_curves
from experiments.evaluation.compare.pair import read_pair
from experiments.evaluation.compare.rmse import rmse
from experiments.evaluation.compare.scene import Scene, shown_pushes
from experiments.evaluation.measure.detection.results import rows_of
from experiments.evaluation.measure.estimates.felt import Felt, felt_of
from experiments.evaluation.measure.estimates.peaks import push_rows
from experiments.plan.detection import Detections
from experiments.plan.runs import Run
from experiments.settings.measures import Peaks, Scoring
from experiments.settings.pages import Story
from mobnet.core.arrays import Array
from mobnet.core.columns import PUSH, SWING, foot_of, named
from mobnet.core.detections import Collision, Detected
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.core.recording import read_sensed
from mobnet.core.store import read_array


@dataclass(frozen=True)
class Told:
    """The push of the story, from some time before it to some time after it, in (T,) samples.

    Attributes:
        rows: where that stands in the recording.
        time_s: from the beginning of the push on (T,) [s].
        q: position of the robot, as it senses it (T, nq) [m, -, rad].
        force: force of the push (T, 3) [N], world axes.
        curves: truth and estimates of the joint over the whole recording [N m].
        felt: method -> what it shows of the push.
        errors_nm: method -> its root-mean-square error from `settle_s` on [N m].
        collision: the push, as its file says.
        detected: what the detector says of it.
    """

    rows: slice
    time_s: Array
    q: Array
    force: Array
    curves: Curves
    felt: Mapping[str, Felt]
    errors_nm: Mapping[str, float]
    collision: Collision
    detected: Detected


def read_story(
    story: Story, peaks: Peaks, layout: JointLayout, runs: Sequence[Run], detections: Detections, kind: str
) -> Told:
    """Read the push of a story from its runs, one of each method; `kind` is the rule of the detector's thresholds.

    Raises:
        DataError: a file is missing or damaged, or the run has no such push.
    """
    hit, found = _hit(story, detections, runs[0].test_seed, kind)
    stem = runs[0].recording
    curves = read_curves(layout, runs, [story.joint], {SWING: f"{SWING}.{foot_of(layout, story.joint)}"})
    start = round(hit.start_s * curves.rate_hz)
    before, after = (round(time_s * curves.rate_hz) for time_s in (story.before_s, story.after_s))
    rows = slice(max(0, start - before), min(len(curves.truth), start + after))
    felt = {run.method: _felt(run, story.joint, peaks, layout, start) for run in runs}
    judged = slice(rows.start + round(story.settle_s * curves.rate_hz), rows.stop)  # as the demo, which begins there
    errors = {run.method: _error_nm(run, story.joint, layout, judged) for run in runs}
    return Told(
        rows,
        (np.arange(rows.start, rows.stop) - start) / curves.rate_hz,
        read_sensed(stem, layout).sensed.q[rows].astype(np.float64),
        read_array(stem, named(PUSH, [f"force_{axis}" for axis in "xyz"]))[0][rows].astype(np.float64),
        curves,
        felt,
        errors,
        hit,
        found,
    )


def _hit(story: Story, detections: Detections, seed: int, kind: str) -> tuple[Collision, Detected]:
    """Return the push of a story and what its detector says of it."""
    held = {"scenario": story.scenario}
    pushes = [row for row in rows_of(detections, [story.level], "collisions", Collision, **held) if row.seed == seed]
    hits = [row for row in pushes if row.push == story.push]
    if not hits:
        raise DataError(not_accepted(f"push of s{seed} of {story.scenario}", story.push, [row.push for row in pushes]))
    hit = hits[0]
    held |= {"detector": story.detector, "kind": kind, "leg": hit.leg}
    said = rows_of(detections, [story.level], "detected", Detected, **held)
    found = [row for row in said if (row.seed, row.number) == (seed, hit.number)]
    if not found:
        raise DataError(f"{story.detector}: nothing is said of push {hit.number} of s{seed}")
    return hit, found[0]


def _felt(run: Run, joint: str, peaks: Peaks, layout: JointLayout, start: int) -> Felt:
    """Return what a run shows of the push that begins at a row, or one beside it: its flag is that of a mean."""
    pair = read_pair(run, layout).only([joint])
    scene = Scene(run.recording, layout, Scoring())
    shown = shown_pushes(pair, scene)
    windows = push_rows(scene.pushed, pair.spans, peaks, pair.rate_hz)
    _, rise = min(windows, key=lambda window: abs(window[1].start + 1 - start))
    push, behind, seen = (part[rise, 0].astype(np.float64) for part in (shown.push, shown.behind, shown.estimate))
    return felt_of(push, behind, seen, pair.rate_hz)


def _error_nm(run: Run, joint: str, layout: JointLayout, rows: slice) -> float:
    """Return the root-mean-square error of a run in some rows [N m]."""
    pair = read_pair(run, layout).only([joint])
    return float(rmse(pair.estimate, pair.truth, ((rows.start, rows.stop),))[0])
