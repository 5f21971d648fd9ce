"""What `./reproduce calibrate` prints of a limb's thresholds, and the section that it writes."""

from collections.abc import Iterator

import numpy as np

from mobnet.core.errors import beyond, refuse_lines
from mobnet.detection.calibration import unit_of
from mobnet.detection.limb import LimbCalibration
from mobnet.detection.points import AXES
from mobnet.estimation.own import OwnNetwork
from mobnet.estimation.sampling import LEARNED, OBSERVER, Sampling
from mobnet.formats.base import THRESHOLD
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.settings.lab import Lab

NOTHING = 1e-3  # share of the expected rate below which one counts as zero


def report(calibration: LimbCalibration, confidence: float) -> Iterator[str]:
    """Yield what the command prints, line by line; the confidence is that of the interval."""
    promise = calibration.promise
    unit = unit_of(f"{calibration.signal}.")
    what = f"windows of {calibration.always.window_s:g} s" if calibration.always else "swings"
    width = max(map(len, ("joint", *calibration.setup.joints)))
    if calibration.always and calibration.setup.limb in calibration.setup.robot.layout.legs.values():
        yield f"{calibration.setup.limb} is watched all the time: the recordings do not tell when it is in the air"
    yield from (
        f"{calibration.count} {what}",
        "",
        f"{'joint':<{width}}  threshold of the {calibration.signal} [{unit}]",
    )
    pairs = zip(calibration.setup.joints, calibration.thresholds, strict=True)
    yield from (f"{joint:<{width}} {value:14.2f}" for joint, value in pairs)
    low = promise.low if promise.low > NOTHING * promise.rate_per_h else 0.0
    interval = f"{confidence:.0%} interval {low:.2g} to {promise.high:.2g}"
    time = "walking"
    if (
        calibration.always
    ):  # (D19) draws windows one by one: where errors last, it holds the rate less often than it is named
        time = "free motion"
        interval = f"nominal {interval}, which takes windows for independent"
    yield from ("", f"false alarms to expect: {promise.rate_per_h:.2g} in an hour of {time}, {interval}", "")
    if calibration.always and calibration.always.is_alike:
        yield from ("windows that follow each other are alike: the interval is too narrow, record for longer", "")
    if not calibration.forces:
        yield "smallest force that is found: not told, as the table has no `points` on this limb, or sigma is watched"
        return
    yield f"smallest force that is found [N], by point of the limb{_along(calibration)}:"
    yield from _forces(calibration)


def beside(calibration: LimbCalibration, alone: LimbCalibration) -> Iterator[str]:
    """Yield how a network's detector stands to that of the observer alone."""
    if alone.forces:
        yield from ("", f"smallest force that the observer alone finds [N]{_along(alone)}:", *_forces(alone))
    what = "forces" if calibration.forces else "torques"
    share = calibration.over(alone)
    yield from ("", f"smallest {what} with the network over those of the observer alone: {share:.0%}, geometric mean")
    if share >= 1.0:
        yield "the network does not help this detector with short pushes: learn from more logs"


def _along(calibration: LimbCalibration) -> str:
    """Return along what forces are told."""
    return f", along {', '.join(AXES)} of its body" if calibration.always else ""


def _forces(calibration: LimbCalibration) -> Iterator[str]:
    """Yield the smallest forces of a limb, a line for each point."""
    for point, forces in calibration.forces.items():
        yield f"{point:<24} " + " ".join(f"{force:8.3g}" if np.isfinite(force) else f"{'-':>8}" for force in forces)


def thresholds_of(
    calibration: LimbCalibration, rate_per_h: float, settings: Lab, sampling: Sampling, network: OwnNetwork | None
) -> LimbThresholds:
    """Return the section of a limb's thresholds, made for a rate of false alarms [1/h].

    Raises:
        DataError: a threshold is not accepted; it is zero of an estimate that never changes.
    """
    setup = calibration.setup
    promise = calibration.promise
    values = tuple(calibration.thresholds.tolist())
    for joint, value in zip(setup.joints, values, strict=True):
        refuse_lines(beyond(f"threshold of {joint}", value, THRESHOLD))
    return LimbThresholds(
        robot=setup.robot.name,
        limb=setup.limb,
        joints=setup.joints,
        method=LEARNED if network else OBSERVER,
        network=network.fingerprint if network else None,
        signal=calibration.signal,
        thresholds=values,
        watched="always" if calibration.always else "swing",
        settle_s=settings.robotlog.settle_s if calibration.always else 0.0,
        low_pass_hz=setup.detection.low_pass_hz,
        hold_s=setup.detection.hold_s,
        rate_hz=sampling.rate_hz,
        gain_hz=sampling.gain_hz,
        torque=sampling.torque,
        drives=sampling.drives,
        rate_per_h=rate_per_h,
        expected_per_h=promise.rate_per_h,
        low_per_h=promise.low,
        high_per_h=promise.high,
        confidence=settings.detection.thresholds.confidence,
    )
