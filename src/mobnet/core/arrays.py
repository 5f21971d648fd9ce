"""The type of the arrays of numbers, double precision in physics and control, and how compiled code takes them."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import DataError, not_accepted

Array = NDArray[np.float64]


def rows_of(name: str, array: NDArray[Any], samples: tuple[int, ...], width: int) -> Array:
    """Return an array `(*samples, width)` of any float type and memory order as contiguous rows (n, width), float64.

    Raises:
        DataError: it has another shape; compiled code would read what is not there.
    """
    if np.shape(array) != (*samples, width):
        raise DataError(not_accepted(f"shape of {name}", np.shape(array), [(*samples, width)]))
    return np.ascontiguousarray(array, dtype=np.float64).reshape(-1, width)


def check_finite(name: str, array: Array) -> None:
    """Raise a DataError for an array with a number that is not finite, the first of which it names."""
    # A sum shows in one call whether there is one; a sum that is too large is no fault.
    if not math.isfinite(array.sum()) and not np.isfinite(array).all():
        raise DataError(not_accepted(name, float(array[~np.isfinite(array)][0]), ["finite numbers"]))
