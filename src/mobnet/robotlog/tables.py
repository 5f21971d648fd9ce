"""Logs that are tables: CSV, Parquet and HDF5. Their packages start slowly and are imported where they are needed."""

import csv
from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import DataError
from mobnet.robotlog.columns import Column, module_of

BLOCK_BYTES = 4 * 2**20  # of a CSV file that are read together


def csv_names(path: Path) -> list[str]:
    """Return the header of a CSV file."""
    return _csv_header(path)[0]


def _csv_header(path: Path) -> tuple[list[str], str]:
    """Return the names in the header of a CSV file, and what stands between them: a comma, semicolon or tabulator."""
    with path.open(newline="", encoding="utf-8-sig") as file:
        header = file.readline()
    between = max(",;\t", key=header.count)
    names = [name.strip() for name in next(csv.reader([header], delimiter=between, skipinitialspace=True), [])]
    if twice := [name for k, name in enumerate(names) if name in names[:k]]:
        raise DataError(f"{path}: column {twice[0]!r} stands twice in the header; accepted: each name once")
    return names, between


def csv_columns(path: Path, wanted: Collection[str]) -> dict[str, Column]:
    """Read columns of a CSV with a header; a field without a number is NaN."""
    import pyarrow as pa
    from pyarrow import csv as arrow

    names, between = _csv_header(path)
    layout, asked = arrow.ParseOptions(delimiter=between), set(wanted)
    rows = arrow.ReadOptions(column_names=names, skip_rows=1, block_size=BLOCK_BYTES)
    empty = [*arrow.ConvertOptions().null_values, " "]
    kept = {"include_columns": [name for name in names if name in asked], "null_values": empty}
    with arrow.open_csv(path, rows, layout, arrow.ConvertOptions(**kept)) as file:
        first = file.schema  # of the first block: what looks whole there, or empty, may be a fraction further down
    kinds = {f.name: pa.float64() for f in first if pa.types.is_integer(f.type) or pa.types.is_null(f.type)}
    with arrow.open_csv(path, rows, layout, arrow.ConvertOptions(**kept, column_types=kinds)) as file:
        held = [k for k, kind in enumerate(file.schema.types) if _is_numeric(kind)]
        if not held:
            return {}
        # Whole columns of Arrow's own reader would take twice the memory.
        blocks = [np.stack([_numbers(batch.column(k)) for k in held]) for batch in file]
        return dict(zip((file.schema.names[k] for k in held), map(Column, np.concatenate(blocks, axis=1)), strict=True))


def parquet_names(path: Path) -> list[str]:
    """Return the columns of a Parquet file."""
    import pyarrow.parquet as pq

    return pq.read_schema(path).names


def parquet_columns(path: Path, wanted: Collection[str]) -> dict[str, Column]:
    """Read columns of a Parquet file."""
    import pyarrow.parquet as pq

    with pq.ParquetFile(path) as file:
        kinds = {field.name: field.type for field in file.schema_arrow}
        held = [name for name in wanted if name in kinds and _is_numeric(kinds[name])]
        # One at a time: a whole table of Arrow's would stay beside the columns.
        return {name: Column(_numbers(file.read([name]).column(name).combine_chunks())) for name in held}


def _is_numeric(kind: Any) -> bool:
    """Return whether a column of this type of Arrow holds numbers, or points in time."""
    from pyarrow import types

    tests = types.is_floating, types.is_integer, types.is_boolean, types.is_timestamp
    return any(test(kind) for test in tests)


def _numbers(column: Any) -> NDArray[Any]:
    """Return a column as floating numbers, NaN where it has none; points in time become seconds since 1970.

    Arrow's own conversion would import pandas.
    """
    import pyarrow as pa
    import pyarrow.compute as pc

    is_time = pa.types.is_timestamp(column.type)
    if is_time:
        column = pc.cast(column, pa.timestamp("ns", column.type.tz)).cast(pa.int64())
    if column.type not in (pa.float32(), pa.float64()):
        column = pc.cast(column, pa.float64(), safe=False)
    values: NDArray[Any] = np.from_dlpack(column.fill_null(np.nan) if column.null_count else column)
    return values * 1e-9 if is_time else values


def hdf5_names(path: Path) -> list[str]:
    """Return a column for each dataset (T,) by its path, and PATH.0 to PATH.n-1 for one of (T, n)."""
    return [name for name, _ in _hdf5_parts(path)]


def hdf5_columns(path: Path, wanted: Collection[str]) -> dict[str, Column]:
    """Read columns of an HDF5 file; a dataset is read once."""
    asked: dict[str, list[tuple[str, int]]] = {}
    names = set(wanted)
    for name, (dataset, k) in _hdf5_parts(path):
        if name in names:
            asked.setdefault(dataset, []).append((name, k))
    found = dict[str, Column]()
    with module_of("h5py", path).File(path, "r") as file:
        for dataset, parts in asked.items():
            values = np.atleast_2d(np.asarray(file[dataset][()], dtype=np.float64).T)
            found |= {name: Column(np.ascontiguousarray(values[k])) for name, k in parts}
    return found


def _hdf5_parts(path: Path) -> list[tuple[str, tuple[str, int]]]:
    """Return the name of each column in an HDF5 file, with its dataset and its number there."""
    h5py, found = module_of("h5py", path), list[tuple[str, tuple[str, int]]]()

    def visit(name: str, item: Any) -> None:
        if isinstance(item, h5py.Dataset) and item.dtype.kind in "fiub" and item.ndim in (1, 2):
            if item.external or item.is_virtual:  # any file of this machine could become a column of the recording
                raise DataError(f"{path}: {name!r} takes its numbers from other files; accepted: a file that holds all")
            columns = [name] if item.ndim == 1 else [f"{name}.{k}" for k in range(item.shape[1])]
            found.extend((column, (name, k)) for k, column in enumerate(columns))

    with h5py.File(path, "r") as file:
        file.visititems(visit)
    return found
