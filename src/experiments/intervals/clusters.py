"""Intervals of single collisions and walks, which come in clusters: of few robots, and of walks that the robots share.

What a robot does in one walk tells what it does in the next, so that a hundred collisions of three robots say less
than a hundred of independent ones. As in `intervals` (docs/notes/measures.md) the variance of a mean is the sum
of two, that over robots and that over walks of the same seed, each with a quantile of Student's law of its own; of one
robot it is that over its walks alone, and of a single walk there is no interval. Where each robot has walks of its own,
their variance is part of that over robots, which alone counts. Robots and walks need not have equally many values, and
a value may be missing.

Means of positive values have their interval on a log scale, so that no impulse is below zero. Shares and rates have
those of `experiments.intervals.few_clusters`, whose clusters are the robots, or the walks of a single robot.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from experiments.intervals.crossed import quantile_of
from experiments.intervals.few_clusters import rate_ends, share_ends
from experiments.intervals.number import Number
from experiments.intervals.rule import IntervalRule

Array = NDArray[np.float64]


class ClusterKey(NamedTuple):
    """Where a value is from: the robot, and the seed of the walk."""

    robot: str
    seed: int


def mean_in(values: Sequence[float], places: Sequence[ClusterKey], statistics: IntervalRule, unit: str) -> Number:
    """Return the mean of values [unit] at places, with its interval; none below zero if no value is."""
    if not values:
        return Number(None, unit=unit)
    numbers = np.array(values, dtype=np.float64)
    mean = float(numbers.mean())
    effects = _effects((numbers - mean) / len(numbers), places)
    if not effects:
        return Number(mean, unit=unit)
    (first, variance), *others = effects
    # Robots that happen to differ less than independent values would are no evidence for a shorter interval.
    variance = max(variance, float(numbers.var(ddof=1)) / len(numbers))
    squares = [_squared(count, statistics) * part for count, part in [(first, variance), *others]]
    reach = sum(squares) ** 0.5
    # Impulses and times are positive: on a log scale no end of theirs is below zero.
    if (numbers > 0.0).all():
        factor = float(np.exp(reach / mean))
        return Number(mean, mean / factor, mean * factor, unit=unit)
    low = mean - reach
    return Number(mean, max(low, 0.0) if (numbers >= 0.0).all() else low, mean + reach, unit=unit)


def share_in(flags: Sequence[bool], places: Sequence[ClusterKey], statistics: IntervalRule) -> Number:
    """Return the share of flags that are set [-] at places, with its interval."""
    if not flags:
        return Number(None)
    value = float(np.mean(flags))
    index = clusters_of(places)
    if not index.any():
        return Number(value)
    hits = np.bincount(index, weights=flags).astype(int).tolist()
    return Number(value, *share_ends(hits, np.bincount(index).tolist(), statistics))


def rate_in(
    counts: Sequence[int], hours: Sequence[float], places: Sequence[ClusterKey], statistics: IntervalRule
) -> Number:
    """Return how many events there are in an hour [1/h] of the time at places [h], with its interval."""
    whole = sum(hours)
    if whole <= 0.0:
        return Number(None, unit="1/h")
    value = sum(counts) / whole
    # A place without time says nothing.
    walked = [k for k, time_there in enumerate(hours) if time_there > 0.0]
    index = clusters_of([places[k] for k in walked])
    if not index.any():
        return Number(value, unit="1/h")
    events = np.bincount(index, weights=[counts[k] for k in walked]).astype(int).tolist()
    time = np.bincount(index, weights=[hours[k] for k in walked]).tolist()
    return Number(value, *rate_ends(events, time, statistics), unit="1/h")


def clusters_of(places: Sequence[ClusterKey]) -> NDArray[np.intp]:
    """Return the number of each place's cluster: of its robot, or of its walk where all are of one robot."""
    robots = np.unique([place.robot for place in places], return_inverse=True)[1]
    return robots if robots.any() else np.unique([place.seed for place in places], return_inverse=True)[1]


def _effects(parts: Array, places: Sequence[ClusterKey]) -> list[tuple[int, float]]:
    """Return of robots and of walks, where there are several, how many and the variance of the sum of parts (n,)."""
    robots = [place.robot for place in places]
    seeds = [place.seed for place in places]
    has_own_walks = len(set(robots)) > 1 and len(set(places)) == len(set(seeds))
    effects: list[tuple[int, float]] = []
    for names in (robots,) if has_own_walks else (robots, seeds):
        labels, index = np.unique(names, return_inverse=True)
        count = len(labels)
        if count > 1:
            sums = np.bincount(index, weights=parts)
            effects.append((count, count / (count - 1) * float((sums**2).sum())))
    return effects


def _squared(count: int, statistics: IntervalRule) -> float:
    """Return the square of Student's quantile for so many robots or walks [-]."""
    return quantile_of(count - 1, statistics.confidence) ** 2
