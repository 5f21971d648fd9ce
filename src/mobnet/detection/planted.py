"""Pushes that are planted into the estimate of recordings that nothing pushes, to see which of them a detector finds.

What a push does to the joints adds to the residual, and so to every estimate that takes something off it which does not
see the motors' torques. So all detectors of a limb are tried on the same pushes, in the motion that calibrates them,
whose errors are those of the robot. The pushes are those of `./reproduce motion`, section `free_motion.pushes`.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.estimator import Estimate
from mobnet.detection.detector import ALARM_RATIO
from mobnet.detection.gate import Spans
from mobnet.detection.points import points_of
from mobnet.detection.signals import Watched
from mobnet.detection.watch import LegRecording, LimbSetup
from mobnet.kernel.low_pass import low_pass
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import carrier_of, point_torque
from mobnet.settings.free_motion import LinkPushes

NO_LOAD = 1e-9  # share of its torque that a force of 1 N takes of a joint, below which it takes none
HALF = 0.5  # of a push in which the limb must be watched, for it to count
PASSES = 100  # most times that recordings are gone through: they may be too short for a push


@dataclass(frozen=True)
class PushPlan:
    """Numbers of pushes: how many at least, their times and sizes, and how long [s] after one its alarm may come."""

    count: int
    pushes: LinkPushes
    late_s: float


@dataclass(frozen=True)
class Planted:
    """Pushes in a recording: what they do to joints behind the observer's low-pass (T, n) [N m], and their rows."""

    recording: int
    torque: Array
    spans: Spans


def plant(
    setup: LimbSetup,
    nominal: NominalModel,
    gain_hz: float,
    limbs: Sequence[LegRecording],
    poses: Sequence[NDArray[Any]],
    pushing: PushPlan,
    seed: int,
) -> list[Planted]:
    """Draw pushes on the links of a limb in recordings, which are gone through until there are enough.

    Args:
        setup: the limb.
        nominal: model of the robot.
        gain_hz: gain K_0 of the observer [1/s].
        limbs: the limb in each recording.
        poses: position of the robot in each recording (T, nq).
        pushing: numbers of the pushes.
        seed: of what is drawn.
    """
    places = list(_places(setup, nominal))
    rng = np.random.default_rng(seed)
    planted = list[Planted]()
    for _ in range(PASSES):
        for k, (limb, q) in enumerate(zip(limbs, poses, strict=True)):
            torque, spans = _planted(setup, nominal, gain_hz, limb, q, places, pushing, rng)
            if spans:
                planted.append(Planted(k, torque, spans))
            if sum(len(push.spans) for push in planted) >= pushing.count:
                return planted
        if not planted:
            break
    return planted


def found_pushes(
    setup: LimbSetup,
    watched: Watched,
    thresholds: Array,
    limbs: Sequence[LegRecording],
    estimates: Sequence[Estimate],
    planted: Sequence[Planted],
) -> NDArray[np.bool_]:
    """Return which pushes (k,) a detector with thresholds (n,) finds in recordings with their estimates."""
    chain = setup.chain(thresholds[None])
    are_found = list[bool]()
    for push in planted:
        limb = limbs[push.recording]
        estimate = estimates[push.recording]
        pushed = Estimate(estimate.tau_ext + push.torque, estimate.std)
        above = limb.run(chain, watched.of(pushed, limb.command)).ratio > ALARM_RATIO
        are_found += [bool(above[start:end].any()) for start, end in push.spans]
    return np.array(are_found, dtype=bool)


def _places(setup: LimbSetup, nominal: NominalModel) -> Iterator[tuple[str, tuple[float, ...]]]:
    """Yield bodies and places that are pushed: points of the limb, or without any its links' centres of mass."""
    points = points_of(setup.robot, setup.joints)
    if points:
        yield from ((row.body, row.pos) for row in points)
        return
    for body in nominal.robot.bodies:
        if carrier_of(nominal.robot, body.name)[0] in setup.joints:
            yield body.name, body.com


def _planted(
    setup: LimbSetup,
    nominal: NominalModel,
    gain_hz: float,
    limb: LegRecording,
    q: NDArray[Any],
    places: Sequence[tuple[str, tuple[float, ...]]],
    pushing: PushPlan,
    rng: np.random.Generator,
) -> tuple[Array, Spans]:
    """Return what pushes do to the joints in a recording (T, n) [N m], and the rows in which an alarm counts."""
    torque = np.zeros((len(q), len(setup.joints)))
    spans = list[tuple[int, int]]()
    numbers = pushing.pushes
    late = round(pushing.late_s * setup.rate_hz)
    for first, last in limb.segments:
        start = first + round(rng.uniform(*numbers.pause_s) * setup.rate_hz)
        while True:
            length = round(rng.uniform(*(numbers.short_s if rng.random() < HALF else numbers.long_s)) * setup.rate_hz)
            end = start + length
            if end > last:
                break
            body, place = places[int(rng.integers(len(places)))]
            direction = rng.normal(size=3)
            share = rng.uniform(*numbers.torque_share)
            size = _torque(setup, nominal, q[start], body, place, direction / np.linalg.norm(direction), share, numbers)
            if size is not None and limb.gate.watched[start:end].mean() > HALF:
                ramp = min(max(1, round(numbers.ramp_s * setup.rate_hz)), max(1, length // 2))
                rows = np.arange(length)
                torque[start:end] = np.minimum(1.0, np.minimum(rows + 1, length - rows) / ramp)[:, None] * size
                spans.append((start, min(end + late, last)))
            start = end + round(rng.uniform(*numbers.pause_s) * setup.rate_hz)
        torque[first:last] = low_pass(torque[first:last], gain_hz, setup.rate_hz)
    return torque, tuple(spans)


def _torque(
    setup: LimbSetup,
    nominal: NominalModel,
    q: NDArray[Any],
    body: str,
    place: Sequence[float],
    direction: Array,
    share: float,
    numbers: LinkPushes,
) -> Array | None:
    """Return what a push of a share of the joints' largest torques does to them (n,) [N m]; None if it turns none."""
    robot = nominal.robot
    wrench = np.concatenate([direction, np.zeros(3)])[None]
    whole = point_torque(nominal, body, place, np.eye(3), np.asarray(q, dtype=np.float64)[None], wrench)[0]
    load = (np.abs(whole[-robot.layout.nu :]) / robot.torque_limits).max()
    if load < NO_LOAD:
        return None
    weight = sum(row.mass for row in robot.bodies) * np.linalg.norm(nominal.model.gravity.linear)
    force = min(share / load, numbers.weight_share * float(weight))
    return force * whole[robot.layout.columns(setup.joints)]
