"""Arrays of numbers: their type, double precision in physics and control, how compiled code takes them, rotations."""

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


def rotation(quat: NDArray[Any]) -> Array:
    """Return the rotation matrices (..., 3, 3) [-] of unit quaternions w x y z (..., 4), body to world."""
    quat = np.asarray(quat, dtype=np.float64)
    # One sample as Python's numbers, which are as exact: NumPy's calls take ten times as long, in every tick.
    w, x, y, z = quat.tolist() if quat.ndim == 1 else np.moveaxis(quat, -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    matrix = np.array(rows)
    return matrix if quat.ndim == 1 else np.moveaxis(matrix, (0, 1), (-2, -1))
