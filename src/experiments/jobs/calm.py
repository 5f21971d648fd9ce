"""The rule `watch`: thresholds of limbs that are watched all the time and of the feet's sensors, from a random walk.

[5.3] Thresholds are larger than the largest signal in normal walking by a margin: so are those of the sensors. In limbs
that are watched all the time a false alarm is as likely in each second, so that theirs are those of a wanted rate, as
of the swings of legs; windows of time take the place of swings.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import astuple, fields, replace
from pathlib import Path

import numpy as np

from experiments.jobs.reacting_robot import BASE_LIMB, ReactingRobot
from experiments.plan.parts import MethodRun
from experiments.records.reactions import FORCE_SENSORS
from mobnet.core.arrays import Array
from mobnet.core.detections import LARGEST, Threshold
from mobnet.core.estimator import Estimate, Stretch, TorqueEstimator, estimate_all
from mobnet.core.files import write_text
from mobnet.core.recording import Recording, Sensed
from mobnet.core.recording_file import read_recording
from mobnet.core.rows import csv_text
from mobnet.detection.calibration import unit_of
from mobnet.detection.thresholds import calibrate
from mobnet.detection.watch import LegSetup
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import TailNumbers
from mobnet.reaction.watchers import some
from mobnet.settings.detection import Detection
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.reaction import Reaction
from mobnet.settings.walking import WalkSettings

FORCE = "force"  # the signal of a foot's sensor
COLUMNS = tuple(field.name for field in fields(Threshold))


def watch(
    settings: WalkSettings,
    reaction: Reaction,
    detection: Detection,
    observer: ObserverSettings,
    runs: Mapping[str, MethodRun],
    quiet: Sequence[Path],
    out: Path,
) -> None:
    """Write the thresholds of `reaction.watched` and of the feet's sensors, rows of `Threshold`.

    Args:
        settings: the walk of the recordings on this robot.
        reaction: numbers of the pipeline.
        detection: gate, chain and rules of thresholds.
        observer: the observer's settings.
        runs: networks of the method in the loop.
        quiet: recordings of random walking that nothing pushes; they are read until `reaction.calm_s` are full.
        out: file.

    Raises:
        DataError: a recording is missing or damaged, or they are too short.
    """
    robot = ReactingRobot(settings, reaction, detection, observer, runs)
    # The unexpected force on the base needs the legs, too.
    legs = detection.legs if BASE_LIMB in reaction.watched else ()
    estimator = robot.estimator(reaction.estimator, (*reaction.watched, *legs))
    limbs = {limb: list[Array]() for limb in reaction.watched}
    forces = list[list[float]]()
    for calm in calm_parts(robot, quiet):
        for limb, signals in _signals(robot, estimator, calm):
            limbs[limb].append(window_heights(robot, signals))
        forces.append([swing_force(setup, calm) for setup in robot.setups])
        del calm  # before the next one is read: a walk of ten minutes with its truth has 0.7 GB
    rows = [*_limbs(robot, limbs), *_feet(robot, np.max(forces, axis=0))]
    write_text(out, csv_text(COLUMNS, [astuple(row) for row in rows]))


def calm_parts(robot: ReactingRobot, quiet: Sequence[Path]) -> Iterator[Recording]:
    """Yield recordings, of the last one its first part, until `reaction.calm_s` are full."""
    left = round(robot.reaction.calm_s * robot.rate_hz)
    for path in quiet:
        if left > 0:
            walk = first_part(read_recording(path, robot.description.layout), left)
            left -= len(walk.sensed)
            yield walk
            del walk  # as its reader does


def _signals(robot: ReactingRobot, estimator: TorqueEstimator, calm: Recording) -> Iterator[tuple[str, Array]]:
    """Yield limb and signals (T, n) of our detector in each segment of a walk, behind the low-pass."""
    spans = list(calm.spans())
    estimates = estimate_all(estimator, [Stretch(calm.sensed[span]) for span in spans])
    for span, estimate in zip(spans, estimates, strict=True):
        for limb in robot.reaction.watched:
            of_limb = watched_of(robot, limb, estimator.joints, calm.sensed[span], estimate)
            signals = robot.watched.of(of_limb, calm.sensed[span].command)
            yield limb, robot.setups[0].low_passed(signals, ((0, len(signals)),))


def watched_of(robot: ReactingRobot, limb: str, joints: Sequence[str], sensed: Sensed, estimate: Estimate) -> Estimate:
    """Return what a limb is watched by, from an estimate of some joints (T, n): its own, or the force on the base."""
    layout = robot.description.layout
    if limb != BASE_LIMB:
        joint_columns = np.array([joints.index(joint) for joint in layout.limb(limb)])
        return some(estimate, joint_columns)
    columns = layout.columns(joints)
    tau = np.zeros((len(sensed), layout.nv))
    tau[:, columns] = estimate.tau_ext
    std = np.zeros_like(tau)
    if estimate.std is not None:
        std[:, columns] = estimate.std
    return robot.base.run(sensed, Estimate(tau, None if estimate.std is None else std))


def window_heights(robot: ReactingRobot, signals: Array) -> Array:
    """Return the largest size of signals (T, n) of a segment in each whole window of it, (k, n)."""
    window = round(robot.detection.window_s * robot.rate_hz)
    whole = signals[: len(signals) // window * window]
    return np.abs(whole).reshape(-1, window, signals.shape[1]).max(axis=1)


def _limbs(robot: ReactingRobot, limbs: Mapping[str, Sequence[Array]]) -> Iterator[Threshold]:
    """Yield the thresholds of limbs for the rate of our detector, from the heights (k, n) of windows in segments."""
    ours = robot.reaction.ours
    for limb, heights in limbs.items():
        names = robot.watched.names(robot.joints_of(limb))
        for name, value in zip(names, limb_thresholds(robot, heights), strict=True):
            yield Threshold(ours.detector, limb, ours.rule, name, 1, float(value), unit_of(name))


def limb_thresholds(robot: ReactingRobot, heights: Sequence[Array]) -> Array:
    """Return the thresholds of a limb's signals (n,) from their largest sizes (k, n) in the windows of segments."""
    numbers = robot.detection.thresholds
    largest = np.concatenate(heights)
    episodes = np.repeat(np.arange(len(heights)), [len(part) for part in heights])
    scale = np.quantile(largest, numbers.scale_quantile, axis=0)
    rate_per_h = numbers.rates_per_h[robot.reaction.ours.rule]
    walked_s = len(largest) * robot.detection.window_s
    calibration = calibrate(
        (largest / scale).max(axis=1), episodes.tolist(), walked_s, rate_per_h, as_plain(numbers, TailNumbers)
    )
    return calibration.factor * scale


def _feet(robot: ReactingRobot, forces: Array) -> Iterator[Threshold]:
    """Yield the thresholds of the feet's sensors by the paper's rule, from the largest forces in swings (k,) [N]."""
    for setup, force in zip(robot.setups, forces, strict=True):
        value = robot.detection.thresholds.margin * float(force)
        yield Threshold(FORCE_SENSORS, setup.limb, LARGEST, FORCE, 1, value, "N")


def swing_force(setup: LegSetup, walk: Recording) -> float:
    """Return the largest force on a foot in its swing [N], by its sensor, behind the low-pass."""
    # Without a torque the gate knows no early contact, so that the truth says where the foot is on the ground.
    nothing = np.zeros((len(walk.sensed), len(setup.joints)))
    watched = setup.gate.watch(walk, nothing).watched & (walk.truth.contact[:, setup.gate.foot] == 0)
    wrench = (walk.truth.wrench_left_foot, walk.truth.wrench_right_foot)[setup.gate.foot]
    force = setup.low_passed(np.ascontiguousarray(wrench[:, :3], dtype=np.float64), walk.segments)
    return float(np.linalg.norm(force, axis=1)[watched].max())


def first_part(walk: Recording, samples: int) -> Recording:
    """Return the first samples of a recording."""
    segments = tuple((start, min(end, samples)) for start, end in walk.segments if start < samples)
    return replace(walk, sensed=walk.sensed[:samples], truth=walk.truth[:samples], segments=segments)
