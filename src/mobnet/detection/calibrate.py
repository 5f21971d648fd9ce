"""Thresholds for a robot of one's own: `./reproduce calibrate --recording FILE --estimate FILE` (docs/detection.md).

From a recording of walking that nothing pushes, and an estimate of its external torque, it prints for each joint of a
leg the threshold for a wanted rate of false alarms, the rate to expect with its interval, and the smallest force that a
collision must have at each point of the leg to be found.
"""

import logging
import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL, named
from mobnet.core.errors import DataError, MobnetError, not_accepted, refuse
from mobnet.core.estimator import Estimate
from mobnet.core.notes import note_differences, read_array_note
from mobnet.core.recording import read_sensed
from mobnet.core.store import NOTE, check_finite, file_of, read_array
from mobnet.detection.calibration import QuietWalk, check_signals, rate_scales
from mobnet.detection.sensitivity import found_forces
from mobnet.detection.signals import MEAN, Watched
from mobnet.detection.thresholds import Calibrated
from mobnet.detection.watch import LegSetup
from mobnet.detection.words import calibrate_parser
from mobnet.robot.description import RobotDescription, describe
from mobnet.settings.detection import Detection, Detector
from mobnet.settings.load import load_section, load_settings
from mobnet.settings.robot import RobotTable

log = logging.getLogger(__name__)
LEAST_RATE = 1e-6  # wanted false alarms [1/h]
WANTED = "wanted"  # the only rule of thresholds


def calibrate_leg(
    files: Sequence[tuple[Path, Path]], robot: RobotDescription, limb: str, detection: Detection, rate_per_h: float
) -> list[str]:  # fmt: skip
    """Calibrate a detector of the external torque of a leg on recordings with their estimates; return what is printed.

    Raises:
        DataError: a file is missing or damaged, a number is not finite, a column never changes, recordings differ in
            their rate, there are too few swings, or the rate is above what the fitted tail holds.
        ConfigError: the limb is no leg.
    """
    wanted = detection.thresholds.model_copy(update={"rates_per_h": {WANTED: rate_per_h}})
    detector = Detector(method=detection.gate.method, signals=(MEAN,))
    reads = [read_sensed(recording, robot.layout) for recording, _ in files]
    rate_hz = reads[0].rate_hz
    for (recording, _), read in zip(files, reads, strict=True):
        if read.rate_hz != rate_hz:
            raise DataError(not_accepted(f"{recording}: rate_hz", read.rate_hz, [f"{rate_hz}, that of the first"]))
    setup = LegSetup.of(detection.model_copy(update={"thresholds": wanted}), robot, limb, rate_hz)
    estimates = [read_own(*pair, setup.joints) for pair in files]
    legs = [setup.record(path, read, tau) for (path, _), read, tau in zip(files, reads, estimates, strict=True)]
    # Nothing is tried here on walking that is held out, so that all swings calibrate.
    walk = QuietWalk.of(setup, "", legs, [Estimate(torque) for torque in estimates], share=1.0)
    check_signals(setup, detector, walk)
    scales, promises = rate_scales(setup, Watched(detector), walk)
    thresholds = promises[WANTED].factor * scales[0]
    poses = np.concatenate([read.sensed.q[leg.gate.watched] for read, leg in zip(reads, legs, strict=True)])
    forces = found_forces(setup, poses, thresholds)
    return report(thresholds, promises[WANTED], forces, setup.joints, walk.first, wanted.confidence)


def read_own(recording: Path, estimate: Path, joints: Sequence[str]) -> NDArray[Any]:
    """Read the estimate of a leg's joints in a recording (T, 6) [N m].

    Raises:
        DataError: a file is missing or damaged, a number is not finite, or the notes of the two differ.
    """
    note, other = (read_array_note(file_of(stem, NOTE)) for stem in (estimate, recording))
    refuse(f"{estimate}{NOTE}", note_differences(note, other, f"{recording}{NOTE}"))
    names = named(EXTERNAL, joints)
    torque = read_array(estimate, names)[0]
    check_finite(f"{estimate}", torque, names)
    return torque


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
        robot = describe(load_section(options.robot, RobotTable) if options.robot else settings.robot)
        files = [(stem(one), stem(other)) for one, other in zip(options.recording, options.estimate, strict=True)]
        lines = calibrate_leg(files, robot, options.leg, settings.detection, options.rate)
    except MobnetError as error:
        log.error("%s", error)
        return 1
    for line in lines:
        log.info("%s", line)
    return 0


def stem(path: Path) -> Path:
    """Return the path of an array without its ending, however it was typed."""
    return path.with_suffix("") if path.suffix in (".parquet", NOTE) else path


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
