"""What a variant of a method makes of a robot's walks: errors in walking and under hits, and what it shows of a hit."""

from collections.abc import Sequence

import numpy as np

from experiments.evaluation.compare.pair import Pair
from experiments.evaluation.compare.rmse import rmse
from experiments.evaluation.compare.scene import Scene
from experiments.evaluation.compare.windows import push_windows
from experiments.evaluation.measure.estimates.peaks import SHARE
from experiments.evaluation.measure.estimates.peaks import measure as measure_peaks
from experiments.evaluation.measure.learning.trials import ObservedWalks, estimates_of
from experiments.plan.runs import Run, TaughtRobot, Tried
from experiments.settings.measures import Peaks
from mobnet.core.arrays import Array
from mobnet.robot.description import describe

WALKING, HITS, SHARE_OF_HIT, ROUGHNESS = "walking", "hits", "share", "roughness"


def judged(
    scenario: str,
    joint: str,
    taught: TaughtRobot,
    tried: Tried,
    walks: tuple[ObservedWalks, ObservedWalks],
    peaks: Peaks,
) -> dict[str, Array]:
    """Return of a variant, measure -> its number of each walk (w,): RMSE [N m], share of a hit and roughness [-].

    Walking and roughness are means over the joints, the others are those of a joint under the hits of a scenario. The
    roughness is that of the estimate, the root mean square of its change from sample to sample, over the residual's.
    """
    walk, hits = walks
    place = hits.joints.index(joint)
    layout = describe(hits.robot).layout
    columns = layout.columns(walk.joints)
    walking: list[float] = []
    rough: list[float] = []
    estimates = estimates_of(tried, walk)
    for estimate, truth, read in zip(estimates, walk.truths, walk.read, strict=True):
        segments = read.recording.segments
        walking.append(float(rmse(estimate, truth, segments).mean()))
        assert read.residual is not None
        residual = read.residual[:, columns].astype(np.float64)
        rough.append(_change(estimate, segments) / _change(residual, segments))
    errors: list[float] = []
    shares: list[float] = []
    estimates = estimates_of(tried, hits)
    for k, (estimate, truth) in enumerate(zip(estimates, hits.truths, strict=True)):
        recording = taught.hits.recordings[k]
        read = hits.read[k].recording
        window = taught.asked.window
        assert window is not None  # the plan gives one
        around = push_windows(recording, len(truth), window.before_s, window.after_s)
        errors.append(float(rmse(estimate, truth, around)[place]))
        run = Run(scenario, "", tried.name, 0, k, recording, taught.hits.residuals[k], recording)
        pair = Pair(run, tuple(hits.joints), estimate, truth, read.segments, read.rate_hz)
        measured = measure_peaks(pair, Scene(recording, layout, taught.asked), peaks)
        values = {each.metric: each.values for each in measured}
        shares.append(float(values[SHARE][place]))
    return {
        WALKING: np.array(walking),
        HITS: np.array(errors),
        SHARE_OF_HIT: np.array(shares),
        ROUGHNESS: np.array(rough),
    }


def _change(signal: Array, segments: Sequence[tuple[int, int]]) -> float:
    """Return the root mean square of a signal's change from sample to sample (T, n) [N m], a mean over joints."""
    steps = [np.diff(signal[first:last], axis=0) for first, last in segments]
    return float(np.sqrt((np.concatenate(steps) ** 2).mean(axis=0)).mean())
