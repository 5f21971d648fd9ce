"""Reading a log as columns of numbers, each with its own clock, whatever its format.

Formats other than CSV and Parquet have a reader in a package of their own, which only they import.
"""

import importlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError, not_accepted

PACKAGES = {"h5py": "h5py", "mcap_ros2": "mcap-ros2-support", "rosbags": "rosbags"}  # module -> package that holds it
METADATA = "metadata.yaml"  # in each folder that `ros2 bag` wrote


@dataclass(frozen=True)
class Column:
    """One column of a log: values (T,) in its own unit and, in formats that stamp each message, times (T,) [s]."""

    values: Array
    time_s: Array | None = None


Columns = Mapping[str, Column]


def read_log(path: Path) -> Columns:
    """Read all columns of numbers of a log.

    Raises:
        DataError: the format is not known, its reader is not installed, or the file is missing or damaged.
    """
    if not path.exists():
        raise DataError(f"{path}: file is missing; accepted: a log, {', '.join(READERS)} or a folder of `ros2 bag`")
    kind = METADATA if (path / METADATA).is_file() else path.suffix.lower()
    if kind not in READERS:
        raise DataError(not_accepted(f"{path}: format", kind or path.name, [*READERS, "a folder of `ros2 bag`"]))
    try:
        columns = READERS[kind](path)
    except (DataError, MemoryError):
        raise
    except Exception as error:  # five libraries, each with errors of its own for a damaged file
        text = " ".join(str(error).split()) or type(error).__name__
        raise DataError(f"{path}: cannot be read as {kind}: {text}; accepted: a whole file") from error
    if not columns:
        raise DataError(f"{path}: holds no column of numbers; accepted: at least positions, velocities and torques")
    return columns


def module_of(name: str, path: Path) -> ModuleType:
    """Return a reader's module.

    Raises:
        DataError: it is not installed; the line says how to install it.
    """
    try:
        return importlib.import_module(name)
    except ImportError:
        package = PACKAGES[name.partition(".")[0]]
        text = f"needs the package {package}; install it: .venv/bin/python -m pip install {package}"
        raise DataError(f"{path}: {text}") from None


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


def _hdf5(path: Path) -> dict[str, Column]:
    """Read a HDF5 file: a dataset (T,) is a column named by its path, one of (T, n) is n columns PATH.0 to PATH.n-1."""
    h5py, found = module_of("h5py", path), dict[str, Column]()

    def visit(name: str, item: Any) -> None:
        if not isinstance(item, h5py.Dataset) or item.dtype.kind not in "fiub" or item.ndim not in (1, 2):
            return
        values = np.asarray(item[()], dtype=np.float64)
        columns = {name: values} if values.ndim == 1 else {f"{name}.{k}": row for k, row in enumerate(values.T)}
        found.update({key: Column(np.ascontiguousarray(row)) for key, row in columns.items()})

    with h5py.File(path, "r") as file:
        file.visititems(visit)
    return found


def _messages(path: Path) -> dict[str, Column]:
    """Read the messages of a MCAP file or a bag of ROS 1 or 2."""
    from mobnet.robotlog.messages import columns_of, mcap_messages, ros_messages

    stream = mcap_messages if path.suffix.lower() == ".mcap" else ros_messages
    return columns_of(stream(path))


READERS: Mapping[str, Callable[[Path], dict[str, Column]]] = {
    ".csv": _csv,
    ".parquet": _parquet,
    ".h5": _hdf5,
    ".hdf5": _hdf5,
    ".mcap": _messages,
    ".bag": _messages,
    METADATA: _messages,
}


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
