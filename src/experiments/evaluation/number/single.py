"""Intervals where each of several numbers has a single run, where runs only succeed or fail, of counts, without law."""

from collections.abc import Sequence
from dataclasses import replace
from math import factorial

import numpy as np
import scipy  # pyright: ignore[reportMissingTypeStubs]  # its parts are imported where they are used first

from experiments.evaluation.number.intervals import Array, RunGrid
from experiments.evaluation.number.number import Number
from experiments.settings.independent import garwood
from experiments.settings.runs import Statistics


def trend(grids: Sequence[RunGrid], statistics: Statistics, unit: str = "-") -> Number:
    """Return the median slope of the means of K grids over their order [unit], with Sen's interval (1968).

    It needs a single run of each, and no line: a loss that falls ever more slowly would scatter around one. The
    interval follows from how many pairs of K numbers without a trend rise; so few that all may do have none.
    """
    means = [grid.mean for grid in grids]
    networks = tuple(len(grid.values) for grid in grids)
    slope, _, low, high = map(float, scipy.stats.theilslopes(means, alpha=statistics.confidence))
    number = Number(slope, unit=unit, networks=networks, walks=(1,))
    all_rise_or_fall = 2.0 / factorial(len(means))  # chance of it without a trend
    return number if all_rise_or_fall > 1.0 - statistics.confidence else replace(number, low=low, high=high)


def share(grids: Sequence[RunGrid], statistics: Statistics, unit: str = "-") -> Number:
    """Return the share of the runs of a grid that are 1 and not 0 [-], with Wilson's interval (1927)."""
    (grid,) = grids
    networks, walks = grid.values.shape
    test = scipy.stats.binomtest(round(float(grid.values.sum())), networks * walks)
    ends = test.proportion_ci(statistics.confidence, method="wilson")
    return Number(grid.mean, float(ends.low), float(ends.high), unit=unit, networks=(networks,), walks=(walks,))


def rate_of(count: int, hours: float, statistics: Statistics) -> Number:
    """Return how many events there are in an hour [1/h], with the interval of a Poisson count (Garwood 1936).

    Events are taken as independent of each other. In no time there is no rate.
    """
    if hours <= 0.0:
        return Number(None, unit="1/h")
    low, high = garwood(count, statistics.confidence)
    return Number(count / hours, low / hours, high / hours, unit="1/h")


def extremes(values: Array) -> list[Number]:
    """Return n numbers, each the mean of some runs with the lowest and the highest one, of values (runs, n)."""
    ends = np.stack([values.mean(axis=0), values.min(axis=0), values.max(axis=0)], axis=1)
    return [Number(mean, low, high, networks=(len(values),), walks=(1,)) for mean, low, high in ends.tolist()]
