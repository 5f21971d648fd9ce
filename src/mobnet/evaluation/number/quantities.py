"""What a claim is about: a number made of the means over runs of some cells."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from mobnet.evaluation.number.intervals import MEAN, RATIO, Array, Formula, RunGrid, summarise
from mobnet.evaluation.number.number import Number
from mobnet.evaluation.number.single import share, trend
from mobnet.settings.runs import Statistics

Cell = Sequence[RunGrid]  # runs of some joints or metrics, of which the mean is meant
Quantity = Callable[[Sequence[Cell], Statistics, str], Number]  # cells, statistics, unit -> number
CUT = Formula(RATIO.parts, lambda ratio: 1.0 - ratio, positive=True)
BELOW = Formula(lambda means: means[1:] - means[:1])
ABOVE = Formula(lambda means: means[:1] - means[1:])
LEAST_RATIO = Formula(lambda means: np.divide(*np.split(means, 2)), positive=True)
GAP_RATIO = Formula(lambda means: (means[:1] - means[1:2]) / (means[2:3] - means[3:4]), np.abs)

FORMULAS: Mapping[str, Formula] = {
    "value": MEAN,
    "ratio": RATIO,
    "cut": CUT,
    "difference": ABOVE,
    "below": BELOW,
    "above": ABOVE,
    "least ratio": LEAST_RATIO,
    "gap ratio": GAP_RATIO,
}


def summarised(
    formula: Formula, cells: Sequence[Cell], statistics: Statistics, unit: str, power: float = 1.0
) -> Number:
    """Return the number that a formula makes of the means of K cells, or of their powers, with its interval [unit]."""
    ends = np.cumsum([len(cell) for cell in cells])[:-1]

    def parts(means: Array) -> Array:
        return formula.parts(np.stack([(own**power).mean(axis=0) for own in np.split(means, ends)]))

    return summarise([grid for cell in cells for grid in cell], statistics, replace(formula, parts=parts), unit)


def alone(measure: Callable[[Sequence[RunGrid], Statistics, str], Number]) -> Quantity:
    """Return a quantity of cells that each have the runs of one number."""
    return lambda cells, statistics, unit: measure([grid for (grid,) in cells], statistics, unit)


QUANTITIES: Mapping[str, Quantity] = {
    **{name: partial(summarised, formula) for name, formula in FORMULAS.items()},
    "square cut": partial(summarised, CUT, power=2.0),
    "trend": alone(trend),
    "share": alone(share),
}
