"""Which detector of a limb finds most pushes at one rate of false alarms: without friction, with it, with a network."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from mobnet.core.estimator import Estimate
from mobnet.detection.limb import LimbCalibration, OwnRecording, watched_signal
from mobnet.detection.planted import PushPlan, found_pushes, plant
from mobnet.estimation.own import OwnNetwork
from mobnet.robot.nominal import NominalModel
from mobnet.settings.lab import Lab

BARE = "observer without the table's friction"
ALONE = "observer"
NETWORK = "network, {}"
SEED = 0  # of the pushes


@dataclass(frozen=True)
class DetectorCandidate:
    """A detector of a limb, calibrated for a rate of false alarms on estimates, and how many of the pushes it finds.

    Only one that `may_be_kept` is written. The detector has a network, or is that of the observer.
    """

    name: str
    found: LimbCalibration
    own: Sequence[OwnRecording]
    network: OwnNetwork | None = None
    may_be_kept: bool = True
    pushes: int = 0


def pushing_of(settings: Lab) -> PushPlan:
    """Return the pushes that are planted."""
    return PushPlan(settings.robotlog.planted, settings.free_motion.pushes, settings.robotlog.flag_gap_s)


def tried_on_pushes(tried: Sequence[DetectorCandidate], gain_hz: float, settings: Lab) -> tuple[int, list[int]]:
    """Return how many pushes are planted into the recordings that calibrated detectors, and how many each one finds.

    The gain is that of the observer, K_0 [1/s].
    """
    first = tried[0]
    nominal = NominalModel(first.found.setup.robot, gravity_m_s2=settings.plant.gravity_m_s2)
    poses = [detector.read.sensed.q for detector in first.own]
    planted = plant(first.found.setup, nominal, gain_hz, first.found.limbs, poses, pushing_of(settings), SEED)
    counts = list[int]()
    for detector in tried:
        watched = watched_signal(detector.found.signal)
        estimates = [Estimate(recording.estimate.tau_ext, recording.estimate.std) for recording in detector.own]
        setup = detector.found.setup
        limbs = detector.found.limbs
        hits = found_pushes(setup, watched, detector.found.thresholds, limbs, estimates, planted)
        counts.append(int(np.count_nonzero(hits)))
    return sum(len(detector.spans) for detector in planted), counts


def best_of(tried: Sequence[DetectorCandidate], alone: LimbCalibration) -> DetectorCandidate:
    """Return the detector that is kept: the one that finds most pushes, and of equals the smaller forces."""
    kept = [detector for detector in tried if detector.may_be_kept]
    return max(kept, key=lambda detector: (detector.pushes, -detector.found.over(alone)))


def lines_of(tried: Sequence[DetectorCandidate], kept: DetectorCandidate, total: int) -> Iterator[str]:
    """Yield how many of all pushes each detector finds, and which is kept."""
    width = max(len(detector.name) for detector in tried)
    yield from ("", f"found of {total} pushes that are planted into these logs, at this rate of false alarms:")
    for detector in tried:
        yield f"  {detector.name:<{width}} {detector.pushes:6d} {detector.pushes / max(total, 1):5.0%}"
    yield f"kept, as it finds most: {kept.name}"
    better = [detector.name for detector in tried if not detector.may_be_kept and detector.pushes > kept.pushes]
    yield from (f"the {name} finds more: take a table without `friction`" for name in better)
