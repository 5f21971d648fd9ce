"""Scores by what they are of, so that a product of many numbers goes through them once."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from experiments.evaluation.number.grid import Wanted, run_grid
from experiments.evaluation.number.intervals import MEAN, Formula, summarise
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import read_scores
from experiments.settings.runs import Runs, Statistics
from mobnet.core.columns import Score

AVERAGE = "avg"


@dataclass(frozen=True)
class Lookup:
    """The runs behind every number that was scored, and how an interval is made of them."""

    statistics: Statistics
    scores: Mapping[Wanted, Sequence[Score]] = field(repr=False)

    def number(self, wanted: Sequence[Wanted], formula: Formula = MEAN) -> Number:
        """Return what a formula makes of means, with its interval, in the first one's unit; none if any is missing.

        A number may be missing where the runs are there: a push that comes after the end of a short test, or a joint
        that it does not turn.
        """
        rows = [self.scores.get(one, ()) for one in wanted]
        if not all(rows):
            return Number(None)
        grids = [run_grid(own, one) for own, one in zip(rows, wanted, strict=True)]
        return summarise(grids, self.statistics, formula, rows[0][0].unit)

    def average(self, test: Runs, method: str, limb: str, metric: str) -> Number:
        """Return the mean over a limb's joints of a metric of a method in a test [the metric's unit]."""
        return self.number([Wanted(test.scenario, limb, test.level, method, AVERAGE, metric)])


def read_lookup(paths: Iterable[Path], statistics: Statistics) -> Lookup:
    """Read files of scores."""
    found: dict[Wanted, list[Score]] = defaultdict(list)
    for row in read_scores(*paths):
        found[Wanted(row.scenario, row.limb, row.level, row.method, row.joint, row.metric)].append(row)
    return Lookup(statistics, found)
