"""Flags: stretches of a log in which a limb's signals lie above their thresholds, and which push explains each."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL, PUSHED
from mobnet.core.recording import SensedRecording
from mobnet.detection.detector import ALARM_RATIO, DetectorOutput
from mobnet.detection.points import EstimatedPush, felt_push
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.convert import Converted
from mobnet.robotlog.long_arrays import give_back


@dataclass(frozen=True)
class Flag:
    """A stretch above a threshold, a row of `flags.csv`.

    Attributes:
        start_s, end_s: first and last sample above it, by the log's clock [s].
        joint: whose signal lay highest above its threshold.
        ratio: how many times its threshold that was [-].
        push: that explains the torques of that sample best; none where the robot's table has no points on the limb.
    """

    start_s: float
    end_s: float
    joint: str
    ratio: float
    push: EstimatedPush | None

    def row(self) -> tuple[Any, ...]:
        """Return it as a row of a CSV file."""
        push = (self.push.body, self.push.point, self.push.direction, self.push.force_n) if self.push else ("",) * 4
        return self.start_s, self.end_s, self.joint, self.ratio, *push


COLUMNS = ("start_s", "end_s", "joint", "ratio", "link", "point", "direction", "force_n")


def flags_of(
    alarm: DetectorOutput,
    time_s: Array,
    read: SensedRecording,
    low: Array,
    std: NDArray[Any] | None,
    thresholds: LimbThresholds,
    nominal: NominalModel,
    gap_s: float,
) -> Iterator[Flag]:
    """Yield the flags of a limb in a log.

    Args:
        alarm: ratio to the thresholds and highest signal of each sample (T,).
        time_s: times of the samples (T,) [s].
        read: the recording.
        low: estimated torque of the limb's joints behind the low-pass (T, n) [N m].
        std: its standard deviation (T, n) [N m], where the estimate has one.
        thresholds: the thresholds.
        nominal: the model of the robot.
        gap_s: two stretches above a threshold that are closer are one flag [s].
    """
    for start, end in stretches(alarm.ratio > ALARM_RATIO, read.segments, round(gap_s * read.rate_hz)):
        row = start + int(np.argmax(alarm.ratio[start:end]))
        # What is usual in free motion: thresholds themselves, of a ratio times sigma, which cannot be one of sigma.
        usual = np.array(thresholds.thresholds)
        if thresholds.signal != "mean":
            usual = usual * std[row] if thresholds.signal == "ratio" and std is not None else np.ones(len(usual))
        push = felt_push(nominal, thresholds.joints, read.sensed.q[row], low[row], usual)
        joint = thresholds.joints[int(alarm.signal[row])]
        yield Flag(float(time_s[start]), float(time_s[end - 1]), joint, float(alarm.ratio[row]), push)


def stretches(above: NDArray[np.bool_], segments: tuple[tuple[int, int], ...], gap: int) -> list[tuple[int, int]]:
    """Return the rows (start, end) of stretches above a threshold (T,); in a segment, those a gap apart are one."""
    rows: list[tuple[int, int]] = []
    for first, last in segments:
        edges = np.flatnonzero(np.diff(np.r_[False, above[first:last], False])).reshape(-1, 2) + first
        for k, (start, end) in enumerate(edges.tolist()):
            if k and start - rows[-1][1] <= gap:
                rows[-1] = (rows[-1][0], end)
            else:
                rows.append((start, end))
    return rows


class PushCount(NamedTuple):
    """How many pushes a log has, how many of them a flag lies in, and how many flags lie in none."""

    pushes: int
    found: int
    others: int


def pushed_rows(log: Converted, joints: Sequence[str]) -> NDArray[np.bool_] | None:
    """Return when a push acts on some joints (T,), None where the log does not tell it."""
    rows = log.truth[PUSHED] > 0.5 if PUSHED in log.truth else None
    names = [f"{EXTERNAL}.{joint}" for joint in joints]
    torques = [log.truth[name] for name in names if name in log.truth]
    if torques:
        felt = np.zeros(len(log.time_s), dtype=bool)
        for torque in torques:
            felt |= torque != 0.0
            give_back()
        rows = felt if rows is None else rows & felt
    return rows


def found_pushes(log: Converted, joints: Sequence[str], flags: Sequence[Flag], late_s: float) -> PushCount | None:
    """Count the pushes on some joints that a flag lies in, or begins up to so long [s] after."""
    rows = pushed_rows(log, joints)
    if rows is None:
        return None
    spans = [(log.time_s[a], log.time_s[b - 1] + late_s) for a, b in stretches(rows, log.recording.segments, 0)]
    hits = list[list[bool]]()
    for start, end in spans:
        hits.append([start <= flag.end_s and flag.start_s <= end for flag in flags])
    others = sum(not any(hits_of_push) for hits_of_push in zip(*hits, strict=True)) if hits else len(flags)
    return PushCount(len(spans), sum(map(any, hits)), others)
