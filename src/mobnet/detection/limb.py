"""Thresholds of a limb from recordings that nothing pushes: of a leg in its swings, of any other limb all the time."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL, named
from mobnet.core.errors import DataError, refuse
from mobnet.core.estimator import Estimate
from mobnet.core.notes import pair_differences, read_array_note
from mobnet.core.recording import SensedRecording
from mobnet.core.recording_file import read_sensed
from mobnet.core.store import NOTE, check_finite, file_of
from mobnet.detection.always import AlwaysWatched, always_watched, setup_of
from mobnet.detection.calibration import QuietWalk, check_signals, rate_scales, swing_heights
from mobnet.detection.points import axis_forces, found_forces
from mobnet.detection.signals import RATIO, STD, Watched
from mobnet.detection.thresholds import Calibrated
from mobnet.detection.watch import LegRecording, LegSetup, LimbSetup, read_estimate
from mobnet.kernel.detecting import Signal, WatchedSignals
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel
from mobnet.settings.detection import Detection
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
        read = read_estimate(estimate, joints)
        if read is None:
            missing = f"column {named(EXTERNAL, joints)[0]!r} is missing"
            raise DataError(f"{estimate}: {missing}; accepted: an estimate of {', '.join(joints)}")
        check_finite(f"{estimate}", read.tau_ext, named(EXTERNAL, joints))
        return cls(recording, read_sensed(recording, robot.layout), read)


@dataclass(frozen=True)
class LimbCalibration:
    """Thresholds of a limb.

    Attributes:
        setup: its joints, filters and rate.
        signal: what is watched.
        thresholds: of each joint (n,) [N m], of a ratio [-].
        promise: rate of false alarms to expect, with its interval.
        count: number of swings or windows that they are made from.
        felt: torque of each joint that reaches its threshold in most samples (n,) [N m].
        forces: point -> the least force that is found there, along each axis of its body or from one side [N].
        limbs: it in each recording.
        always: the windows; None of a leg that is watched in its swings.
    """

    setup: LimbSetup
    signal: Signal
    thresholds: Array
    promise: Calibrated
    count: int
    felt: Array
    forces: Mapping[str, Array]
    limbs: tuple[LegRecording, ...]
    always: AlwaysWatched | None = None

    @property
    def least(self) -> Array:
        """Return the least forces that are found at all points (k,) [N]; without points, torques (n,) [N m]."""
        forces = np.concatenate([np.empty(0), *self.forces.values()])
        return forces if np.isfinite(forces).any() else self.felt

    def over(self, other: "LimbCalibration") -> float:
        """Return the geometric mean of how many times the least forces are those of another detector of the limb."""
        finite = np.isfinite(self.least) & np.isfinite(other.least)
        return float(np.exp(np.mean(np.log(self.least[finite] / other.least[finite]))))


def watched_signal(signal: Signal) -> Watched:
    """Return what a detector of a limb watches: one signal of an estimate."""
    return Watched(WatchedSignals((signal,)))


def calibrate_limb(
    recordings: Sequence[OwnRecording],
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
    _check_rates(recordings, settings.detection.sensitivity.contact_s)
    walks = limb in robot.layout.legs.values() and _walks(recordings)
    own_way = {"scale_quantile": settings.robotlog.scale_quantile, "on_average": settings.robotlog.on_average}
    detection = _with_thresholds(settings.detection, rates_per_h={WANTED: rate_per_h}, **own_way)
    setup = setup_of(detection, robot, limb, recordings[0].read.rate_hz, walks=walks)
    watched = watched_signal(signal)
    if isinstance(setup, LegSetup):
        return _calibrate_leg(setup, watched, recordings)
    return _calibrate_always(setup, watched, recordings, settings)


def _with_thresholds(detection: Detection, **changes: object) -> Detection:
    """Return the section of detectors with other numbers of how thresholds are made."""
    return detection.model_copy(update={"thresholds": detection.thresholds.model_copy(update=changes)})


def _calibrate_leg(setup: LegSetup, watched: Watched, recordings: Sequence[OwnRecording]) -> LimbCalibration:
    """Calibrate a leg in its swings; forces are from one side (1,) [N]."""
    legs = [setup.record(recording.path, recording.read, recording.estimate.tau_ext) for recording in recordings]

    def forces_of(poses: Array, felt: Array) -> dict[str, Array]:
        return {point: np.array([force]) for point, force in found_forces(setup, poses, felt).items()}

    return _calibrated(setup, watched, recordings, legs, forces_of)


def _calibrate_always(
    setup: LimbSetup, watched: Watched, recordings: Sequence[OwnRecording], settings: Lab
) -> LimbCalibration:
    """Calibrate a limb that is watched all the time; forces are along three axes (3,) [N]."""
    detection = _with_thresholds(setup.detection, confidence=settings.robotlog.percentiles)
    setup = replace(setup, detection=detection)
    paths = [recording.path for recording in recordings]
    read = [recording.read for recording in recordings]
    estimates = [recording.estimate for recording in recordings]
    lengths = (settings.detection.window_s, settings.robotlog.settle_s)
    always = always_watched(setup, watched, paths, read, estimates, *lengths)

    def forces_of(poses: Array, felt: Array) -> dict[str, Array]:
        nominal = NominalModel(setup.robot, gravity_m_s2=settings.plant.gravity_m_s2)
        return axis_forces(setup, nominal, poses, felt)

    return replace(_calibrated(setup, watched, recordings, always.limbs, forces_of), always=always)


def _calibrated(
    setup: LimbSetup,
    watched: Watched,
    recordings: Sequence[OwnRecording],
    legs: Sequence[LegRecording],
    forces_of: Callable[[Array, Array], dict[str, Array]],
) -> LimbCalibration:
    """Calibrate a limb as its detector sees it in recordings.

    `forces_of` returns point -> least force that is found [N], of the poses in which the limb is watched (T, nq) and of
    the torques that reach its thresholds there (T, n) [N m].
    """
    (signal,) = watched.detector.signals
    # Nothing is tried here on what is held out, so that all swings calibrate.
    walk = QuietWalk.of(setup, "", legs, [recording.estimate for recording in recordings], share=1.0)
    check_signals(setup, watched.detector, walk)
    scales, promises = rate_scales(setup, watched, walk, swing_heights(setup, watched, walk))
    thresholds = promises[WANTED].factor * scales[0]
    pairs = [(recording, leg.gate.watched) for recording, leg in zip(recordings, legs, strict=True)]
    poses = np.concatenate([recording.read.sensed.q[rows] for recording, rows in pairs])
    stds = [
        recording.estimate.std[rows]
        for recording, rows in pairs
        if signal == RATIO and recording.estimate.std is not None
    ]
    felt = thresholds * (np.concatenate(stds) if stds else np.ones((len(poses), len(thresholds))))
    return LimbCalibration(
        setup=setup,
        signal=signal,
        thresholds=thresholds,
        promise=promises[WANTED],
        count=walk.first,
        felt=np.quantile(felt, setup.detection.sensitivity.share, axis=0),
        forces={} if signal == STD else forces_of(poses, felt),
        limbs=tuple(legs),
    )


def _check_rates(recordings: Sequence[OwnRecording], contact_s: float) -> None:
    """Raise a DataError where recordings differ in their rate, or a collision of a length [s] is not seen at it."""
    first = recordings[0]
    least = CONTACT_SAMPLES / contact_s
    if first.read.rate_hz < least:
        needed = f"{least:.0f} Hz or more are needed, as collisions last for {contact_s * 1e3:.0f} ms"
        raise DataError(f"{first.path}: rate_hz is {first.read.rate_hz}; {needed}")
    for recording in recordings:
        if recording.read.rate_hz != first.read.rate_hz:
            needed = f"all need that of {first.path}, {first.read.rate_hz}"
            raise DataError(f"{recording.path}: rate_hz is {recording.read.rate_hz}; {needed}")


def _walks(recordings: Sequence[OwnRecording]) -> bool:
    """Return whether recordings tell when a leg is in the air; a DataError says that some do and others do not."""
    expected = recordings[0].read.unplanned()
    for recording in recordings:
        if (missing := recording.read.unplanned()) != expected:
            lacks = f"{', '.join(missing) or 'nothing'} is missing, and {', '.join(expected) or 'nothing'}"
            raise DataError(f"{recording.path}: {lacks} in {recordings[0].path}; all need the same signals")
    return not expected
