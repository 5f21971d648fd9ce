"""What explains the residual of a log in which nothing looks wrong: friction, a torque constant, a mass."""

from collections.abc import Iterator, Sequence

import numpy as np

from mobnet.core.arrays import Array
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.hints.changes import LEAST_CONSTANT, Change, Seen, constant_changes
from mobnet.robotlog.hints.fits import friction_fit, quotient
from mobnet.robotlog.hints.payload import payloads
from mobnet.robotlog.hints.torque import for_small_mistakes, score_of, seen_in
from mobnet.robotlog.hints.windows import MotionWindows, left_of, size_of
from mobnet.settings.robotlog import RobotLog

HALF = 0.5  # share of a residual that must be explained for a word
TINY_SHARE = 1e-9  # of a torque, below which shares are alike
MASS_NUMBERS = 4  # a mass and its place


def explanation(
    nominal: NominalModel, windows: MotionWindows, bounds: RobotLog, with_friction: bool = True
) -> Iterator[str]:
    """Yield what friction explains of the residual of each joint that tells of itself, if wanted, and what else does.

    That is a torque constant of single joints, or a mass that several carry, whichever leaves less; a constant is one
    number, and a mass four.
    """
    seen = seen_in(nominal, windows, windows.asked(nominal), for_small_mistakes(bounds))
    if not seen.known:
        return
    if with_friction:
        yield from _frictions(seen, bounds.floor)
    constants = list(constant_changes(seen, LEAST_CONSTANT))
    masses = list(_masses(seen))
    by_constants = _score_of_constants(seen, constants)
    by_masses = min((score for _, score in masses), default=np.inf)
    if constants and by_constants <= by_masses:
        names = nominal.robot.layout.actuated
        yield from (f"{names[change.joints[0]]}: {change.text}; or masses of the table" for change in constants)
        return
    yield from (text for text, _ in masses)


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


def _score_of_constants(seen: Seen, constants: Sequence[Change]) -> float:
    """Return what is left with constants of single joints undone, as a score."""
    windows = seen.windows
    for change in constants:
        windows = change.apply(windows)
    left = left_of(seen.asked, windows.torque, seen.nominal, seen.bounds, range(len(seen.left)))
    return score_of(left, seen) + seen.bounds.number * len(constants)


def _masses(seen: Seen) -> Iterator[tuple[str, float]]:
    """Yield masses at the ends of limbs that explain most of what friction leaves, in words, each with a score."""
    known = list(seen.known)
    for mass in payloads(seen.nominal, seen.windows, seen.asked, seen.left, known):
        asked = seen.asked._replace(needed=seen.asked.needed + mass.torque)
        after = left_of(asked, seen.windows.torque, seen.nominal, seen.bounds, range(len(seen.left)))
        ratio = _mean_ratio(after[known], seen.left[known])
        if ratio < HALF and np.mean(after[known] < seen.left[known]) > HALF:
            text = f"{mass.text()}, would leave {ratio:.0%} of what is left: a tool, or masses of the table"
            yield text, score_of(after, seen) + seen.bounds.number * MASS_NUMBERS


def _mean_ratio(after: Array, before: Array) -> float:
    """Return the geometric mean of what is left of shares (n,)."""
    return float(np.exp(np.log(np.maximum(after, TINY_SHARE) / np.maximum(before, TINY_SHARE)).mean()))
