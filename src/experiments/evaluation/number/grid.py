"""The runs behind one number, picked out of the scores, and the number that they make."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from experiments.evaluation.number.intervals import MEAN, Formula, RunGrid, summarise
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import read_scores
from experiments.records.scores import Score
from experiments.settings.fleet import FIRST_SEED
from experiments.settings.runs import Runs, Statistics
from mobnet.core.errors import ConfigError, DataError
from mobnet.core.joints import JointLayout

AVERAGE = "avg"


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
    # In ascending order column k of every grid is the walk of the same seed, over which numbers are paired
    # (docs/notes/measures.md); a robot has walks of its own.
    networks = sorted({row.network_seed for row in rows})
    tests = sorted({row.test_seed for row in rows})
    values = {(row.network_seed, row.test_seed): row.value for row in rows}
    robots = robots_of(networks)
    walks = len(rows) // len(networks) if robots else len(tests)
    runs: list[list[float]] = []
    for network in networks:
        runs.append([values[network, test] for test in tests if (network, test) in values])
    # Variances of rows and of columns need equally many walks of each network, and each run once.
    if len(values) != len(rows) or any(len(own) != walks for own in runs):
        raise DataError(
            f"scores: {len(rows)} rows for {wanted}; expected one for each of networks {networks} on tests {tests}"
        )
    return RunGrid(np.array(runs), wanted.method, robots)


def robots_of(seeds: Sequence[int]) -> tuple[int, ...]:
    """Return the robots of runs with some network seeds, where these are robots; else nothing."""
    return tuple(seeds) if min(seeds) >= FIRST_SEED else ()


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


def places_of(layout: JointLayout, name: str, joints: Sequence[str]) -> list[tuple[str, str]]:
    """Return limb and name of some joints, over which a mean is taken: torques must be all in N m or all in N.

    Raises:
        ConfigError: a joint is unknown, or the units differ.
    """
    layout.columns(joints)
    units = sorted({layout.unit(joint) for joint in joints})
    if len(units) > 1:
        raise ConfigError(f"column {name!r}: a mean over {', '.join(joints)} mixes {' and '.join(units)}")
    return [(layout.limb_of[joint], joint) for joint in joints]


def members(layout: JointLayout, name: str) -> tuple[str, ...]:
    """Return the joints of a limb, or the joint itself."""
    return layout.groups.get(name, (name,))
