"""Intervals of shares and of rates of events that come in few clusters, such as the walks of three robots.

What a robot does in one walk tells what it does in the next, so that a hundred collisions of three robots say less
than a hundred of independent ones. Few clusters do not tell how alike the events of one of them are: anything from
independent events to what the configuration allows is taken to be as likely.

* A share: each cluster has one of its own, from a beta law about the common one (beta-binomial counts).
* A rate: each cluster has one of its own, from a gamma law about the common one (negative binomial counts).

Of the common share or rate nothing is known before. The interval is the shortest that holds the asked part of what the
counts leave likely (highest posterior density); docs/notes/measures.md has how often it holds the truth in simulations.
"""

import functools
from collections.abc import Sequence

import numpy as np
import scipy  # pyright: ignore[reportMissingTypeStubs]  # its parts are imported where they are used first
from numpy.typing import NDArray

from experiments.intervals.rule import IntervalRule

SHARES, RATES = 1000, 4000  # cells
STEPS = 12  # of how alike the events of a cluster are
WIDEST = 4.0  # times the end of a count of independent events: up to there rates are looked at
Array = NDArray[np.float64]
Ends = tuple[float, float]


def share_ends(hits: Sequence[int], sizes: Sequence[int], statistics: IntervalRule) -> Ends:
    """Return the interval of a share [-] of which each cluster has so many found of so many events."""
    clusters = tuple(sorted(zip(hits, sizes, strict=True)))
    return _share_ends(clusters, statistics.most_correlation, statistics.confidence)


@functools.lru_cache(maxsize=4096)  # of small counts the same ones come again and again
def _share_ends(clusters: tuple[tuple[int, int], ...], most_correlation: float, confidence: float) -> Ends:
    """Return the interval of a share [-] of clusters with so many found of so many events."""
    certainty = 1.0 / (most_correlation * _middles(STEPS)) - 1.0
    alpha = _middles(SHARES)[:, None] * certainty
    beta = certainty - alpha
    likelihood = -len(clusters) * scipy.special.betaln(alpha, beta)
    for count, size in clusters:
        likelihood += scipy.special.betaln(alpha + count, beta + size - count)
    return _shortest(likelihood, 1.0 / SHARES, confidence)


def rate_ends(counts: Sequence[int], hours: Sequence[float], statistics: IntervalRule) -> Ends:
    """Return the interval of a rate [1/h] at which each cluster has so many events in so many hours."""
    variation = statistics.most_variation * _middles(STEPS)
    shape = 1.0 / variation**2
    total = sum(counts)
    highest = WIDEST * (total + 2.0 + 4.0 * (total + 1.0) ** 0.5) / sum(hours)
    rates = highest * _middles(RATES)[:, None]
    likelihood = np.zeros((RATES, STEPS))
    for count, hours_of_cluster in zip(counts, hours, strict=True):
        expected = rates * hours_of_cluster
        likelihood += scipy.special.gammaln(shape + count) - scipy.special.gammaln(shape)
        likelihood += shape * np.log(shape / (shape + expected)) + count * np.log(expected / (shape + expected))
    return _shortest(likelihood, highest / RATES, statistics.confidence)


def _middles(count: int) -> Array:
    """Return the middles of so many equal parts of 0 to 1."""
    return (np.arange(count) + 0.5) / count


def _shortest(likelihood: Array, cell: float, confidence: float) -> Ends:
    """Return the ends of the likeliest cells that hold a part `confidence`, of logarithms (cells, steps)."""
    weights = np.exp(likelihood - likelihood.max()).sum(axis=1)
    order = np.argsort(-weights, kind="stable")
    covered = np.cumsum(weights[order]) / weights.sum()
    kept = order[: int(np.searchsorted(covered, confidence)) + 1]
    return float(kept.min()) * cell, float(kept.max() + 1) * cell
