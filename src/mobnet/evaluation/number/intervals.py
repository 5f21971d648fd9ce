"""Intervals over runs: networks and test recordings are drawn again, each on its own.

Runs are a grid, every network seed on every test recording, so they are not independent. Drawing the rows and the
columns of the grid anew respects that (the crossed or pigeonhole bootstrap, Owen 2007, doi:10.1214/07-AOAS122);
drawing single runs would give intervals that are too narrow.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import bootstrap  # pyright: ignore[reportMissingTypeStubs, reportUnknownVariableType]

from mobnet.core.errors import DataError
from mobnet.evaluation.number.number import Number
from mobnet.settings.evaluation import Statistics

ALONE = np.zeros(1, dtype=np.intp)  # a single network or test is never drawn
Combine = Callable[[NDArray[np.float64]], NDArray[np.float64]]


def first(means: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the first of the means (K, ...), (...): the plain mean of one grid."""
    return means[0]


def mean(means: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the mean of the means (K, ...), (...), such as that over joints [N m]."""
    return means.mean(axis=0)


def summarise(
    grids: Sequence[NDArray[Any]], statistics: Statistics, seed: int, combine: Combine = first, unit: str = "-"
) -> Number:
    """Return a number made of the means of K grids of runs (networks, tests), and its bootstrap interval, e.g. [N m].

    A test recording is drawn for all grids at once, and so is a network for all that have as many: seeds are shared, so
    a ratio is paired. A method without networks has one row. `combine` makes the number (...) of the means (K, ...).

    Raises:
        DataError: grids of different tests.
    """
    cells = [np.asarray(grid, dtype=np.float64) for grid in grids]
    networks, tests = sorted({len(cell) for cell in cells} - {1}), tests_of(cells)

    def statistic(*drawn: NDArray[np.intp], axis: int = -1) -> NDArray[np.float64]:
        rows = {1: ALONE} | dict(zip(networks, drawn, strict=False))
        columns = drawn[-1] if tests > 1 else ALONE
        means = [mean_of(cell, rows[len(cell)], columns) for cell in cells]
        return combine(np.stack(np.broadcast_arrays(*means)))

    value = float(combine(np.array([cell.mean() for cell in cells])))
    count = max([1, *networks]) * tests
    drawn_from = [np.arange(n) for n in (*networks, tests) if n > 1]
    if not drawn_from:
        return Number(value, runs=count, unit=unit)
    result: Any = bootstrap(
        drawn_from, statistic, n_resamples=statistics.bootstrap_draws, confidence_level=statistics.confidence,
        vectorized=True, paired=False, method="percentile", rng=np.random.default_rng(seed),
    )  # fmt: skip
    low, high = result.confidence_interval
    return Number(value, float(low), float(high), count, unit)


def extremes(values: NDArray[np.float64]) -> list[Number]:
    """Return n numbers, each the mean of some runs with the lowest and the highest one, of values (runs, n)."""
    ends = np.stack([values.mean(axis=0), values.min(axis=0), values.max(axis=0)], axis=1)
    return [Number(*map(float, row), runs=len(values)) for row in ends]


def tests_of(grids: Sequence[NDArray[Any]]) -> int:
    """Return the number of tests of grids (networks, tests) of runs [N m], which must be the same for all."""
    if len({grid.shape[1] for grid in grids}) > 1:
        shapes = ", ".join(str(grid.shape) for grid in grids)
        raise DataError(f"runs of shape (networks, tests) do not fit together: {shapes}")
    return grids[0].shape[1]


def mean_of(grid: NDArray[np.float64], rows: NDArray[np.intp], columns: NDArray[np.intp]) -> NDArray[np.float64]:
    """Return the means (...) [N m] of a grid's runs in drawn rows (..., networks) and columns (..., tests)."""
    return grid[rows[..., :, None], columns[..., None, :]].mean(axis=(-2, -1))
