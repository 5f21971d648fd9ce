"""Thresholds of a limb from recordings that nothing pushes: of a leg in its swings, of any other limb all the time."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL, named
from mobnet.core.errors import DataError, not_accepted, refuse
from mobnet.core.estimator import Estimate
from mobnet.core.notes import pair_differences, read_array_note
from mobnet.core.recording import SensedRecording, read_sensed
from mobnet.core.store import NOTE, check_finite, file_of
from mobnet.detection.always import AlwaysWatched, always_watched, setup_of
from mobnet.detection.calibration import QuietWalk, check_signals, rate_scales
from mobnet.detection.points import axis_forces
from mobnet.detection.sensitivity import found_forces
from mobnet.detection.signals import RATIO, STD, Watched
from mobnet.detection.thresholds import Calibrated
from mobnet.detection.watch import LegRecording, LegSetup, LimbSetup, read_estimate
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel
from mobnet.settings.detection import Detector, Signal
from mobnet.settings.lab import Lab

WANTED = "wanted"  # the only rule of thresholds
CONTACT_SAMPLES = 2  # of the shortest collision that a rate of samples shows


@dataclass(frozen=True)
class OwnRecording:
    """A recording of one's own with an estimate of the joints of a limb (T, n) [N, N m]."""

    path: Path
    read: SensedRecording
    estimate: Estimate

    @classmethod
    def read_files(cls, recording: Path, estimate: Path, robot: RobotDescription, limb: str) -> "OwnRecording":
        """Read a recording and its estimate, paths without an ending.

        Raises:
            DataError: a file is missing or damaged, a number is not finite, or the notes of the two differ.
        """
        note, other = (read_array_note(file_of(stem, NOTE)) for stem in (estimate, recording))
        refuse(f"{estimate}{NOTE}", pair_differences(note, other, f"{recording}{NOTE}"))
        joints = robot.layout.limb(limb)
        found = read_estimate(estimate, joints)
        if found is None:
            missing = f"column {named(EXTERNAL, joints)[0]!r} is missing"
            raise DataError(f"{estimate}: {missing}; accepted: an estimate of {', '.join(joints)}")
        check_finite(f"{estimate}", found.tau_ext, named(EXTERNAL, joints))
        return cls(recording, read_sensed(recording, robot.layout), found)


@dataclass(frozen=True)
class LimbCalibration:
    """Thresholds of a limb.

    Attributes:
        setup: its joints, filters and rate.
        signal: what is watched.
        thresholds: of each joint (n,) [N m], of a ratio [-].
        promise: rate of false alarms to expect, with its interval.
        count: number of swings or windows that they are made from.
        always: the windows; None of a leg that is watched in its swings.
        felt: torque of each joint that reaches its threshold in most samples (n,) [N m].
        forces: point -> the least force that is found there, along each axis of its body or from one side [N].
        limbs: it in each recording.
    """

    setup: LimbSetup
    signal: Signal
    thresholds: Array
    promise: Calibrated
    count: int
    always: AlwaysWatched | None
    felt: Array
    forces: Mapping[str, Array]
    limbs: tuple[LegRecording, ...] = ()

    @property
    def least(self) -> Array:
        """Return the least forces that are found at all points (k,) [N]; without points, torques (n,) [N m]."""
        forces = np.concatenate([np.empty(0), *self.forces.values()])
        return forces if np.isfinite(forces).any() else self.felt

    def over(self, other: "LimbCalibration") -> float:
        """Return the geometric mean of how many times the least forces are those of another detector of the limb."""
        finite = np.isfinite(self.least) & np.isfinite(other.least)
        return float(np.exp(np.mean(np.log(self.least[finite] / other.least[finite]))))


def watched_signal(signal: Signal, settings: Lab) -> Watched:
    """Return what a detector of a limb watches: one signal of an estimate."""
    return Watched(Detector(method=settings.detection.gate.method, signals=(signal,)))


def calibrate_limb(
    own: Sequence[OwnRecording],
    robot: RobotDescription,
    limb: str,
    signal: Signal,
    rate_per_h: float,
    settings: Lab,
) -> LimbCalibration:
    """Calibrate a detector of a limb on recordings that nothing pushes.

    Raises:
        DataError: a column never changes, recordings differ in their rate, there are too few swings or windows, or the
            rate is above what the fitted tail holds.
        ConfigError: the limb is unknown.
    """
    _check_rates(own, settings.detection.sensitivity.contact_s)
    rate_hz = own[0].read.rate_hz
    walks = limb in robot.layout.legs.values() and _walks(own)
    setup = _wanting(setup_of(settings.detection, robot, limb, rate_hz, walks=walks), rate_per_h, settings)
    watched = watched_signal(signal, settings)
    always, legs = _watched(setup, watched, own, settings)
    # Nothing is tried here on what is held out, so that all swings calibrate.
    walk = QuietWalk.of(setup, "", legs, [one.estimate for one in own], share=1.0)
    check_signals(setup, watched.detector, walk)
    scales, promises = rate_scales(setup, watched, walk)
    thresholds = promises[WANTED].factor * scales[0]
    pairs = [(one, leg.gate.watched) for one, leg in zip(own, legs, strict=True)]
    poses = np.concatenate([one.read.sensed.q[rows] for one, rows in pairs])
    stds = [one.estimate.std[rows] for one, rows in pairs if signal == RATIO and one.estimate.std is not None]
    felt = thresholds * (np.concatenate(stds) if stds else np.ones((len(poses), len(thresholds))))
    forces = {} if signal == STD else _forces(setup, poses, felt, settings)
    usual = np.quantile(felt, setup.detection.sensitivity.share, axis=0)
    return LimbCalibration(setup, signal, thresholds, promises[WANTED], walk.first, always, usual, forces, tuple(legs))


def _check_rates(own: Sequence[OwnRecording], contact_s: float) -> None:
    """Raise a DataError where recordings differ in their rate, or a collision of a length [s] is not seen at it."""
    first = own[0]
    least = CONTACT_SAMPLES / contact_s
    if first.read.rate_hz < least:
        accepted = [f"{least:.0f} or more, as collisions last for {contact_s * 1e3:.0f} ms"]
        raise DataError(not_accepted(f"{first.path}: rate_hz", first.read.rate_hz, accepted))
    for one in own:
        if one.read.rate_hz != first.read.rate_hz:
            accepted = [f"{first.read.rate_hz}, that of the first"]
            raise DataError(not_accepted(f"{one.path}: rate_hz", one.read.rate_hz, accepted))


def _walks(own: Sequence[OwnRecording]) -> bool:
    """Return whether recordings tell when a leg is in the air; a DataError says that some do and others do not."""
    expected = own[0].read.unplanned()
    for one in own:
        if (missing := one.read.unplanned()) != expected:
            accepted = [f"{', '.join(expected) or 'nothing'}, as in {own[0].path}"]
            raise DataError(not_accepted(f"{one.path}: missing", ", ".join(missing) or "nothing", accepted))
    return not expected


def _wanting(setup: LimbSetup, rate_per_h: float, settings: Lab) -> LimbSetup:
    """Return a setup with one wanted rate of false alarms [1/h]."""
    numbers = setup.detection.thresholds.model_copy(update={"rates_per_h": {WANTED: rate_per_h}})
    if not isinstance(setup, LegSetup):
        numbers = numbers.model_copy(update={"confidence": settings.robotlog.percentiles})
    return replace(setup, detection=setup.detection.model_copy(update={"thresholds": numbers}))


def _watched(
    setup: LimbSetup, watched: Watched, own: Sequence[OwnRecording], settings: Lab
) -> tuple[AlwaysWatched | None, Sequence[LegRecording]]:
    """Return the windows of a limb where it is always watched, and it in recordings as its detector sees it."""
    if isinstance(setup, LegSetup):
        return None, [setup.record(one.path, one.read, one.estimate.tau_ext) for one in own]
    paths, read, estimates = zip(*((one.path, one.read, one.estimate) for one in own), strict=True)
    lengths = settings.detection.window_s, settings.robotlog.settle_s
    always = always_watched(setup, watched, paths, read, estimates, *lengths)
    return always, always.limbs


def _forces(setup: LimbSetup, poses: Array, thresholds: Array, settings: Lab) -> dict[str, Array]:
    """Return point -> least force that is found, from one side (1,) or along three axes (3,) [N]."""
    if isinstance(setup, LegSetup):
        return {point: np.array([force]) for point, force in found_forces(setup, poses, thresholds).items()}
    nominal = NominalModel(setup.robot, gravity_m_s2=settings.plant.gravity_m_s2)
    return axis_forces(setup, nominal, poses, thresholds)
