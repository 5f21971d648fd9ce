"""Detectors on collisions: which they find, how late, which link they name; and the swings between collisions."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from experiments.jobs.collisions import Hit, hits_of
from experiments.plan.detection import Walk
from experiments.records.collisions import UNPUSHED, Collision, CurvePoint, Detected
from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL_LP, named
from mobnet.core.detections import COLLISION, LARGEST, WALKING, FreeSwing
from mobnet.core.estimator import Estimate
from mobnet.core.recording_file import read_sensed
from mobnet.core.store import read_array
from mobnet.detection.calibration import CalibratedDetector, swing_ratios
from mobnet.detection.detector import ALARM_RATIO
from mobnet.detection.leg import unit_torques
from mobnet.detection.points import name_push
from mobnet.detection.watch import LegRecording, LegSetup


@dataclass(frozen=True)
class LegHits:
    """A leg in a recording with collisions.

    Attributes:
        leg: the leg.
        every: all pushes of the recording.
        hits: those of the leg.
        units: of each of them, what 1 N at each candidate does to the joints (hits, k, 6) [N m/N].
        truth: true external torque of the joints behind the observer's low-pass (T, 6) [N m].
    """

    leg: LegRecording
    every: tuple[Hit, ...]
    hits: tuple[Hit, ...]
    units: Array
    truth: Array


def candidates_of(setup: LegSetup, walk: Walk) -> list[str]:
    """Return the points of a leg that the pushes of a walk meet."""
    points = dict.fromkeys(push.point or "" for push in walk.pushes.values())
    return [point for point in points if point.startswith(f"{setup.side}_")]


def hit_legs(setup: LegSetup, walk: Walk, legs: Sequence[LegRecording]) -> list[LegHits]:
    """Return the leg in the recordings of a walk with collisions; none where it was not watched."""
    return [_hits(setup, walk, *pair) for pair in zip(legs, walk.residuals, strict=True)] if legs else []


def _hits(setup: LegSetup, walk: Walk, leg: LegRecording, residual: Path) -> LegHits:
    """Return the leg in a recording with collisions."""
    layout = setup.robot.layout
    every = hits_of(leg.recording, walk.pushes, layout)
    hits = tuple(hit for hit in every if hit.leg == setup.limb)
    points = candidates_of(setup, walk)
    # The pose of the first sample serves for the whole collision, in which a leg moves by a few degrees.
    positions = read_sensed(leg.recording, layout).sensed.q[[hit.rows.start for hit in hits]]
    units = [unit_torques(setup.robot, setup.gate.leg, q, points, setup.inward) for q in positions]
    # (D22): the observer delays what every method estimates, so the true torque of a perfect estimate passes it too.
    truth = read_array(residual, named(EXTERNAL_LP, setup.joints))[0].astype(np.float64)
    return LegHits(leg, tuple(every), hits, np.array(units), truth)


def collision_rows(setup: LegSetup, scenario: str, walk: Sequence[LegHits]) -> Iterator[Collision]:
    """Yield the collisions of a leg in the recordings of a scenario."""
    period = 1.0 / setup.rate_hz
    for recording in walk:
        for number, hit in enumerate(recording.hits, start=1):
            # The paper does not say when a collision begins. The first contact is the simulator's; a force above
            # onset_n is what an experimenter sees in the force sensor of the tool.
            start = hit.rows.start
            above = np.flatnonzero(hit.force > setup.detection.onset_n)
            yield Collision(
                scenario=scenario,
                seed=recording.leg.seed,
                number=number,
                push=hit.name,
                leg=hit.leg,
                link=hit.link,
                direction=hit.direction,
                start_s=start * period,
                onset_s=(start + int(above[0])) * period if len(above) else None,
                end_s=hit.rows.stop * period,
                force_n=float(hit.force.max()),
                impulse_ns=float(hit.force.sum()) * period,
                swing_share=float(recording.leg.gate.phase[start]),
            )


def detected_rows(
    setup: LegSetup,
    scenario: str,
    calibrated: CalibratedDetector,
    walk: Sequence[LegHits],
    estimates: Sequence[Estimate],
    points: Sequence[str],
) -> Iterator[Detected]:
    """Yield what a detector says of each collision of a leg, by each rule of thresholds."""
    for recording, estimate in zip(walk, estimates, strict=True):
        signals = calibrated.watched.of(estimate, recording.leg.command)
        low = setup.low_passed(estimate.tau_ext.astype(np.float64), recording.leg.segments)
        for kind, chain in calibrated.chains.items():
            alarm = recording.leg.run(chain, signals)
            perfect = calibrated.perfect(chain, recording.truth, recording.leg.command)
            ideal = recording.leg.run(*perfect).ratio if perfect else None
            for hit, units, number in zip(
                recording.hits, recording.units, range(1, len(recording.hits) + 1), strict=True
            ):
                row = first_alarm(setup, alarm.ratio, hit)
                best = None if ideal is None else first_alarm(setup, ideal, hit)
                signal = ""
                link = ""
                direction = ""
                force = None
                if row is not None:
                    # Links are told apart by the torque, also where the standard deviation raised the alarm.
                    isolated = name_push(low[row], units, calibrated.naming)
                    _, link, direction = points[isolated.candidate].split("_")
                    signal = calibrated.watched.names(setup.joints)[int(alarm.signal[row])]
                    force = isolated.force_n
                ratio = float(alarm.ratio[window_of(setup, hit)].max(initial=0.0))
                yield Detected(
                    scenario=scenario,
                    seed=recording.leg.seed,
                    leg=setup.limb,
                    number=number,
                    detector=calibrated.name,
                    kind=kind,
                    ratio=ratio,
                    delay_s=delay(setup, hit, row),
                    perfect_s=delay(setup, hit, best),
                    signal=signal,
                    link=link,
                    direction=direction,
                    named_n=force,
                )


def curve_rows(
    setup: LegSetup, calibrated: CalibratedDetector, walk: Sequence[LegHits], estimates: Sequence[Estimate]
) -> Iterator[CurvePoint]:
    """Yield how many collisions a detector finds, and how late, at multiples of its thresholds."""
    curve = setup.detection.curve
    chain = calibrated.chains[COLLISION]
    pairs: list[tuple[Array, Hit]] = []
    for recording, of_leg in zip(walk, estimates, strict=True):
        if recording.hits:
            ratio = recording.leg.run(chain, calibrated.watched.of(of_leg, recording.leg.command)).ratio
            pairs += [(ratio, hit) for hit in recording.hits]
    for factor in np.geomspace(*curve.factors, curve.count).tolist():
        # All thresholds times a factor divide the ratio by it, so that one run of the chain gives the whole curve.
        rows = [(hit, first_alarm(setup, ratio / factor, hit)) for ratio, hit in pairs]
        delays = [delay_s for hit, row in rows if (delay_s := delay(setup, hit, row)) is not None]
        yield CurvePoint(calibrated.name, setup.limb, factor, len(delays), len(pairs), float(sum(delays)))


def unpushed_rows(
    setup: LegSetup,
    scenario: str,
    calibrated: CalibratedDetector,
    walk: Sequence[LegHits],
    estimates: Sequence[Estimate],
) -> Iterator[FreeSwing]:
    """Yield the swings of a walk with collisions in which nothing pushes: most follow a push and recover from it."""
    for recording, estimate in zip(walk, estimates, strict=True):
        legs = [recording.leg]
        signals = [calibrated.watched.of(estimate, recording.leg.command)]
        ratios = [swing_ratios(legs, calibrated.chains[kind], signals) for kind in (COLLISION, LARGEST, WALKING)]
        for k, (start, end) in enumerate(recording.leg.swings):
            # A hit of the other leg shakes this one, so that it spoils the swing too.
            if not any(hit.rows.start < end and start < hit.rows.stop for hit in recording.every):
                place = (recording.leg.terrains[k], recording.leg.seed, k + 1)
                numbers = [float(values[k]) for values in ratios]
                yield FreeSwing(calibrated.name, setup.limb, scenario, UNPUSHED, *place, *numbers)


def window_of(setup: LegSetup, hit: Hit) -> slice:
    """Return the rows in which an alarm counts as that of a collision, (D21)."""
    # The filters still rise when a short contact has ended already.
    return slice(hit.rows.start, hit.rows.stop + round(setup.detection.late_s * setup.rate_hz))


def first_alarm(setup: LegSetup, ratio: Array, hit: Hit) -> int | None:
    """Return the row of the first alarm of a collision; None if there is none, or if it was raised before."""
    window = window_of(setup, hit)
    over = ratio[window] > ALARM_RATIO
    # (D21): an alarm that stands when the collision begins is a false one, and it would have a delay of zero.
    if not over.any() or (window.start and ratio[window.start - 1] > ALARM_RATIO):
        return None
    return window.start + int(np.argmax(over))


def delay(setup: LegSetup, hit: Hit, row: int | None) -> float | None:
    """Return the time from the beginning of a collision to an alarm [s]."""
    return None if row is None else (row - hit.rows.start) / setup.rate_hz
