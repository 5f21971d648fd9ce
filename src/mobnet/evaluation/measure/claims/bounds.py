"""The bounds of a claim, which follow from the number that the paper prints by one rule of each kind.

The rules are those that the header of configs/claims.yaml states. A claim's `bar` narrows the range in which it is
reproduced, its `side` that of its direction; with the rule `sign` they are these ranges.
"""

from dataclasses import dataclass

from mobnet.settings.claims import Bounds, Claim

ANY: Bounds = (None, None)
TWICE, FIVE_TIMES = 2.0, 5.0
LEAST_ALIKE, ALIKE, RATHER_ALIKE = 1.1, 1.5, 2.0
LEAST_SHARE, MOST_SHARE = 0.5, 1.5  # of an effect


@dataclass(frozen=True)
class Ranges:
    """Closed ranges of a number [its unit]: where it is reproduced, and where it agrees in direction."""

    reproduced: Bounds
    side: Bounds


def ranges_of(claim: Claim) -> Ranges:
    """Return the ranges of a claim [its unit]."""
    bar, side = claim.bar or ANY, claim.side or ANY
    if claim.rule == "sign":
        return Ranges(bar, side if claim.side else bar)
    reproduced, wider = _ruled(claim)
    wider = common(wider, side)
    return Ranges(common(common(reproduced, bar), wider), wider)


def _ruled(claim: Claim) -> tuple[Bounds, Bounds]:
    """Return the ranges that a claim's rule makes of the number that the paper prints [its unit]."""
    if claim.rule == "similar":
        alike = _alike(claim.published)
        return (1.0 / alike, alike), (1.0 / RATHER_ALIKE, RATHER_ALIKE)
    x = claim.published or 0.0
    if claim.rule == "about":
        factor = ALIKE if claim.quantity == "ratio" else TWICE
        return (x / factor, x * factor), (x / FIVE_TIMES, x * FIVE_TIMES)
    if claim.rule == "little":
        return (x / TWICE, x * TWICE), (None, x * FIVE_TIMES)
    return _effect(claim.quantity, x)


def _alike(x: float | None) -> float:
    """Return the factor around 1 within which a ratio counts as alike [-]: twice as far from 1 as x, on a log scale."""
    return ALIKE if x is None else min(max(x**2, x**-2, LEAST_ALIKE), ALIKE)


def _effect(quantity: str, x: float) -> tuple[Bounds, Bounds]:
    """Return from half an effect to one and a half of it, and any effect of that sign.

    Of ratios, and of what a cut leaves, this is on a log scale, and not beyond half or twice of the ratio itself.
    """
    if quantity == "cut":
        low, high = _ratio_effect(1.0 - x)
        return (1.0 - high, 1.0 - low), (0.0, 1.0)
    if quantity in ("ratio", "least ratio"):
        return _ratio_effect(x), (1.0, None) if x >= 1.0 else (None, 1.0)
    return (LEAST_SHARE * x, MOST_SHARE * x), (0.0, None)


def _ratio_effect(x: float) -> tuple[float, float]:
    """Return from half the effect of a ratio x to one and a half of it, at most a factor of two from x [-]."""
    low, high = sorted((x**LEAST_SHARE, x**MOST_SHARE))
    return max(low, x / TWICE), min(high, x * TWICE)


def common(one: Bounds, other: Bounds) -> Bounds:
    """Return the range that two closed ranges have in common [their unit]; None is no bound."""
    lows, highs = ([end for end in ends if end is not None] for ends in zip(one, other, strict=True))
    return max(lows, default=None), min(highs, default=None)


def within(inner: tuple[float, float], outer: Bounds) -> bool:
    """Return whether an interval lies in a closed range of its unit; None is no bound."""
    low, high = outer
    return (low is None or inner[0] >= low) and (high is None or inner[1] <= high)


def apart(interval: tuple[float, float], bounds: Bounds) -> bool:
    """Return whether an interval and a closed range of its unit have no number in common; None is no bound."""
    low, high = bounds
    return (low is not None and interval[1] < low) or (high is not None and interval[0] > high)


def range_text(bounds: Bounds) -> str:
    """Return a range as text, with three digits."""
    low, high = bounds
    if low is None:
        return "any" if high is None else f"at most {high:.3g}"
    return f"at least {low:.3g}" if high is None else f"{low:.3g} to {high:.3g}"
