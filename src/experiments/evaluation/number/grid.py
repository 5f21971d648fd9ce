"""The runs behind one number, picked out of the scores, and the number that they make."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from experiments.evaluation.number.intervals import MEAN, Formula, RunGrid, summarise
from experiments.evaluation.number.number import Number
from experiments.settings.fleet import FIRST_SEED
from experiments.settings.runs import Statistics
from mobnet.core.columns import Score
from mobnet.core.errors import DataError


@dataclass(frozen=True)
class Wanted:
    """What a table cell or a claim looks at: a joint or `avg`, and a name of `metrics.METRICS` or of a push's."""

    scenario: str
    limb: str
    level: str
    method: str
    joint: str
    metric: str = "rmse"

    def rows(self, scores: Sequence[Score]) -> list[Score]:
        """Return the rows of its runs.

        Raises:
            DataError: no run.
        """
        asked = vars(self)
        rows: list[Score] = []
        for row in scores:
            if all(getattr(row, name) == value for name, value in asked.items()):
                rows.append(row)
        if not rows:
            raise DataError(f"scores: no row for {self}")
        return rows

    def __str__(self) -> str:
        """Return what is wanted as text for a message."""
        return ", ".join(f"{name} {value!r}" for name, value in vars(self).items())


def run_grid(scores: Sequence[Score], wanted: Wanted) -> RunGrid:
    """Return the runs of a number, (networks, walks) in the unit of its metric, seeds ascending.

    Raises:
        DataError: no run, two rows of the same run, or a network that misses a test.
    """
    rows = wanted.rows(scores)
    # In ascending order column k of every grid is the walk of the same seed, over which numbers are paired (note 0022).
    networks = sorted({row.network_seed for row in rows})
    tests = sorted({row.test_seed for row in rows})
    values = {(row.network_seed, row.test_seed): row.value for row in rows}
    # Variances of rows and of columns need every network on every walk, and each run once.
    if len(values) != len(rows) or len(values) != len(networks) * len(tests):
        raise DataError(
            f"scores: {len(rows)} rows for {wanted}; expected one for each of networks {networks} on tests {tests}"
        )
    runs: list[list[float]] = []
    for network in networks:
        runs.append([values[network, test] for test in tests])
    return RunGrid(np.array(runs), rows_of(wanted.method, networks))


def rows_of(method: str, seeds: Sequence[int]) -> str:
    """Return what the rows of a method's runs with some network seeds are: its own networks, or robots, as of all."""
    return f"robots {seeds}" if min(seeds) >= FIRST_SEED else method


def number_of(
    scores: Sequence[Score],
    wanted: Sequence[Wanted],
    statistics: Statistics,
    formula: Formula = MEAN,
    published: float | None = None,
) -> Number:
    """Return the number that a formula makes of mean errors, with its interval, in the first one's unit, e.g. [N m]."""
    unit = wanted[0].rows(scores)[0].unit
    number = summarise([run_grid(scores, each) for each in wanted], statistics, formula, unit)
    return replace(number, published=published)
