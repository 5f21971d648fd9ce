"""Intervals over runs: networks and test recordings are drawn again, each on its own.

Runs are a grid, every network seed on every test recording, so they are not independent. Drawing the rows and the
columns of the grid anew respects that (the crossed or pigeonhole bootstrap, Owen 2007, doi:10.1214/07-AOAS122);
drawing single runs would give intervals that are too narrow.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import bootstrap

from mobnet.core.errors import DataError

Combine = Callable[[NDArray[np.float64]], NDArray[np.float64]]


@dataclass(frozen=True)
class Summary:
    """A number over runs.

    Attributes:
        value: the number made of the means over all runs [unit of the runs].
        low: lower end of its interval; None with a single run.
        high: upper end of its interval; None with a single run.
        count: runs.
    """

    value: float
    low: float | None
    high: float | None
    count: int


def first(means: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the first of the means (K, ...), (...): the plain mean of one grid."""
    return means[0]


def mean(means: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the mean of the means (K, ...), (...), such as that over joints [N m]."""
    return means.mean(axis=0)


def summarise(grids: Sequence[NDArray[Any]], config: Mapping[str, Any], combine: Combine = first) -> Summary:
    """Return a number made of the means of grids of runs, and its bootstrap interval, e.g. [N m].

    A network is drawn for all grids at once, and so is a test recording: seeds are shared, so a ratio is paired.

    Args:
        grids: K grids (networks, tests); a method without networks has one row, which stands for all.
        config: resolved configuration: `seed`, `evaluation.confidence` (0..1), `evaluation.bootstrap_draws`.
        combine: means (K, ...) -> number (...).

    Raises:
        DataError: grids of different tests or networks.
    """
    cells = stack(grids)
    _, networks, tests = cells.shape

    def statistic(*drawn: NDArray[np.intp], axis: int = -1) -> NDArray[np.float64]:
        rows, columns = _rows_and_columns(drawn, networks, tests)
        return combine(cells[:, rows[..., :, None], columns[..., None, :]].mean(axis=(-2, -1)))

    value = float(combine(cells.mean(axis=(-2, -1))))
    samples = tuple(np.arange(n) for n in (networks, tests) if n > 1)
    if not samples:
        return Summary(value, None, None, networks * tests)
    settings = config["evaluation"]
    result = bootstrap(
        samples, statistic, n_resamples=settings["bootstrap_draws"], confidence_level=settings["confidence"],
        vectorized=True, paired=False, method="percentile", rng=np.random.default_rng(config["seed"]),
    )  # fmt: skip
    low, high = result.confidence_interval
    return Summary(value, float(low), float(high), networks * tests)


def stack(grids: Sequence[NDArray[Any]]) -> NDArray[np.float64]:
    """Return grids (networks, tests) as one array (K, networks, tests) [N m], a single row repeated for all.

    Raises:
        DataError: the shapes do not fit.
    """
    try:
        return np.array(np.broadcast_arrays(*grids), dtype=np.float64)
    except ValueError:
        shapes = ", ".join(str(grid.shape) for grid in grids)
        raise DataError(f"runs of shape (networks, tests) do not fit together: {shapes}") from None


def _rows_and_columns(
    drawn: Sequence[NDArray[np.intp]], networks: int, tests: int
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return drawn rows (..., networks) and columns (..., tests); an axis of length one is never drawn."""
    one = np.zeros(1, dtype=np.intp)
    if networks > 1 and tests > 1:
        return drawn[0], drawn[1]
    return (drawn[0], one) if networks > 1 else (one, drawn[0])
