"""What explains the residual of a log in which nothing looks wrong: friction, and what else explains the rest of it."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from mobnet.core.arrays import Array
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.hints.bounds import HintBounds
from mobnet.robotlog.hints.changes import LEAST_CONSTANT, Seen, constant_changes
from mobnet.robotlog.hints.fits import friction_fit, quotient
from mobnet.robotlog.hints.mounting import mounting_of
from mobnet.robotlog.hints.payload import payloads
from mobnet.robotlog.hints.torque import for_small_mistakes, score_of, seen_in
from mobnet.robotlog.hints.windows import MotionWindows, left_of, size_of

HALF = 0.5  # share of a residual that must be explained for a word
TINY_SHARE = 1e-9  # of a torque, below which shares are alike
MASS_NUMBERS = 4  # a mass and its place
MOUNTING_NUMBERS = 2  # a direction


class Explained(NamedTuple):
    """What explains a residual, a line for each joint or limb, and its score: the less the better."""

    lines: tuple[str, ...]
    score: float


def explanation(
    nominal: NominalModel, windows: MotionWindows, bounds: HintBounds, with_friction: bool = True
) -> Iterator[str]:
    """Yield what friction explains of the residual of each joint that tells of itself, if wanted, and what else does.

    That is a torque constant of single joints, masses at the ends of limbs, or another side of gravity, whichever
    leaves least; each number that is chosen for it counts against it.
    """
    seen = seen_in(nominal, windows, windows.asked(nominal), for_small_mistakes(bounds))
    if not seen.known:
        return
    if with_friction:
        yield from _frictions(seen, bounds.floor)
    explanations = [*_constants(seen), *_masses(seen), *_mounting(seen)]
    if explanations:
        yield from min(explanations, key=lambda explained: explained.score).lines


def _frictions(seen: Seen, floor: float) -> Iterator[str]:
    """Yield friction, rotor inertia and offset of each joint of whose residual they explain most.

    A joint that leaves less than a share of its torque has no line.
    """
    windows = seen.windows
    asked = seen.asked
    robot = seen.nominal.robot
    plain = np.square(quotient(size_of(windows.torque - asked.needed), size_of(windows.torque)))
    for k in seen.known:
        explained = 1 - seen.left[k] / plain[k]
        if plain[k] < floor or explained < HALF:
            continue
        most = seen.offset(k)
        numbers, offset = friction_fit(asked.terms[:, k], (windows.torque - asked.needed)[:, [k]], most)
        dry, viscous, rotor = numbers[:, 0] + 0.0  # no minus before zero
        yield (
            f"{robot.layout.actuated[k]}: friction of {dry:.3g} N m and {viscous:.3g} N m s/rad, "
            f"rotor inertia of {rotor:.3g} kg m^2, offset of {_in_words(offset.item(), float(most))} N m "
            f"explain {explained:.0%} of its square"
        )


def _in_words(offset: float, most: float) -> str:
    """Return an offset [N m] in words; one at the bound of its fit may be larger."""
    size = f"{offset:.2g}"
    if abs(offset) < most:
        return size
    return f"at least {size}" if offset > 0.0 else f"{size} or less"


def _constants(seen: Seen) -> Iterator[Explained]:
    """Yield torque constants of single joints that explain most of what friction leaves, all of them together."""
    changes = list(constant_changes(seen, LEAST_CONSTANT))
    if not changes:
        return
    windows = seen.windows
    for change in changes:
        windows = change.apply(windows)
    left = left_of(seen.asked, windows.torque, seen.nominal, seen.bounds, range(len(seen.left)))
    names = seen.nominal.robot.layout.actuated
    lines = tuple(f"{names[change.joints[0]]}: {change.text}; or masses of the table" for change in changes)
    yield Explained(lines, score_of(left, seen) + seen.bounds.number * len(changes))


def _masses(seen: Seen) -> Iterator[Explained]:
    """Yield masses at the ends of limbs that explain most of what friction leaves, all of them together."""
    lines = list[str]()
    scores = list[float]()
    for mass in payloads(seen.nominal, seen.windows, seen.asked, seen.left, seen.known):
        after = _left_with(seen, mass.torque)
        if (ratio := _ratio_that_counts(after, seen)) is not None:
            lines.append(f"{mass.text()}, would leave {ratio:.0%} of what is left: a tool, or masses of the table")
            scores.append(score_of(after, seen) + seen.bounds.number * MASS_NUMBERS)
    if lines:
        yield Explained(tuple(lines), min(scores))


def _mounting(seen: Seen) -> Iterator[Explained]:
    """Yield another side of gravity, if it explains most of what friction leaves."""
    mounting = mounting_of(seen.nominal, seen.windows, seen.asked, seen.left, seen.known)
    if mounting:
        after = _left_with(seen, mounting.torque)
        if (ratio := _ratio_that_counts(after, seen)) is not None:
            line = f"{mounting.text(seen.nominal)}; it would leave {ratio:.0%} of what is left"
            yield Explained((line,), score_of(after, seen) + seen.bounds.number * MOUNTING_NUMBERS)


def _left_with(seen: Seen, torque: Array) -> Array:
    """Return the shares that joints leave if their motion needs a torque (W, nu) [N m] more (nu,)."""
    asked = seen.asked._replace(needed=seen.asked.needed + torque)
    return left_of(asked, seen.windows.torque, seen.nominal, seen.bounds, range(len(seen.left)))


def _ratio_that_counts(after: Array, seen: Seen) -> float | None:
    """Return which mean share of what is left stays with shares (nu,), None where it is not small for most joints."""
    known = list(seen.known)
    ratio = _mean_ratio(after[known], seen.left[known])
    is_better = np.mean(after[known] < seen.left[known]) > HALF
    return ratio if ratio < HALF and is_better else None


def _mean_ratio(after: Array, before: Array) -> float:
    """Return the geometric mean of what is left of shares (n,)."""
    return float(np.exp(np.log(np.maximum(after, TINY_SHARE) / np.maximum(before, TINY_SHARE)).mean()))
