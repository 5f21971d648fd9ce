"""What a claim is about: a number made of the means over runs of some cells."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import chain

import numpy as np

from experiments.evaluation.number.intervals import MEAN, RATIO, Array, Formula, RunGrid, summarise
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.single import share, trend
from experiments.settings.runs import Statistics

Cell = Sequence[RunGrid]  # runs of some joints or metrics, of which the mean is meant
Quantity = Callable[[Sequence[Cell], Statistics, str], Number]  # cells, statistics, unit -> number
CUT = Formula(RATIO.parts, lambda ratio: 1.0 - ratio, positive=True)
BELOW = Formula(lambda means: means[1:] - means[:1])
ABOVE = Formula(lambda means: means[:1] - means[1:])
LEAST_RATIO = Formula(lambda means: np.divide(*np.split(means, 2)), positive=True)
GAP_RATIO = Formula(lambda means: (means[:1] - means[1:2]) / (means[2:3] - means[3:4]), np.abs)
GAP = Formula(ABOVE.parts, np.abs)

FORMULAS: Mapping[str, Formula] = {
    "value": MEAN,
    "ratio": RATIO,
    "cut": CUT,
    "difference": ABOVE,
    "below": BELOW,
    "above": ABOVE,
    "least ratio": LEAST_RATIO,
}


def summarised(
    formula: Formula, cells: Sequence[Cell], statistics: Statistics, unit: str, power: float = 1.0
) -> Number:
    """Return the number that a formula makes of the means of K cells, or of their powers, with its interval [unit]."""
    ends = np.cumsum([len(cell) for cell in cells])[:-1]

    def parts(means: Array) -> Array:
        return formula.parts(np.stack([(of_cell**power).mean(axis=0) for of_cell in np.split(means, ends)]))

    return summarise(list(chain.from_iterable(cells)), statistics, replace(formula, parts=parts), unit)


def alone(measure: Callable[[Sequence[RunGrid], Statistics, str], Number]) -> Quantity:
    """Return a quantity of cells that each have the runs of one number."""
    return lambda cells, statistics, unit: measure([grid for (grid,) in cells], statistics, unit)


def difference_of(first: Number, second: Number, unit: str) -> Number:
    """Return the difference of two numbers with its interval, made of theirs [unit]; none where one has none.

    Source: Zou and Donner 2008, Statistics in Medicine 27: the distance of each number from the end of its interval
    stands for its spread on that side. Of shares with Wilson's interval it is method 10 of Newcombe 1998, ibid. 17. The
    numbers are taken to be independent; of detectors on the same collisions the interval is too long rather than short.
    """
    if first.value is None or second.value is None:
        return Number(None, unit=unit)
    value = first.value - second.value
    if first.low is None or first.high is None or second.low is None or second.high is None:
        return Number(value, unit=unit)
    # The difference falls where the first number falls or the second one rises, and the two do so independently.
    below = np.hypot(first.value - first.low, second.high - second.value)
    above = np.hypot(first.high - first.value, second.value - second.low)
    return Number(value, float(value - below), float(value + above), unit=unit)


def gap_difference(cells: Sequence[Cell], statistics: Statistics, unit: str) -> Number:
    """Return |first - second| - |third - fourth| [unit], with the intervals of both gaps taken together."""
    first, second = (summarised(GAP, pair, statistics, unit) for pair in (cells[:2], cells[2:]))
    gaps = difference_of(first, second, unit)
    return replace(gaps, networks=first.networks, walks=first.walks)


def gap_ratio(cells: Sequence[Cell], statistics: Statistics, unit: str) -> Number:
    """Return |first - second| / |third - fourth| [-], without an interval where that of the denominator holds zero."""
    ratio = summarised(GAP_RATIO, cells, statistics, unit)
    gap = summarised(ABOVE, cells[2:], statistics, unit)
    if gap.low is None or gap.high is None or gap.low <= 0.0 <= gap.high:
        return replace(ratio, low=None, high=None)
    return ratio


QUANTITIES: Mapping[str, Quantity] = {
    **{name: partial(summarised, formula) for name, formula in FORMULAS.items()},
    "gap ratio": gap_ratio,
    "gap difference": gap_difference,
    "square cut": partial(summarised, CUT, power=2.0),
    "trend": alone(trend),
    "share": alone(share),
}
