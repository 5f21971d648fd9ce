"""Long arrays in pieces of rows that fit into the processor's cache.

The system clears each page of memory that a process gets, so that a temporary array as long as a log costs more time
than what is computed in it.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.robotlog.long_arrays import give_back

PIECE_ROWS = 2048
KEPT_ROWS = 2**18  # after which pages of long arrays are given back


def pieces(start: int, stop: int, rows: int = PIECE_ROWS) -> Iterator[slice]:
    """Yield slices of so many rows, one after another, from a first row up to an end."""
    kept = 0
    for first in range(start, stop, rows):
        yield slice(first, min(first + rows, stop))
        kept += rows
        if kept >= KEPT_ROWS:
            give_back()
            kept = 0
    give_back()


def ranges(values: NDArray[np.floating]) -> tuple[NDArray[np.floating], NDArray[np.floating]]:
    """Return the smallest and the largest number of each column of values (T, n), (n,) each."""
    low = values[0].copy()
    high = values[0].copy()
    for rows in pieces(0, len(values)):
        np.minimum(low, values[rows].min(axis=0), out=low)
        np.maximum(high, values[rows].max(axis=0), out=high)
    return low, high


def root_mean_square(values: NDArray[np.floating]) -> Array:
    """Return the root mean square of each column of values (T, n), (n,)."""
    total = np.zeros(values.shape[1])
    for rows in pieces(0, len(values)):
        total += np.square(values[rows]).sum(axis=0)
    return np.sqrt(total / len(values))
