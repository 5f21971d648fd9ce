"""Hints from the motion that torques should make: which single mistake explains the observer's own residual best.

Every change that would undo a mistake is held against all others by what it leaves unexplained, joint by joint, with
friction and rotor inertia fitted beside each of them, and the one that leaves least is told. Each number that is chosen
for a change counts against it, so that the more general of two does not win by itself. A change that leaves hardly more
than the best one is told beside it.
"""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import chain
from typing import NamedTuple

import numpy as np

from mobnet.core.arrays import Array
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.hints.bounds import HintBounds
from mobnet.robotlog.hints.changes import (
    SURE_CONSTANT,
    Change,
    Seen,
    constant_changes,
    factor_changes,
    feet_changes,
    gravity_changes,
    motion_changes,
    mounting_changes,
    offset_changes,
    order_changes,
    payload_changes,
    sign_changes,
    zero_changes,
)
from mobnet.robotlog.hints.columns import listed
from mobnet.robotlog.hints.windows import MotionWindows, MotorDemand, known_joints, left_of

MANY = 2  # joints up to which each of them must be explained
MOST = 8  # mistakes that are looked for, one after another
THIN = 5  # every n-th window is looked at before a change of motion is tried on all of them
LOOSE = 1.5  # factor on what may be left in those


class Mistake(NamedTuple):
    """A mistake with the windows that undoing it makes, what they ask for, and a score: the less the better."""

    change: Change
    windows: MotionWindows
    asked: MotorDemand
    score: float


def torque_hints(nominal: NominalModel, windows: MotionWindows, bounds: HintBounds) -> Iterator[str]:
    """Yield what looks wrong with torques, or with joints as a whole, of those that tell of themselves."""
    asked = windows.asked(nominal)
    small = for_small_mistakes(bounds)
    names_by_text = dict[str, list[str]]()
    for _ in range(MOST):
        mistake = _best(seen_in(nominal, windows, asked, bounds))
        if not mistake:
            # No mass and no friction looks like gravity from another side, so that little of it is told, too.
            barely = seen_in(nominal, windows, asked, small)
            mistake = list(_of_torque(barely, mounting_changes(barely)))
        if not mistake:
            break
        # A mistake is undone before the next one is looked for (docs/notes/robot_logs.md).
        best, *others = mistake
        windows = best.windows
        asked = best.asked
        meant = "".join(f"; or {_named(other.change, nominal)}: {other.change.text}" for other in others)
        names_by_text.setdefault(best.change.text + meant, []).append(_named(best.change, nominal))
    for text, joints in names_by_text.items():
        yield f"{', '.join(joints)}: {text}"


def for_small_mistakes(bounds: HintBounds) -> HintBounds:
    """Return the bounds with which mistakes are looked for that leave most of the torque explained."""
    return replace(bounds, suspect=bounds.small, floor=bounds.small)


def seen_in(nominal: NominalModel, windows: MotionWindows, asked: MotorDemand, bounds: HintBounds) -> Seen:
    """Return windows with what is not explained in them."""
    known = np.flatnonzero(known_joints(nominal, windows, asked, bounds)).tolist()
    left = left_of(asked, windows.torque, nominal, bounds, range(windows.torque.shape[1]))
    suspects = [k for k in np.argsort(-left).tolist() if k in known and left[k] > bounds.suspect]
    few = sorted(suspects[: bounds.few])
    return Seen(nominal, bounds, windows, asked, left, tuple(known), tuple(suspects), tuple(few))


def _named(change: Change, nominal: NominalModel) -> str:
    """Return the names of the joints of a change."""
    joints = [nominal.robot.layout.actuated[k] for k in change.joints]
    return " and ".join(joints) if len(joints) <= MANY else listed(joints)


def _best(seen: Seen) -> list[Mistake]:
    """Return the mistake that explains most, and one that explains hardly less; none where nothing is wrong."""
    if not seen.suspects:
        return []
    of_torque = chain(
        sign_changes(seen),
        factor_changes(seen),
        constant_changes(seen, SURE_CONSTANT),
        order_changes(seen),
        offset_changes(seen),
        gravity_changes(seen),
        mounting_changes(seen),
        payload_changes(seen),
    )
    mistakes = sorted(chain(_of_torque(seen, of_torque), _of_motion(seen)), key=lambda mistake: mistake.score)
    return [other for other in mistakes if other.score < mistakes[0].score + seen.bounds.close][:2]


def _of_torque(seen: Seen, changes: Iterable[Change]) -> Iterator[Mistake]:
    """Yield changes of torques alone that clear their joints."""
    for change in changes:
        windows = change.apply(seen.windows)
        asked = seen.asked._replace(needed=seen.asked.needed - (windows.beside - seen.windows.beside))
        yield from _cleared(change, windows, asked, seen)


def _of_motion(seen: Seen) -> Iterator[Mistake]:
    """Yield changes of motion and feet that clear a few of the windows: asking the model costs most of the time."""
    nominal = seen.nominal
    bounds = seen.bounds
    thin = seen.windows.thinned(THIN)
    for move, changes in chain(feet_changes(seen), zero_changes(seen, thin), motion_changes(seen)):
        moved = move(thin)
        asked = moved.asked(nominal)
        kept = []
        for change in changes:
            joints = list(change.joints)
            left = left_of(asked, change.apply(moved).torque, nominal, bounds, joints) / LOOSE
            if _clears(left, seen.left[joints], bounds):
                kept.append(change)
        if kept:
            whole = move(seen.windows)
            asked = whole.asked(nominal)
            for change in kept:
                yield from _cleared(change, change.apply(whole), asked, seen)


def _cleared(change: Change, windows: MotionWindows, asked: MotorDemand, seen: Seen) -> Iterator[Mistake]:
    """Yield a change with its score, if it clears its joints and is better than none."""
    joints = list(change.joints)
    left = left_of(asked, windows.torque, seen.nominal, seen.bounds, range(len(seen.left)))
    score = score_of(left, seen) + seen.bounds.number * change.numbers
    if _clears(left[joints], seen.left[joints], seen.bounds) and score < score_of(seen.left, seen):
        yield Mistake(change, windows, asked, score)


def score_of(left: Array, seen: Seen) -> float:
    """Return the sum of the logarithms of what the known joints leave, of which the smallest shares count alike."""
    return float(np.log(np.maximum(left[list(seen.known)], seen.bounds.floor)).sum())


def _clears(left: Array, before: Array, bounds: HintBounds) -> bool:
    """Return whether a change takes most of the error of its joints away, and leaves little; shares (n,).

    Of many joints the mean counts, as friction may be the larger part of the torque of some.
    """
    if len(left) > MANY:
        left = left.mean(keepdims=True)
        before = before.mean(keepdims=True)
    return bool(len(left) and (left < np.minimum(bounds.good, (1 - bounds.explained) * before)).all())
