"""The estimate of a limb in a log, and its flags: what `./reproduce detect` computes.

Observer, network, filters and thresholds are those of a closed loop, run over the whole log: flags are the same.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError
from mobnet.core.estimator import Estimate
from mobnet.detection.always import always_on
from mobnet.detection.detector import GateSignal, run_segments
from mobnet.detection.threshold_file import sampling_of, setup_with, watched_of
from mobnet.detection.watch import LegSetup, LimbSetup
from mobnet.estimation.own import OwnLog, OwnNetwork, estimates_of
from mobnet.estimation.sampling import estimator_of
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.formats.log_map import LogMap
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.flags import Flag, PushCount, flags_of, found_pushes
from mobnet.robotlog.observe import ObservedLog, observe_log
from mobnet.settings.lab import Lab


@dataclass(frozen=True)
class LogDetection:
    """A log, the estimate of a limb (T, n) [N m], what is watched of it behind the low-pass (T, n), and its flags.

    `found` counts them beside the pushes of a log that tells them.
    """

    observed: ObservedLog
    estimate: Estimate
    watched: Array
    flags: tuple[Flag, ...]
    found: PushCount | None


def detect_log(
    path: Path,
    robot: RobotDescription,
    meaning: LogMap | None,
    network: OwnNetwork | None,
    thresholds: LimbThresholds,
    settings: Lab,
) -> LogDetection:
    """Estimate the external torque of a limb in a log, and flag what lies above its thresholds.

    Raises:
        DataError: the log cannot be read, its rate is not that of the thresholds, or it does not say when a leg that
            is watched in its swings is in the air.
        ConfigError: the map does not fit the robot.
    """
    sampling = sampling_of(thresholds)
    gravity = settings.plant.gravity_m_s2
    if meaning and meaning.rate_hz is None:
        meaning = meaning.model_copy(update={"rate_hz": sampling.rate_hz})
    observed = observe_log(path, robot, meaning, thresholds.torque, thresholds.gain_hz, gravity, settings.robotlog)
    read = observed.converted.recording
    if read.rate_hz != sampling.rate_hz:
        made = f"the thresholds were made at {sampling.rate_hz:g} Hz; a --map with rate_hz resamples the log"
        raise DataError(f"{path}: its rate is {read.rate_hz} Hz, and {made}")
    log = OwnLog(path, read, observed.residual.astype(np.float32), sampling)
    estimator = estimator_of(robot, gravity, sampling, network and network.networks)
    (estimate,) = estimates_of([log], estimator, thresholds.joints)
    setup = setup_with(thresholds, settings.detection, robot)
    gate = _gate(path, setup, observed, estimate, thresholds)
    signals = watched_of(thresholds).of(estimate, read.sensed.command)
    alarm = run_segments(setup.chain(np.array([thresholds.thresholds])), signals, gate, read.segments)
    low = setup.low_passed(estimate.tau_ext.astype(np.float64), read.segments)
    nominal = NominalModel(robot, gravity_m_s2=gravity)
    flags = tuple(
        flags_of(
            alarm, observed.converted.time_s, read, low, estimate.std, thresholds, nominal, settings.robotlog.flag_gap_s
        )
    )
    known = found_pushes(observed.converted, thresholds.joints, flags, settings.robotlog.flag_gap_s)
    return LogDetection(observed, estimate, setup.low_passed(signals, read.segments), flags, known)


def _gate(
    path: Path, setup: LimbSetup, observed: ObservedLog, estimate: Estimate, thresholds: LimbThresholds
) -> GateSignal:
    """Return when the limb is watched; a DataError says that thresholds of swings do not fit the log."""
    read = observed.converted.recording
    if not isinstance(setup, LegSetup):
        return always_on(len(read.sensed), read.segments, thresholds.settle_s, read.rate_hz)
    if missing := read.unplanned():
        # They would be zero, as of a foot on the ground: nothing would ever be watched.
        text = f"{', '.join(missing)}: missing in the log or its map"
        raise DataError(f"{path}: {text}; accepted: a log with them, as {thresholds.limb} is watched in its swings")
    return setup.record(path, read, estimate.tau_ext).gate
