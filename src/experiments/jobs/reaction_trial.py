"""A walk and what came of it: contact, alarm, reaction, force, fall, and how well the base's velocity was known."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from experiments.records.reactions import NONE, Trial
from mobnet.core.arrays import Array
from mobnet.reaction.loop import Course
from mobnet.settings.reaction import Reaction, Watch


def contacts_of(force: NDArray[np.float32], touch_n: float, gap: int) -> list[slice]:
    """Return the contacts in forces (T, 3) [N]: samples above touch_n [N], apart by at least so many below it."""
    touching = np.flatnonzero(np.linalg.norm(force, axis=1) > touch_n)
    if not len(touching):
        return []
    parts = np.split(touching, np.flatnonzero(np.diff(touching) > gap) + 1)
    return [slice(int(part[0]), int(part[-1]) + 1) for part in parts]


def trial_of(
    numbers: Reaction,
    place: tuple[str, str, int],
    watch: Watch,
    course: Course,
    begin: int,
    rate_hz: float,
    stopped: bool,
    mid_swing: NDArray[np.bool_] | None = None,
) -> Trial:
    """Return what came of a walk of a case with a robot and a seed; nothing is an alarm before sample `begin`.

    `mid_swing` (T,) says where the leg in front of the obstacle is in the middle of a swing; None where there is none.
    """
    contacts = contacts_of(course.force, numbers.touch_n, round(numbers.gap_s * rate_hz))
    first = contacts[0] if contacts else None
    size = np.linalg.norm(course.force, axis=1)
    reacted_at, reacted = course.reacted or (None, None)
    ends = [at for at in (reacted_at, first.start if first else None) if at is not None]
    until_end = slice(begin, min(ends, default=len(course.rows)))
    walked = course.error[until_end]
    alarm = None if reacted_at is None else reacted_at - round(watch.wait_s * rate_hz)
    angle = base_angle = None
    if first is not None and reacted is not None and reacted_at is not None and reacted_at >= first.start:
        pushed = course.force[first.start : reacted_at + 1, :2].sum(axis=0)
        angle = angle_deg(reacted.direction, pushed)
        base_angle = angle_deg(reacted.wrench[:2], pushed)
    return Trial(
        *place,
        watch.detector,
        watch.rule if watch.detector != NONE else "",
        watch.wait_s,
        wrench=watch.wrench or "",
        walked_s=len(walked) / rate_hz,
        feed_forward=watch.feed_forward,
        velocity_rmse_m_s=float(np.sqrt(np.square(walked).sum(axis=1).mean())) if len(walked) else 0.0,
        tracking_rmse_rad=rms(course.tracking[until_end]),
        power_w=float(course.power[until_end].mean()) if len(walked) else 0.0,
        contact_s=None if first is None else first.start / rate_hz,
        in_swing=None if first is None or mid_swing is None else int(mid_swing[first.start]),
        alarm_s=None if alarm is None else alarm / rate_hz,
        limb="" if reacted is None else reacted.limb,
        reacted_s=None if reacted_at is None else reacted_at / rate_hz,
        angle_deg=angle,
        base_angle_deg=base_angle,
        first_peak_n=None if first is None else float(size[first].max()),
        first_impulse_ns=None if first is None else impulse_ns(course.force, [first], rate_hz),
        peak_n=None if first is None else float(size.max()),
        impulse_ns=None if first is None else impulse_ns(course.force, contacts, rate_hz),
        contacts=len(contacts),
        fell_s=len(course.rows) / rate_hz if course.fallen else None,
        stopped=int(stopped and not course.fallen),
    )


def rms(errors: NDArray[np.float32]) -> float:
    """Return the root of the mean square of those errors that are numbers; zero where none is."""
    known = errors[np.isfinite(errors)].astype(np.float64)
    return float(np.sqrt(np.square(known).mean())) if known.size else 0.0


def impulse_ns(force: NDArray[np.float32], contacts: Sequence[slice], rate_hz: float) -> float:
    """Return the impulse of some contacts [N s]: of each one the length of its vector, all added up."""
    return sum(float(np.linalg.norm(force[contact].astype(np.float64).sum(axis=0))) for contact in contacts) / rate_hz


def angle_deg(direction: Array, force: NDArray[np.float32]) -> float:
    """Return the angle between a horizontal direction (2,) and a force (2,) [N] in degrees."""
    turn = np.arctan2(force[1], force[0]) - np.arctan2(direction[1], direction[0])
    return float(np.degrees(abs((turn + np.pi) % (2.0 * np.pi) - np.pi)))
