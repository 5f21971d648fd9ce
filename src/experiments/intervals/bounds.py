"""Closed ranges, such as that around a printed number, and what the interval of a measured one says about them.

A verdict follows from the interval alone: a number is `inside` where the whole interval lies in the range, `outside`
where none of it does, and `open` between the two. More runs shorten the interval until one of the first two is left.
"""

from typing import Literal

from experiments.intervals.number import Number

Bounds = tuple[float | None, float | None]  # closed, lower end first; None is no bound
Verdict = Literal["inside", "outside", "open"]
ANY: Bounds = (None, None)


def verdict_on(number: Number, bounds: Bounds) -> Verdict:
    """Return what the interval of a number says about a range of its unit; `open` where it has none."""
    if number.low is None or number.high is None:
        return "open"
    interval = number.low, number.high
    if within(interval, bounds):
        return "inside"
    return "outside" if apart(interval, bounds) else "open"


def common(first: Bounds, other: Bounds) -> Bounds:
    """Return the range that two closed ranges have in common [their unit]; None is no bound."""
    lows = [low for low in (first[0], other[0]) if low is not None]
    highs = [high for high in (first[1], other[1]) if high is not None]
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
