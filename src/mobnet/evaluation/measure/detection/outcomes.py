"""What detectors find of collisions: which, how late, which link they name; and swings between collisions."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL_LP, named
from mobnet.core.detections import COLLISION, LARGEST, UNPUSHED, Collision, CurvePoint, Detected, FreeSwing
from mobnet.core.estimator import Estimate
from mobnet.core.store import read_array
from mobnet.detection.detector import COLLISION as OVER
from mobnet.detection.isolation import name_push
from mobnet.detection.leg import unit_torques
from mobnet.evaluation.measure.detection.collisions import Hit, hits_of
from mobnet.evaluation.measure.detection.tuning import Tuned, swing_ratios
from mobnet.evaluation.measure.detection.watching import Leg, Watched, read_positions
from mobnet.plan.detection import Walk


@dataclass(frozen=True)
class Struck:
    """A leg in a recording with collisions.

    Attributes:
        watched: the leg.
        every: all pushes of the recording.
        hits: those of the leg.
        units: of each of them, what 1 N at each candidate does to the joints (hits, k, 6) [N m/N].
        truth: true external torque of the joints behind the observer's low-pass (T, 6) [N m].
    """

    watched: Watched
    every: tuple[Hit, ...]
    hits: tuple[Hit, ...]
    units: Array
    truth: Array


def candidates_of(leg: Leg, walk: Walk) -> list[str]:
    """Return the points of a leg that the pushes of a walk meet."""
    points = dict.fromkeys(push.point or "" for push in walk.pushes.values())
    side = next(side for side, limb in leg.robot.layout.legs.items() if limb == leg.limb)
    return [point for point in points if point.startswith(f"{side}_")]


def strike(leg: Leg, walk: Walk, watched: Sequence[Watched]) -> list[Struck]:
    """Return the leg in the recordings of a walk with collisions; none where it was not watched."""
    if not watched:
        return []
    return [_strike(leg, walk, *pair) for pair in zip(watched, walk.residuals, strict=True)]


def _strike(leg: Leg, walk: Walk, watched: Watched, residual: Path) -> Struck:
    """Return the leg in a recording with collisions."""
    layout = leg.robot.layout
    every = hits_of(watched.recording, walk.pushes, layout)
    hits, points = tuple(hit for hit in every if hit.leg == leg.limb), candidates_of(leg, walk)
    positions = read_positions(watched.recording, layout, [hit.rows.start for hit in hits])
    units = [unit_torques(leg.robot, leg.gate.leg, q, points, leg.inward) for q in positions]
    truth = read_array(residual, named(EXTERNAL_LP, leg.joints))[0].astype(np.float64)
    return Struck(watched, tuple(every), hits, np.array(units), truth)


def collision_rows(leg: Leg, scenario: str, struck: Sequence[Struck]) -> Iterator[Collision]:
    """Yield the collisions of a leg in the recordings of a scenario."""
    period = 1.0 / leg.rate_hz
    for one in struck:
        for number, hit in enumerate(one.hits, start=1):
            start, above = hit.rows.start, np.flatnonzero(hit.force > leg.detection.onset_n)
            yield Collision(
                scenario, one.watched.seed, number, hit.name, hit.leg, hit.link, hit.direction, start * period,
                (start + int(above[0])) * period if len(above) else None, hit.rows.stop * period,
                float(hit.force.max()), float(hit.force.sum()) * period, float(one.watched.watch.phase[start]),
            )  # fmt: skip


def detected_rows(
    leg: Leg, scenario: str, tuned: Tuned, struck: Sequence[Struck], estimates: Sequence[Estimate],
    points: Sequence[str],
) -> Iterator[Detected]:  # fmt: skip
    """Yield what a detector says of each collision of a leg, by each rule of thresholds."""
    for one, estimate in zip(struck, estimates, strict=True):
        signals, low = (
            tuned.signals(estimate),
            leg.low_passed(estimate.tau_ext.astype(np.float64), one.watched.segments),
        )
        for kind, chain in tuned.chains.items():
            alarm, perfect = one.watched.run(chain, signals), tuned.perfect(chain)
            ideal = one.watched.run(perfect, tuned.whitened(one.truth)).ratio if perfect else None
            for number, hit in enumerate(one.hits, start=1):
                row, best = first_alarm(leg, alarm.ratio, hit), None if ideal is None else first_alarm(leg, ideal, hit)
                signal, link, direction, force = "", "", "", None
                if row is not None:
                    named_push = name_push(low[row], one.units[number - 1], tuned.naming)
                    _, link, direction = points[named_push.candidate].split("_")
                    signal, force = tuned.names(leg.joints)[int(alarm.signal[row])], named_push.force_n
                ratio = float(alarm.ratio[window_of(leg, hit)].max(initial=0.0))
                yield Detected(
                    scenario, one.watched.seed, leg.limb, number, tuned.name, kind, ratio, delay(leg, hit, row),
                    delay(leg, hit, best), signal, link, direction, force,
                )  # fmt: skip


def curve_rows(
    leg: Leg, tuned: Tuned, struck: Sequence[Struck], estimates: Sequence[Estimate]
) -> Iterator[CurvePoint]:  # fmt: skip
    """Yield how many collisions a detector finds, and how late, at multiples of its thresholds."""
    curve, chain = leg.detection.curve, tuned.chains[COLLISION]
    pairs = [(one.watched.run(chain, tuned.signals(own)).ratio, hit)
             for one, own in zip(struck, estimates, strict=True) for hit in one.hits]  # fmt: skip
    for factor in np.geomspace(*curve.factors, curve.count).tolist():
        rows = [(hit, first_alarm(leg, ratio / factor, hit)) for ratio, hit in pairs]
        delays = [found for hit, row in rows if (found := delay(leg, hit, row)) is not None]
        yield CurvePoint(tuned.name, leg.limb, factor, len(delays), len(pairs), float(sum(delays)))


def unpushed_rows(
    leg: Leg, scenario: str, tuned: Tuned, struck: Sequence[Struck], estimates: Sequence[Estimate]
) -> Iterator[FreeSwing]:  # fmt: skip
    """Yield the swings of a walk with collisions in which nothing pushes: most follow a push and recover from it."""
    for one, estimate in zip(struck, estimates, strict=True):
        signals, watched = [tuned.signals(estimate)], [one.watched]
        ratios, others = (swing_ratios(watched, tuned.chains[kind], signals) for kind in (COLLISION, LARGEST))
        for k, (start, end) in enumerate(one.watched.swings):
            if not any(hit.rows.start < end and start < hit.rows.stop for hit in one.every):
                numbers = float(ratios[k]), float(others[k])
                place = one.watched.terrains[k], one.watched.seed, k + 1
                yield FreeSwing(tuned.name, leg.limb, scenario, UNPUSHED, *place, *numbers)


def window_of(leg: Leg, hit: Hit) -> slice:
    """Return the rows in which an alarm counts as that of a collision."""
    return slice(hit.rows.start, hit.rows.stop + round(leg.detection.late_s * leg.rate_hz))


def first_alarm(leg: Leg, ratio: Array, hit: Hit) -> int | None:
    """Return the row of the first alarm of a collision; None if there is none, or if it was raised before."""
    window = window_of(leg, hit)
    over = ratio[window] > OVER
    if not over.any() or (window.start and ratio[window.start - 1] > OVER):
        return None
    return window.start + int(np.argmax(over))


def delay(leg: Leg, hit: Hit, row: int | None) -> float | None:
    """Return the time from the beginning of a collision to an alarm [s]."""
    return None if row is None else (row - hit.rows.start) / leg.rate_hz
