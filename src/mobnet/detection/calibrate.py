"""Thresholds for a robot of one's own: `./reproduce calibrate --recording FILE --estimate FILE` (docs/detection.md).

From a recording of walking that nothing pushes, and an estimate of its external torque, it prints for each joint of a
leg the threshold for a wanted rate of false alarms, the rate to expect with its interval, and the smallest force that a
collision must have at each point of the leg to be found.
"""

import logging
import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL, named
from mobnet.core.errors import DataError, MobnetError, not_accepted, refuse
from mobnet.core.notes import note_differences, read_array_note
from mobnet.core.recording import SensedRecording, read_sensed
from mobnet.core.store import NOTE, check_finite, file_of, read_array
from mobnet.detection.chain import make_chain
from mobnet.detection.detector import LegGate, Watch, run_over, run_segments
from mobnet.detection.isolation import smallest_forces
from mobnet.detection.leg import make_leg, unit_torques
from mobnet.detection.swings import Spans, episodes_of, largest, swings_of
from mobnet.detection.thresholds import Calibrated, calibrate
from mobnet.detection.words import calibrate_parser
from mobnet.robot.description import RobotDescription, describe
from mobnet.settings.detection import Detection
from mobnet.settings.load import load_section, load_settings
from mobnet.settings.robot import RobotTable

log = logging.getLogger(__name__)
CONTACT_S = 0.078  # of the collisions of section 5.3: the filters leave a part of a hit that is so short
POSES = 200  # of swings, at which forces are looked at
LEAST_RATE = 1e-6  # wanted false alarms [1/h]
SHARE = 0.95  # of the poses in which the smallest force is enough


@dataclass(frozen=True)
class Quiet:
    """A leg in a recording that nothing pushes: its estimate (T, 6) [N m], when it is watched, its swings."""

    recording: SensedRecording
    torque: Array
    watch: Watch
    swings: Spans

    @property
    def duration_s(self) -> float:
        """Time that was walked [s]."""
        return sum(end - start for start, end in self.recording.segments) / self.recording.rate_hz


def read_quiet(recording: Path, estimate: Path, robot: RobotDescription, detection: Detection, limb: str) -> Quiet:
    """Read a recording with its estimate, and run the gate of a leg over them.

    Raises:
        DataError: a file is missing or damaged, a number is not finite, a column never changes, or the two differ.
        ConfigError: the limb is no leg.
    """
    joints = robot.layout.limb(limb)
    note, other = (read_array_note(file_of(stem, NOTE)) for stem in (estimate, recording))
    refuse(f"{estimate}{NOTE}", note_differences(note, other, f"{recording}{NOTE}"))
    read, names = read_sensed(recording, robot.layout), named(EXTERNAL, joints)
    gate = LegGate.of(detection.gate, robot, limb, read.rate_hz)
    torque = read_array(estimate, names)[0].astype(np.float64)
    check_finite(f"{estimate}", torque, names)
    accepted = ["numbers that change"]
    for name, column in zip(names, torque.T, strict=True):
        if column.min() == column.max():
            raise DataError(not_accepted(f"{estimate}: column {name!r}: every number", float(column[0]), accepted))
    return Quiet(read, torque, gate.watch(read, torque), swings_of(read.sensed.swing[:, gate.foot], read.segments))


def held(quiet: Quiet, detection: Detection) -> Array:
    """Return the largest held torque of each joint in each swing (k, 6) [N m], behind the low-pass."""
    chain = make_chain(detection.low_pass_hz, detection.hold_s, quiet.recording.rate_hz, np.ones((1, 1)))
    parts = np.split(quiet.torque, quiet.torque.shape[1], axis=1)
    segments = quiet.recording.segments
    held_parts = [run_segments(chain, np.ascontiguousarray(part), quiet.watch, segments).ratio for part in parts]
    return largest(np.stack(held_parts, axis=1), quiet.swings)


def thresholds_of(
    quiets: Sequence[Quiet], detection: Detection, rate_per_h: float
) -> tuple[Array, Calibrated]:  # fmt: skip
    """Return the thresholds of the joints (6,) [N m] for a wanted rate of false alarms [1/h], and what to expect.

    Raises:
        DataError: there are too few swings, they do not differ, or the rate is above what the fitted tail holds.
    """
    heights = np.concatenate([held(quiet, detection) for quiet in quiets])
    if len(heights) < detection.thresholds.least_swings:
        accepted = [f"{detection.thresholds.least_swings} or more, some minutes of walking"]
        raise DataError(not_accepted("swings in all recordings", len(heights), accepted))
    scales = np.quantile(heights, detection.thresholds.scale_quantile, axis=0)
    if not scales.all():
        raise DataError(not_accepted("swings in which the leg is watched", "none", ["most of them; see the gate"]))
    seen = (heights / scales).max(axis=1)
    episodes = episodes_of((one.recording.segments, one.swings) for one in quiets)
    found = calibrate(seen, episodes, sum(one.duration_s for one in quiets), rate_per_h, detection.thresholds)
    return found.factor * scales, found


def forces_of(
    quiets: Sequence[Quiet], robot: RobotDescription, limb: str, detection: Detection, thresholds: Array
) -> dict[str, float]:  # fmt: skip
    """Return point of the leg -> the force [N] that a short collision must have there, in most poses of a swing.

    The filters leave a part of a half-sine of 78 ms; the force is what this part needs to lift a joint over its
    threshold, in 95 % of the poses in which the leg is watched.
    """
    side = next(side for side, name in robot.layout.legs.items() if name == limb)
    points = [row.name for row in robot.points if row.name.startswith(f"{side}_") and row.name.count("_") == 2]
    leg, rate_hz = make_leg(robot, limb), quiets[0].recording.rate_hz
    watched = [one.recording.sensed.q[np.flatnonzero(one.watch.watched)] for one in quiets]
    poses = np.concatenate(watched)
    picked = poses[np.linspace(0, len(poses) - 1, min(POSES, len(poses))).astype(int)]
    left = attenuation(detection, rate_hz)
    inward = -1.0 if side == "left" else 1.0
    forces = [smallest_forces(unit_torques(robot, leg, q, points, inward), thresholds, left) for q in picked]
    return dict(zip(points, np.quantile(forces, SHARE, axis=0).tolist(), strict=True))


def attenuation(detection: Detection, rate_hz: float) -> float:
    """Return what the filters leave of the peak of a half-sine of a collision's length [-]."""
    count = round(CONTACT_S * rate_hz)
    hit = np.sin(np.pi * np.arange(2 * count) / count)[:, None] * (np.arange(2 * count) < count)[:, None]
    chain = make_chain(detection.low_pass_hz, detection.hold_s, rate_hz, np.ones((1, 1)))
    always = Watch(np.ones(len(hit), dtype=bool), np.zeros(len(hit)))
    return float(run_over(chain, np.ascontiguousarray(hit), always).ratio.max())


def report(
    thresholds: Array, found: Calibrated, forces: dict[str, float], joints: Sequence[str], swings: int,
    confidence: float,
) -> list[str]:  # fmt: skip
    """Return what the command prints, line by line."""
    lines = [f"{swings} swings", "", "joint  threshold [N m]"]
    lines += [f"{joint:<6} {value:14.2f}" for joint, value in zip(joints, thresholds.tolist(), strict=True)]
    interval = f"{confidence:.0%} interval {found.low:.2g} to {found.high:.2g}"
    lines += ["", f"false alarms to expect: {found.rate_per_h:.2g} in an hour of walking, {interval}", ""]
    lines += ["smallest force that is found [N], by point of the leg:"]
    return lines + [f"{point:<24} {force:8.0f}" for point, force in forces.items()]


def main(words: list[str]) -> int:
    """Run the command; return its exit status."""
    options = calibrate_parser().parse_args(words)
    logging.basicConfig(level=logging.INFO, format="%(message)s", stream=sys.stdout)
    try:
        if len(options.recording) != len(options.estimate):
            count = len(options.recording)
            raise DataError(not_accepted("--estimate", len(options.estimate), [f"{count}, one for each --recording"]))
        if not LEAST_RATE <= options.rate < math.inf:
            raise DataError(not_accepted("--rate", options.rate, [f"a number from {LEAST_RATE:g}, one in a century"]))
        settings = load_settings()
        table = load_section(options.robot, RobotTable) if options.robot else settings.robot
        robot, detection = describe(table), settings.detection
        pairs = [(stem(one), stem(other)) for one, other in zip(options.recording, options.estimate, strict=True)]
        quiets = [read_quiet(*pair, robot, detection, options.leg) for pair in pairs]
        thresholds, found = thresholds_of(quiets, detection, options.rate)
        forces = forces_of(quiets, robot, options.leg, detection, thresholds)
    except MobnetError as error:
        log.error("%s", error)
        return 1
    joints, swings = robot.layout.limb(options.leg), sum(len(one.swings) for one in quiets)
    for line in report(thresholds, found, forces, joints, swings, detection.thresholds.confidence):
        log.info("%s", line)
    return 0


def stem(path: Path) -> Path:
    """Return the path of an array without its ending, however it was typed."""
    return path.with_suffix("") if path.suffix in (".parquet", NOTE) else path


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
