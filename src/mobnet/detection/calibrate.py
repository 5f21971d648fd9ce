"""Thresholds for a robot of one's own: `./reproduce calibrate FOLDER...` (docs/detection.md).

From recordings that nothing pushes, and an estimate of their external torque, it prints for each joint of a limb the
threshold for a wanted rate of false alarms, the rate to expect with its interval, and the smallest force that a
collision must have at each point of the limb to be found.
"""

import logging
import sys
from argparse import Namespace
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

from mobnet.core.errors import refuse_lines
from mobnet.core.files import sweep
from mobnet.core.options import calibrate_parser
from mobnet.core.printed import printed
from mobnet.core.word_checks import check_calibrate
from mobnet.detection.choice import ALONE, BARE, NETWORK, DetectorCandidate, best_of, lines_of, tried_on_pushes
from mobnet.detection.limb import OwnRecording, calibrate_limb
from mobnet.detection.limb_report import beside, report, thresholds_of
from mobnet.detection.signals import MEAN, RATIO, STD
from mobnet.detection.threshold_file import write_thresholds
from mobnet.estimation import observer
from mobnet.estimation.own import (
    OwnLog,
    OwnNetwork,
    estimates_of,
    limb_of,
    read_log_folder,
    read_network_folder,
    refuse_twice,
    without_friction,
)
from mobnet.estimation.sampling import check_drives, check_sampling, estimator_of
from mobnet.kernel.detecting import Signal
from mobnet.robot.description import RobotDescription
from mobnet.robot.given import given_robot
from mobnet.settings.lab import Lab, load_lab

log = logging.getLogger(__name__)
MANY = 100_000  # samples above which progress is told


def read_folders(options: Namespace, robot: RobotDescription, network: OwnNetwork | None) -> list[OwnLog]:
    """Return the logs in folders of `./reproduce observe`.

    Raises:
        DataError: a folder is not one, its sampling is not that of the first one or of the network, the network learned
            from it, or it is given twice.
    """
    logs = [read_log_folder(folder, robot.layout) for folder in options.folders]
    refuse_lines(
        f"{log.folder}: the network learned from it, where its error is smaller; accepted: another log"
        for log in logs
        if network and network.has_learned_from(log)
    )
    refuse_twice(logs, "else its alarms count twice")
    sampling, of = (network.sampling, network.folder) if network else (logs[0].sampling, logs[0].folder)
    for log in logs:
        check_drives(log.folder, log.sampling.drives, robot)
        check_sampling(log.folder, log.sampling, sampling, of)
    return logs


def estimated(
    logs: Sequence[OwnLog], robot: RobotDescription, limb: str, network: OwnNetwork | None, settings: Lab
) -> list[OwnRecording]:
    """Return logs with the estimate of a limb: the observer's, or less what a network predicts."""
    _progress(logs, "estimating the external torque" + (" less what the network predicts" if network else ""))
    estimator = estimator_of(robot, settings.plant.gravity_m_s2, logs[0].sampling, network and network.networks)
    estimates = estimates_of(logs, estimator, robot.layout.limb(limb))
    _progress(logs, "looking for thresholds")
    return [OwnRecording(log.folder, log.recording, estimate) for log, estimate in zip(logs, estimates, strict=True)]


def _progress(logs: Sequence[OwnLog], text: str) -> None:
    """Tell what is done with logs of many samples, which takes more than a few seconds."""
    samples = sum(len(observed_log.residual) for observed_log in logs)
    if samples > MANY:
        log.info("%d samples: %s", samples, text)


def of_files(options: Namespace, robot: RobotDescription, limb: str) -> list[OwnRecording]:
    """Return recordings with their estimates by any method, of the limb's joints."""
    pairs = zip(options.recording, options.estimate, strict=True)
    return [OwnRecording.read_files(stem(recording), stem(other), robot, limb) for recording, other in pairs]


def run(options: Namespace) -> list[str]:
    """Calibrate as the command's options say, and return what is printed."""
    check_calibrate(options)
    settings = load_lab()
    if options.out:
        sweep(options.out.parent)
    robot = given_robot(options.robot, settings.robot)
    if not options.folders:
        limb = options.limb or next(iter(robot.layout.legs.values()), None) or limb_of(robot.layout, None)
        recordings = of_files(options, robot, limb)
        calibration = calibrate_limb(recordings, robot, limb, options.signal or MEAN, options.rate, settings)
        return list(report(calibration, settings.detection.thresholds.confidence))
    network = read_network_folder(options.network, robot.layout, settings) if options.network else None
    limb = limb_of(robot.layout, options.limb, network)
    logs = read_folders(options, robot, network)
    tried = list(_tried(logs, robot, limb, network, options, settings))
    alone = next(detector for detector in tried if detector.name == ALONE)
    kept = tried[-1]
    printed_lines = list[str]()
    if len(tried) > 1 and kept.found.signal != STD:  # a push does not change what a network expects of its error
        total, counts = tried_on_pushes(tried, logs[0].sampling.gain_hz, settings)
        tried = [replace(detector, pushes=count) for detector, count in zip(tried, counts, strict=True)]
        kept = best_of(tried, alone.found)
        printed_lines = list(lines_of(tried, kept, total))
    lines = list(report(kept.found, settings.detection.thresholds.confidence))
    if kept.network and kept.found.signal != STD:
        lines += beside(kept.found, alone.found)
    lines += printed_lines
    if options.out:
        made = thresholds_of(kept.found, options.rate, settings, logs[0].sampling, kept.network)
        write_thresholds(options.out, made)
        lines.append(f"written: {options.out}")
    return lines


def _tried(
    logs: Sequence[OwnLog],
    robot: RobotDescription,
    limb: str,
    network: OwnNetwork | None,
    options: Namespace,
    settings: Lab,
) -> Iterator[DetectorCandidate]:
    """Yield the calibrated detectors among which one is kept, the observer's and then those of a network.

    Where a signal is given, it is kept.
    """

    def calibrated(
        name: str, logs: Sequence[OwnLog], network: OwnNetwork | None, signal: Signal, keep: bool
    ) -> DetectorCandidate:
        recordings = estimated(logs, robot, limb, network, settings)
        return DetectorCandidate(
            name, calibrate_limb(recordings, robot, limb, signal, options.rate, settings), recordings, network, keep
        )

    if robot.friction:
        bare = without_friction(logs, robot, settings.plant.gravity_m_s2)
        yield calibrated(BARE, bare, None, MEAN, keep=False)
    yield calibrated(ALONE, logs, None, MEAN, keep=not (network and options.signal))
    if network:
        for signal in (options.signal,) if options.signal else (MEAN, RATIO):
            yield calibrated(NETWORK.format(signal), logs, network, signal, keep=True)


def main(words: Sequence[str]) -> int:
    """Run the command; return its exit status."""
    options = calibrate_parser().parse_args(words)
    logging.getLogger(observer.__name__).setLevel(logging.WARNING)  # it tells of each segment
    return printed(log, lambda: run(options))


def stem(path: Path) -> Path:
    """Return the path of an array without its ending, however it was typed."""
    return path.with_suffix("") if path.suffix in (".parquet", ".json") else path


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
