"""What the page on which a reader plays with pushes says of them in numbers: how much is shown, how late, what alarms.

The page computes the same again whenever a slider moves; `explore_numbers.js` follows this module line by line.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.curves import TRUTH
from experiments.evaluation.measure.estimates.peaks import MS
from experiments.evaluation.measure.push_scene import PushScene
from experiments.settings.measures import Peaks
from mobnet.core.arrays import Array
from mobnet.detection.chain import make_chain
from mobnet.detection.detector import ALARM_RATIO, GateSignal, run_over
from mobnet.settings.detection import Detection

ALREADY, NEVER, ASLEEP = "on before", "none", "not watched"  # of an alarm without a delay


@dataclass(frozen=True)
class PushNumbers:
    """What a method shows of a push at a joint.

    Attributes:
        method: its name, or `truth`.
        peak: largest torque in the direction of the push that it shows of it; what it showed before is its zero [N m].
        share: the peak over that of the push behind the observer's low-pass [-].
        late_ms: how much later it rises to half of the push than the push itself [ms]; None if it never does.
        error: root mean square of its error in the same time [N m].
        around: that from some time before the push to the end of the scene, as the demo prints it [N m].
        alarm: delay of the alarm [ms], or why there is none.
        false_alarms: alarms that begin while nothing has pushed the leg in its swing.
        quiet_nm: smallest threshold without one [N m]; None where nothing is watched.
    """

    method: str
    peak: float
    share: float
    late_ms: float | None
    error: float
    around: float
    alarm: float | str
    false_alarms: int
    quiet_nm: float | None


def push_numbers(
    shown: PushScene, joint: str, threshold_nm: float, detection: Detection, peaks: Peaks, judged_s: float
) -> list[PushNumbers]:
    """Return the numbers of the truth and of every method at a joint, with a threshold on the torque [N m].

    They are those of the time that the table of peaks looks at: from the last sample before the push to some time after
    it, or the rise of one that lasts. The error around the push begins `judged_s` before it.
    """
    truth = shown.truth[:, shown.joints.index(joint)].astype(np.float64)
    rise = shown.rise(peaks)
    around = slice(max(shown.settled, shown.start - round(judged_s * shown.rate_hz)), len(truth))
    rows: list[PushNumbers] = []
    for name, torque in {TRUTH: truth, **shown.torques(joint)}.items():
        error = torque.astype(np.float64) - truth
        felt = shown.felt(torque, joint, peaks)
        in_push = float(np.sqrt(np.mean(error[rise] ** 2)))
        in_all = float(np.sqrt(np.mean(error[around] ** 2)))
        found = alarms(shown, torque, threshold_nm, detection)
        rows.append(PushNumbers(name, felt.peak_nm, felt.share, felt.delay_ms, in_push, in_all, *found))
    return rows


def alarms(
    shown: PushScene, torque: NDArray[Any], threshold_nm: float, detection: Detection
) -> tuple[float | str, int, float | None]:
    """Return the delay of the alarm [ms], or why there is none, false alarms, and the quiet threshold [N m].

    An alarm is the torque behind the low-pass of the detectors above the threshold, held without a gap while watched.
    """
    ratio = held_ratio(shown, torque, threshold_nm, detection)
    watched = shown.flags["watched"]
    over = ratio > ALARM_RATIO
    calm = calm_rows(shown)
    # An alarm counts where it begins, however long it lasts.
    rises = over & calm & ~np.concatenate([[False], over[:-1] & calm[:-1]])
    largest = float(ratio[calm].max(initial=0.0)) * threshold_nm
    return _delay(shown, over, detection), int(rises.sum()), largest if watched[shown.settled :].any() else None


def held_ratio(shown: PushScene, torque: NDArray[Any], threshold_nm: float, detection: Detection) -> Array:
    """Return the torque over its threshold (T,), behind the low-pass and held, as in any detector of the project."""
    watched = shown.flags["watched"]
    chain = make_chain(detection.low_pass_hz, detection.hold_s, shown.rate_hz, np.array([[threshold_nm]]))
    signals = np.ascontiguousarray(torque[:, None], dtype=np.float64)
    return run_over(chain, signals, GateSignal(np.ascontiguousarray(watched), np.zeros(len(watched)))).ratio


def calm_rows(shown: PushScene) -> NDArray[np.bool_]:
    """Return the rows in which an alarm is a false one (T,): watched, and nothing has pushed since that began."""
    calm = shown.flags["watched"].copy()
    pushed = shown.flags["pushed"]
    calm[: shown.settled] = False
    for start, end in stretches(shown.flags["watched"]):
        # A leg that was hit still recovers until it lands.
        hit = np.flatnonzero(pushed[start:end])
        if len(hit):
            calm[start + hit[0] : end] = False
    return calm


def stretches(flag: NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    """Yield the rows (start, end) of each run in which a flag (T,) holds."""
    edges = np.flatnonzero(np.diff(flag, prepend=False, append=False))
    yield from ((int(start), int(end)) for start, end in edges.reshape(-1, 2))


def _delay(shown: PushScene, over: NDArray[np.bool_], detection: Detection) -> float | str:
    """Return the delay of the push's alarm [ms], or why there is none, as for a collision, (D21)."""
    window = slice(shown.start, shown.end + round(detection.late_s * shown.rate_hz))
    if not shown.flags["watched"][window].any():
        return ASLEEP
    if over[shown.start - 1]:
        return ALREADY
    found = np.flatnonzero(over[window])
    return float(found[0]) * MS / shown.rate_hz if len(found) else NEVER
