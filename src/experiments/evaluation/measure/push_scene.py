"""One push on a robot as methods estimate it, which demo, film and the page of pushes show, from the files of a run.

`experiments.evaluation.measure.story` makes the same of the stored push of docs/demo.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.pair import Pair, read_pair, read_std
from experiments.evaluation.compare.rmse import rmse
from experiments.evaluation.compare.windows import FLAG
from experiments.evaluation.measure.estimates.felt import PushResponse, felt_of
from experiments.evaluation.measure.estimates.peaks import push_rows
from experiments.plan.runs import Run
from experiments.records.collisions import Collision, Detected
from experiments.settings.measures import Peaks
from experiments.settings.pages import Story
from mobnet.core.arrays import Array
from mobnet.core.columns import PUSH, PUSH_TORQUE, PUSHED, SWING, foot_of, named, recording_columns
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.core.notes import read_array_note
from mobnet.core.rows import read_rows
from mobnet.core.store import NOTE, file_of, read_array
from mobnet.kernel.low_pass import low_pass

FORCE = named(PUSH, ("force_x", "force_y", "force_z"))


class PushAlarm(NamedTuple):
    """When a detector finds a push, from its beginning on [s], and the link and direction that it names, if it does."""

    delay_s: float
    link: str = ""
    direction: str = ""


class PushRows(NamedTuple):
    """Where a push stands in a recording: the rows that are shown, those in which it acts, how many settle first."""

    shown: slice
    start: int
    end: int
    settling: int


@dataclass(frozen=True)
class PushScene:
    """A push, from some time before it to some time after it: T samples of n joints.

    Attributes:
        joints: names (n,).
        rate_hz: samples per second [Hz].
        gain_hz: gain of the observer behind which truth and estimates lie [1/s].
        first: row of the recording with which it begins.
        settled: sample from which on estimates are judged; before it, estimators or filters settle.
        start: sample at which the push begins.
        end: sample after its last one.
        truth: external torque behind the observer's low-pass (T, n) [N m].
        push: what pushes alone add to the external torque, without a low-pass (T, n) [N m].
        estimates: method -> external torque (T, n) [N m].
        stds: method -> standard deviation (T, n) [N m], where it predicts one.
        flags: `swing`, of the leg by the walking plan, `pushed` and what else is asked -> whether it holds (T,).
        q: generalized positions, as the robot senses them (T, nq) [m, -, rad].
        force: force of the push, world axes (T, 3) [N].
        alarm: that of the detector; None where there is none.
    """

    joints: tuple[str, ...]
    rate_hz: float
    gain_hz: float
    first: int
    settled: int
    start: int
    end: int
    truth: NDArray[Any]
    push: NDArray[Any]
    estimates: Mapping[str, NDArray[Any]]
    stds: Mapping[str, NDArray[Any]]
    flags: Mapping[str, NDArray[np.bool_]]
    q: Array
    force: Array
    alarm: PushAlarm | None = None

    @property
    def time_s(self) -> Array:
        """Time from the beginning of the push on, (T,) [s]."""
        return (np.arange(len(self.truth)) - self.start) / self.rate_hz

    def torques(self, joint: str) -> dict[str, NDArray[Any]]:
        """Return method -> its estimate of a joint (T,) [N m]."""
        k = self.joints.index(joint)
        return {method: estimate[:, k] for method, estimate in self.estimates.items()}

    def rise(self, peaks: Peaks) -> slice:
        """Return the samples that the table of peaks looks at, from the last one before the push on."""
        whole = ((0, len(self.truth)),)
        rises = [rise for _, rise in push_rows(self.flags["pushed"], whole, peaks, self.rate_hz)]
        return min(rises, key=lambda rise: abs(rise.start + 1 - self.start))

    def felt(self, torque: NDArray[Any], joint: str, peaks: Peaks) -> PushResponse:
        """Return what a torque (T,) [N m] at a joint shows of the push."""
        k = self.joints.index(joint)
        rise = self.rise(peaks)
        push = self.push[:, k].astype(np.float64)
        behind = low_pass(push, self.gain_hz, self.rate_hz)[rise]
        # An estimate shows the push behind the low-pass plus its error, as for the table of peaks.
        error = torque[rise].astype(np.float64) - self.truth[rise, k]
        return felt_of(push[rise], behind, behind + error, self.rate_hz)

    def error_nm(self, torque: NDArray[Any], joint: str) -> float:
        """Return the root-mean-square error of a torque (T,) [N m] at a joint, once it has settled [N m]."""
        truth = self.truth[:, self.joints.index(joint)]
        return float(rmse(torque[:, None], truth[:, None], ((self.settled, len(truth)),))[0])


def read_push(
    runs: Sequence[Run],
    layout: JointLayout,
    limbs: Iterable[str],
    joint: str,
    rows: PushRows,
    alarm: PushAlarm | None = None,
) -> PushScene:
    """Read a push from the runs of some methods on one recording, at those joints of limbs that all of them estimate.

    Raises:
        DataError: a file is missing or damaged, or some method does not estimate `joint`.
    """
    recording = runs[0].recording
    pairs = {run.method: read_pair(run, layout) for run in runs}
    joints = shared_joints(layout.limbs(limbs), pairs.values())
    if joint not in joints:
        raise DataError(f"{recording}: {not_accepted('joint of the scene', joint, joints)}")
    shown = rows.shown
    pair = pairs[runs[0].method]
    stds = {run.method: read_std(run, joints) for run in runs}
    position = [name for name, *_ in recording_columns(layout)["q"]]
    pushed = read_array(recording, [PUSHED])[0][shown, 0] > FLAG
    swing = np.zeros(len(pushed), dtype=bool)
    # A joint of no leg has no swing.
    if layout.limb_of[joint] in layout.legs.values():
        swing = read_array(recording, [f"{SWING}.{foot_of(layout, joint)}"])[0][shown, 0] > FLAG
    return PushScene(
        joints=joints,
        rate_hz=pair.rate_hz,
        gain_hz=float(read_array_note(file_of(runs[0].residual, NOTE))["gain_hz"]),
        first=shown.start,
        settled=rows.settling,
        start=rows.start - shown.start,
        end=rows.end - shown.start,
        truth=pair.truth[shown][:, pair.places(joints)],
        push=read_array(recording, named(PUSH_TORQUE, joints))[0][shown],
        estimates={method: read.estimate[shown][:, read.places(joints)] for method, read in pairs.items()},
        stds={method: std[shown] for method, std in stds.items() if std is not None},
        flags={"swing": swing, "pushed": pushed},
        q=read_array(recording, position)[0][shown].astype(np.float64),
        force=read_array(recording, FORCE)[0][shown].astype(np.float64),
        alarm=alarm,
    )


def shared_joints(joints: Sequence[str], pairs: Iterable[Pair]) -> tuple[str, ...]:
    """Return those of some joints that every method estimates."""
    shared = list(joints)
    for pair in pairs:
        shared = [joint for joint in shared if joint in pair.joints]
    return tuple(shared)


def read_story(
    story: Story, layout: JointLayout, runs: Sequence[Run], files: Mapping[str, Path], kind: str
) -> tuple[Collision, PushScene]:
    """Read the push of a story from its runs, one of each method, and the files of the robot's detectors.

    Estimators are judged where those of the stored push are, which begin with it.

    Raises:
        DataError: a file is missing or damaged, or the recording has no such push.
    """
    hit, alarm = story_push(story, files, runs[0].test_seed, kind)
    note = read_array_note(file_of(runs[0].recording, NOTE))
    rate_hz = note["rate_hz"]
    start = round(hit.start_s * rate_hz)
    first = max(0, start - round(story.before_s * rate_hz))
    last = min(note["rows"], start + round(story.after_s * rate_hz))
    rows = PushRows(slice(first, last), start, round(hit.end_s * rate_hz), round(story.settle_s * rate_hz))
    limb = layout.limb_of[story.joint]
    return hit, read_push(runs, layout, [limb], story.joint, rows, alarm)


def story_push(story: Story, files: Mapping[str, Path], seed: int, kind: str) -> tuple[Collision, PushAlarm | None]:
    """Return the push of a story in the recording of a seed, and the alarm of its detector, None without one.

    The files are those of the robot's detectors, `kind` is the rule of the thresholds.

    Raises:
        DataError: a file is missing or damaged, the recording has no such push, or nothing is said of it.
    """
    place = story.scenario, seed
    pushes = [row for row in read_rows(files["collisions"], Collision) if (row.scenario, row.seed) == place]
    hits = [row for row in pushes if row.push == story.push]
    if not hits:
        raise DataError(not_accepted(f"push of s{seed} of {story.scenario}", story.push, [row.push for row in pushes]))
    hit = hits[0]
    wanted = (*place, hit.leg, hit.number, story.detector, kind)
    for row in read_rows(files["detected"], Detected):
        if (row.scenario, row.seed, row.leg, row.number, row.detector, row.kind) == wanted:
            alarm = None if row.delay_s is None else PushAlarm(row.delay_s, row.link, row.direction)
            return hit, alarm
    raise DataError(f"{files['detected']}: {story.detector} says nothing of push {hit.number} of s{seed}")
