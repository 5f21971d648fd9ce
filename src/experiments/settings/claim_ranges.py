"""The bounds of a claim, which follow from the number that the paper prints by one rule of each kind.

The rules are those that the header of configs/claims.yaml states. A claim's `bar` narrows the range of its size, its
`sign` replaces that of its sign.
"""

from dataclasses import dataclass

from experiments.intervals.bounds import ANY, Bounds, common
from experiments.settings.claims import Claim

TWICE = 2.0
KNOWN = 1.25
LEAST_ALIKE = 1.1
ALIKE = 1.5
LEAST_EFFECT, MOST_EFFECT = 0.5, 1.5  # shares of an effect
FIFTH = 0.2  # of all collisions


@dataclass(frozen=True)
class Ranges:
    """Closed ranges of a number [its unit]: of the size and of the sign that are claimed; None where one is not."""

    size: Bounds | None
    sign: Bounds | None


def shown_range(ranges: Ranges) -> Bounds:
    """Return the range that pictures and tables show: that of the size, or else that of the sign."""
    return ranges.size or ranges.sign or ANY


def ranges_of(claim: Claim) -> Ranges:
    """Return the ranges of a claim [its unit]."""
    if claim.rule == "sign":
        return Ranges(None, claim.sign)
    if claim.rule == "bar":
        return Ranges(claim.bar, claim.sign)
    size, sign = _ruled(claim)
    return Ranges(common(size, claim.bar or ANY), claim.sign or sign)


def _ruled(claim: Claim) -> tuple[Bounds, Bounds | None]:
    """Return the ranges of size and sign that a claim's rule makes of the number that the paper prints [its unit]."""
    if claim.rule == "similar":
        alike = _alike(claim.published)
        return (1.0 / alike, alike), None
    x = claim.published or 0.0
    if claim.rule == "about":
        factor = ALIKE if claim.quantity == "ratio" else TWICE
        return (x / factor, x * factor), None
    if claim.rule == "known":
        return (x / KNOWN, x * KNOWN), None
    if claim.rule == "at most":
        return (None, x * TWICE), None
    if claim.rule == "share":
        return (max(x - FIFTH, 0.0), min(x + FIFTH, 1.0)), None
    if claim.rule == "little":
        return (x / TWICE, x * TWICE), (0.0, None)
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
        return (1.0 - high, 1.0 - low), (0.0, None)
    if quantity in ("ratio", "least ratio"):
        return _ratio_effect(x), (1.0, None) if x >= 1.0 else (None, 1.0)
    return (LEAST_EFFECT * x, MOST_EFFECT * x), (0.0, None)


def _ratio_effect(x: float) -> tuple[float, float]:
    """Return from half the effect of a ratio x to one and a half of it, at most a factor of two from x [-]."""
    low, high = sorted((x**LEAST_EFFECT, x**MOST_EFFECT))
    return max(low, x / TWICE), min(high, x * TWICE)
