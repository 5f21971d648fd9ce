"""Reading a log as columns of numbers, whatever its format."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError, not_accepted


@dataclass(frozen=True)
class Column:
    """One column of a log: values (T,) in its own unit and, in formats that stamp each message, times (T,) [s]."""

    values: Array
    time_s: Array | None = None


Columns = Mapping[str, Column]


def read_log(path: Path) -> Columns:
    """Read all columns of numbers of a log.

    Raises:
        DataError: the format is not known, or the file is missing or damaged.
    """
    if not path.exists():
        raise DataError(f"{path}: file is missing; accepted: a log, {', '.join(READERS)}")
    kind = path.suffix.lower()
    if kind not in READERS:
        raise DataError(not_accepted(f"{path}: format", kind or path.name, READERS))
    try:
        columns = READERS[kind](path)
    except (DataError, MemoryError):
        raise
    except Exception as error:  # two libraries, each with errors of its own for a damaged file
        text = " ".join(str(error).split()) or type(error).__name__
        raise DataError(f"{path}: cannot be read as {kind}: {text}; accepted: a whole file") from error
    if not columns:
        raise DataError(f"{path}: holds no column of numbers; accepted: at least positions, velocities and torques")
    return columns


def _csv(path: Path) -> dict[str, Column]:
    """Read a CSV with a header; columns that hold anything but numbers are left out."""
    import pandas as pd  # a second to import

    frame = pd.read_csv(path, skipinitialspace=True)
    return _of_table(frame.columns, lambda name: frame[name].to_numpy())


def _parquet(path: Path) -> dict[str, Column]:
    """Read a Parquet file."""
    import pyarrow.parquet as pq

    table = pq.read_table(path)
    return _of_table(table.column_names, lambda name: table[name].to_numpy())


def _of_table(names: Any, column: Callable[[str], NDArray[Any]]) -> dict[str, Column]:
    """Return the columns of a table that hold numbers."""
    found = {str(name): column(name) for name in names}
    return {name: Column(values.astype(np.float64)) for name, values in found.items() if values.dtype.kind in "fiub"}


READERS: Mapping[str, Callable[[Path], dict[str, Column]]] = {".csv": _csv, ".parquet": _parquet}


def names_like(columns: Columns) -> Iterator[str]:
    """Yield the names of a log's columns for a message, those of numbered series once, as NAME.0 to NAME.n."""
    series: dict[str, int] = {}
    for name in columns:
        stem, _, number = name.rpartition(".")
        if number.isdigit() and stem:
            series[stem] = max(series.get(stem, 0), int(number))
        else:
            series.setdefault(name, -1)
    for name, last in series.items():
        yield name if last < 0 else f"{name}.0 to {name}.{last}"
