"""Intervals of shares and of counts of independent events; `few_clusters` has those of events that are alike."""

import scipy  # pyright: ignore[reportMissingTypeStubs]  # its parts are imported where they are used first

Ends = tuple[float, float]


def wilson(share: float, trials: float, confidence: float) -> Ends:
    """Return Wilson's interval (1927) of a share [-] of so many trials, which need not be a whole number."""
    square = float(scipy.special.ndtri((1.0 + confidence) / 2.0)) ** 2
    middle = (share + square / (2.0 * trials)) / (1.0 + square / trials)
    reach = (square * (share * (1.0 - share) / trials + square / (4.0 * trials**2))) ** 0.5 / (1.0 + square / trials)
    return (middle - reach if share > 0.0 else 0.0), (middle + reach if share < 1.0 else 1.0)


def garwood(count: float, confidence: float) -> Ends:
    """Return the interval of the mean of a Poisson count (Garwood 1936), which need not be a whole number."""
    tail = (1.0 - confidence) / 2.0
    low = float(scipy.special.gammaincinv(count, tail)) if count else 0.0
    high = float(scipy.special.gammaincinv(count + 1.0, 1.0 - tail))
    return low, high
