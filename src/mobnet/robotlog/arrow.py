"""Columns of Arrow as numbers. Its package starts slowly and is imported where it is needed."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}  # in a unit of Arrow's times


def is_numeric(kind: Any) -> bool:
    """Return whether a column of this type of Arrow holds numbers, points in time, times of day or durations."""
    from pyarrow import types

    tests = types.is_floating, types.is_integer, types.is_boolean, types.is_decimal, _is_time
    return any(test(kind) for test in tests)


def _is_time(kind: Any) -> bool:
    """Return whether a type of Arrow is one of times with a unit."""
    from pyarrow import types

    return types.is_timestamp(kind) or types.is_duration(kind) or types.is_time(kind)


def numbers(column: Any) -> NDArray[Any]:
    """Return a column as floating numbers, NaN where it has none; times become seconds, points in time since 1970.

    Arrow's own conversion would import pandas.
    """
    import pyarrow as pa
    import pyarrow.compute as pc

    size = 1.0
    if _is_time(column.type):
        size = SECONDS[column.type.unit]
        whole = pa.int32() if pa.types.is_time32(column.type) else pa.int64()
        column = pc.cast(column, whole)
    if column.type not in (pa.float32(), pa.float64()):
        column = pc.cast(column, pa.float64(), safe=False)
    values: NDArray[Any] = np.from_dlpack(column.fill_null(np.nan) if column.null_count else column)
    return values * size if size != 1.0 else values
