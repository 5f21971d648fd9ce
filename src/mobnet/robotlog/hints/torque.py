"""Hints from the motion that torques should make: which single mistake explains the observer's own residual best.

A mistake is told if the change that would undo it takes most of the difference between needed and measured torque away
and leaves little of it.
"""

from collections.abc import Iterator
from itertools import chain
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.hints.changes import (
    Change,
    factor_of,
    feet_changes,
    motion_changes,
    torque_changes,
    zero_changes,
)
from mobnet.robotlog.hints.columns import listed
from mobnet.robotlog.hints.windows import Windows, share_of
from mobnet.settings.robotlog import RobotLog

MANY = 2  # joints up to which each of them must be explained
MOST = 8  # mistakes that are looked for, one after another
THIN = 5  # every so manieth window is looked at before a change of motion is tried on all of them
LOOSE = 1.5  # factor on what may be left in those


class Mistake(NamedTuple):
    """A mistake with the windows that undoing it makes, and the torques that their motion needs (W, nu) [N m]."""

    change: Change
    windows: Windows
    needed: Array


def torque_hints(
    nominal: NominalModel, windows: Windows, needed: Array, known: NDArray[np.bool_], bounds: RobotLog
) -> Iterator[str]:
    """Yield what looks wrong with torques, or with joints as a whole, of those that are known (nu,).

    `needed` are the torques that the motion needs (W, nu) [N m].
    """
    names, told = nominal.robot.layout.actuated, dict[str, list[str]]()
    for _ in range(MOST):
        found = _best(nominal, windows, needed, known, bounds)
        for change, after, wanted in found:
            joints = [names[k] for k in change.joints]
            few = " and ".join(joints) if len(joints) <= MANY else listed(joints)
            told.setdefault(change.text, []).append(few)
            # Changes of torques alone, of which there may be several, are undone one after another.
            windows, needed = (change.apply(windows), needed) if wanted is needed else (after, wanted)
        if not found:
            break
    for text, joints in told.items():
        yield f"{', '.join(joints)}: {text}"


def _best(
    nominal: NominalModel, windows: Windows, needed: Array, known: NDArray[np.bool_], bounds: RobotLog
) -> list[Mistake]:
    """Return the mistake that explains most; where many joints are wrong, the factors of all their torques at once."""
    wrong = share_of(needed, windows.torque)
    worst = np.argsort(np.where(known, -wrong, np.inf))
    suspects = [k for k in worst.tolist() if known[k] and wrong[k] > bounds.suspect]
    factors = [change for k in suspects if (change := factor_of(needed, windows, k, bounds))]
    alone = [Mistake(change, change.apply(windows), needed) for change in factors]
    if len(alone) > bounds.few:
        return alone
    few = sorted(suspects[: bounds.few])
    torques = torque_changes(nominal, needed, windows, sorted(suspects), few, bounds)
    alone += [Mistake(change, change.apply(windows), needed) for change in torques]
    best, least = [], float(wrong[known].clip(max=1.0).sum())
    for mistake in chain(alone, _of_motion(nominal, windows, suspects, few, wrong, bounds)):
        left = share_of(mistake.needed, mistake.windows.torque)
        total = float(left[known].clip(max=1.0).sum())
        if _clears(mistake.change, left, wrong, bounds) and total < least:
            best, least = [mistake], total
    return best


def _of_motion(
    nominal: NominalModel, windows: Windows, suspects: list[int], few: list[int], wrong: Array, bounds: RobotLog
) -> Iterator[Mistake]:
    """Yield changes of motion and feet that clear a few of the windows: asking the model costs most of the time."""
    thin = windows.thinned(THIN)
    changes = (
        feet_changes(nominal, windows, suspects),
        zero_changes(nominal, thin, few, bounds),
        motion_changes(nominal, few),
    )
    for move, torques in chain(*changes):
        moved = move(thin)
        needed = moved.needed(nominal)
        left = (share_of(needed, change.apply(moved).torque) / LOOSE for change in torques)
        kept = [change for change, share in zip(torques, left, strict=True) if _clears(change, share, wrong, bounds)]
        if kept:
            whole = move(windows)
            needed = whole.needed(nominal)
            yield from (Mistake(change, change.apply(whole), needed) for change in kept)


def _clears(change: Change, left: Array, wrong: Array, bounds: RobotLog) -> bool:
    """Return whether a change takes most of the error of its joints away, and leaves little; shares (nu,).

    Of many joints the mean counts, as friction may be the larger part of the torque of some.
    """
    own = list(change.joints)
    before, after = (share[own] if len(own) <= MANY else share[own].mean() for share in (wrong, left))
    most = np.minimum(bounds.good, (1 - bounds.explained) * before)
    return bool((after < most).all())
