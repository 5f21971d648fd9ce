"""A limb that is watched all the time, such as an arm: windows of time take the place of a leg's swings.

A false alarm is as likely in each second, so that the largest values of windows follow a law as those of swings do.
Windows have to be independent of each other, or they would look like more evidence than they are: motion, and with it
the error of an estimate, lasts for some time. So their length is the shortest at which neighbours are not alike, if
there are enough of them.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError
from mobnet.core.estimator import Estimate
from mobnet.core.recording import SensedRecording
from mobnet.detection.detector import GateSignal
from mobnet.detection.gate import Spans, largest
from mobnet.detection.leg import LEG_JOINTS
from mobnet.detection.signals import Watched
from mobnet.detection.watch import UNKNOWN, LegRecording, LegSetup, LimbSetup
from mobnet.robot.description import RobotDescription
from mobnet.settings.detection import Detection

NOISE = 2.0  # standard errors by which the correlation of independent numbers may lie above zero
TINY = 1e-12  # of a signal [N m]


def setup_of(
    detection: Detection, robot: RobotDescription, limb: str, rate_hz: float, *, walks: bool = True
) -> LimbSetup:
    """Return the setup of a limb: with the gate of a leg where it is one and the robot walks, else without."""
    layout = robot.layout
    is_leg = limb in layout.legs.values() and len(layout.limb(limb)) == LEG_JOINTS
    if walks and is_leg and len(robot.feet) > 1 and robot.sole is not None:
        return LegSetup.of(detection, robot, limb, rate_hz)
    layout.limb(limb)
    return LimbSetup(detection, robot, limb, rate_hz)


@dataclass(frozen=True)
class AlwaysWatched:
    """A limb in recordings, watched in windows of a length [s]; whether windows that follow each other are alike."""

    window_s: float
    limbs: tuple[LegRecording, ...]
    is_alike: bool


def always_watched(
    setup: LimbSetup,
    watched: Watched,
    paths: Sequence[Path],
    read: Sequence[SensedRecording],
    estimates: Sequence[Estimate],
    window_s: float,
    settle_s: float,
) -> AlwaysWatched:
    """Return a limb in recordings, watched in windows that fill their segments.

    Windows have the length `window_s` or, where they are alike, one that is twice, four times ... as long, as far as
    there are enough of them.

    Raises:
        DataError: there are fewer windows of the first length than a law takes.
    """
    gates = [always_on(len(recording.sensed), recording.segments, settle_s, setup.rate_hz) for recording in read]
    signals = [watched.of(signal, recording.sensed.command) for recording, signal in zip(read, estimates, strict=True)]
    low = [
        np.abs(setup.low_passed(signal, recording.segments)) for signal, recording in zip(signals, read, strict=True)
    ]

    def windows(length_s: float) -> list[Spans]:
        length = round(length_s * setup.rate_hz)
        return [
            windows_of(gate.watched, recording.segments, length) for gate, recording in zip(gates, read, strict=True)
        ]

    least = setup.detection.thresholds.least_swings
    windows_seen = windows(window_s)
    if (count := sum(map(len, windows_seen))) < least:
        seconds = round(count * window_s, 1)
        needed = f"{least * window_s:g} s or more are needed"
        raise DataError(f"{seconds:g} s of free motion, in windows of {window_s:g} s; {needed}")
    while (is_alike := alike([largest(*pair) for pair in zip(low, windows_seen, strict=True)])) and (
        sum(map(len, longer := windows(2.0 * window_s))) >= least
    ):
        window_s = 2.0 * window_s
        windows_seen = longer
    rows = zip(paths, read, gates, windows_seen, strict=True)
    limbs = tuple(
        LegRecording(path, recording.segments, recording.sensed.command, gate, spans, (UNKNOWN,) * len(spans), spans)
        for path, recording, gate, spans in rows
    )
    return AlwaysWatched(window_s, limbs, is_alike)


def always_on(rows: int, segments: Spans, settle_s: float, rate_hz: float) -> GateSignal:
    """Return a gate (T,) that is open but for the first part [s] of each contiguous segment."""
    watched = np.zeros(rows, dtype=bool)
    settling = round(settle_s * rate_hz)
    for start, end in segments:
        watched[start + settling : end] = True
    return GateSignal(watched, np.zeros(rows))


def windows_of(watched: NDArray[np.bool_], segments: Spans, length: int) -> Spans:
    """Return the rows (start, end) of whole windows of so many samples in the watched part (T,) of segments."""
    firsts = [start + int(np.argmax(watched[start:end])) for start, end in segments]
    windows = list[tuple[int, int]]()
    for first, (_, end) in zip(firsts, segments, strict=True):
        if watched[first]:
            windows += [(k, k + length) for k in range(first, end - length + 1, length)]
    return tuple(windows)


def alike(parts: Sequence[Array]) -> bool:
    """Return whether windows that follow each other have largest values (k, m) that are alike, in some recordings."""
    whole = np.concatenate(parts)
    # The largest of the signals over their means, as alarms are; of it the logarithm, as a few large values would
    # decide the correlation of the values themselves.
    mean = np.maximum(whole.mean(axis=0), TINY)
    logs = [np.log(np.maximum((part / mean).max(axis=1), TINY)) for part in parts if len(part)]
    centre = np.mean(np.concatenate(logs))
    spread = np.var(np.concatenate(logs))
    pairs = np.concatenate([(largest[:-1] - centre) * (largest[1:] - centre) for largest in logs])
    if not spread or not len(pairs):
        return False
    return float(pairs.mean() / spread) > NOISE / np.sqrt(len(pairs))
