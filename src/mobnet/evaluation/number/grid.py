"""Pick the runs behind one number out of the scores."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import DataError
from mobnet.evaluation.number.rows import Score


@dataclass(frozen=True)
class Wanted:
    """What a table cell or a claim looks at.

    Attributes:
        scenario: what was walked.
        limb: limb of section 4.1.
        level: uncertainty level.
        method: estimator.
        joint: joint of the limb, or `avg`.
        metric: a name of `metrics.METRICS`.
    """

    scenario: str
    limb: str
    level: str
    method: str
    joint: str
    metric: str = "rmse"

    def matches(self, row: Score) -> bool:
        """Return whether a row of the scores is one of the runs."""
        return all(getattr(row, name) == value for name, value in vars(self).items())


def run_grid(scores: Sequence[Score], wanted: Wanted) -> NDArray[np.float64]:
    """Return the runs of a number, (networks, tests) [N m] (or the metric's unit), seeds ascending.

    Raises:
        DataError: no run, two rows of the same run, or a network that misses a test.
    """
    rows = [row for row in scores if wanted.matches(row)]
    if not rows:
        raise DataError(f"scores: no row for {describe(wanted)}")
    networks = sorted({row.network_seed for row in rows})
    tests = sorted({row.test_seed for row in rows})
    values = {(row.network_seed, row.test_seed): row.value for row in rows}
    if len(values) != len(rows) or len(values) != len(networks) * len(tests):
        raise DataError(
            f"scores: {len(rows)} rows for {describe(wanted)}; "
            f"expected one for each of networks {networks} on tests {tests}"
        )
    return np.array([[values[network, test] for test in tests] for network in networks])


def unit_of(scores: Sequence[Score], wanted: Wanted) -> str:
    """Return the unit of a number.

    Raises:
        DataError: no run.
    """
    for row in scores:
        if wanted.matches(row):
            return row.unit
    raise DataError(f"scores: no row for {describe(wanted)}")


def describe(wanted: Wanted) -> str:
    """Return what is wanted as text for a message."""
    return ", ".join(f"{name} {value!r}" for name, value in vars(wanted).items())
