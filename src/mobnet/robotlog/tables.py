"""Logs that are Parquet, or arrays of HDF5, MATLAB or NumPy.

Their packages start slowly and are imported where they are needed.
"""

import contextlib
from collections.abc import Collection, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import DataError
from mobnet.robotlog.columns import MOST, LogColumn, check_memory
from mobnet.robotlog.delimited import is_numeric, numbers

STRUCTURE = "log = struct('time', x.Time, 'q', x.Data)"  # which makes of an object of MATLAB what others can read
REFERENCED = "#refs#/"  # where MATLAB keeps what arrays of structures and cells refer to


class TableColumn(NamedTuple):
    """A column in a file: its array there, the field of a compound one, and its number in one of several columns."""

    array: str
    field: str | None = None
    number: int | None = None


def parquet_names(path: Path) -> list[str]:
    """Return the columns of a Parquet file; NAME.0 to NAME.n-1 of one with lists of n numbers."""
    import pyarrow.parquet as pq

    with pq.ParquetFile(path) as file:
        return list(_parquet_parts(file))


def parquet_columns(path: Path, wanted: Collection[str]) -> dict[str, LogColumn]:
    """Return columns of a Parquet file; those of plain numbers are read when they are asked for.

    Raises:
        DataError: lists of a column differ in their lengths.
    """
    import pyarrow.parquet as pq

    with pq.ParquetFile(path) as file:
        parts = _parquet_parts(file)
        asked = {name: parts[name] for name in wanted if name in parts}
        # Others are read one by one, when they are needed.
        in_lists = [part for part in asked.values() if part.number is not None]
        check_memory(path, file.metadata.num_rows, max(1, len(in_lists)))
        columns = dict[str, LogColumn]()
        lists = dict[str, NDArray[Any]]()
        kinds = {field.name: field.type for field in file.schema_arrow}
        for name, part in asked.items():
            if part.number is not None:
                if part.array not in lists:
                    lists[part.array] = _lists(path, part.array, file.read([part.array]).column(part.array))
                columns[name] = LogColumn(np.ascontiguousarray(lists[part.array][:, part.number]))
            elif is_numeric(kinds[part.array]):
                columns[name] = LogColumn(partial(_numbers_of, path, part.array))
            else:
                columns[name] = LogColumn(np.empty(0), found=str(kinds[part.array]))
        return columns


def _numbers_of(path: Path, name: str) -> NDArray[Any]:
    """Read the numbers of a column of a Parquet file (T,)."""
    import pyarrow.parquet as pq

    with pq.ParquetFile(path) as file:
        column = file.read([name], use_threads=False).column(name).combine_chunks()
    # A copy: Arrow gives its memory to the next column, and not back to the system when a column is done with.
    return numbers(column).copy()


def _parquet_parts(file: Any) -> dict[str, TableColumn]:
    """Return the columns of a Parquet file by their names; those of lists by the length of the first one."""
    from pyarrow import types

    parts = dict[str, TableColumn]()
    for field in file.schema_arrow:
        is_list = types.is_list(field.type) or types.is_large_list(field.type) or types.is_fixed_size_list(field.type)
        if not is_list:
            parts[field.name] = TableColumn(field.name)
        elif is_numeric(field.type.value_type):
            first = next(file.iter_batches(batch_size=1, columns=[field.name]), None)
            width = len(first.column(0)[0].as_py() or ()) if first else 0
            if width <= MOST:
                parts |= {f"{field.name}.{k}": TableColumn(field.name, number=k) for k in range(width)}
    return parts


def _lists(path: Path, name: str, column: Any) -> NDArray[Any]:
    """Return the numbers of a column of lists (T, n), NaN where it has none."""
    import pyarrow.compute as pc

    column = column.combine_chunks()
    lengths = numbers(pc.list_value_length(column))
    is_there = np.isfinite(lengths)
    widths = np.unique(lengths[is_there]).astype(int)
    if len(widths) != 1:
        text = f"lists of {widths[0]} to {widths[-1]} numbers" if len(widths) else "no list"
        raise DataError(f"{path}: column {name!r} has {text}; accepted: lists of one length")
    values = np.full((len(lengths), widths[0]), np.nan)
    values[is_there] = numbers(pc.list_flatten(column)).reshape(-1, widths[0])
    return values


def array_names(path: Path) -> list[str]:
    """Return the columns of a file of arrays.

    Elements of arrays of structures in MATLAB's files, as Simulink stores signals, are NAME/0/FIELD, NAME/1/FIELD and
    so on, and those of cells NAME/0, NAME/1.

    An array of one axis is a column of its name, a path in HDF5; one of (samples, n), or (n, samples) as MATLAB stores
    it, is NAME.0 to NAME.n-1: its longest axis is that of the samples, and axes of one do not count. Fields of compound
    ones are NAME.FIELD.
    """
    with _arrays(path) as arrays:
        return list(_array_parts(arrays))


def array_columns(path: Path, wanted: Collection[str]) -> dict[str, LogColumn]:
    """Read columns of a file of arrays; an array is read once."""
    asked = dict[tuple[str, str | None], dict[str, int | None]]()
    log_columns = dict[str, LogColumn]()
    with _arrays(path) as arrays:
        parts = _array_parts(arrays)
        for name in wanted:
            if name in parts:
                part = parts[name]
                asked.setdefault((part.array, part.field), {})[name] = part.number
        for (array, field), columns in asked.items():
            check_memory(path, max(arrays[array].shape), len(columns))
            values = np.squeeze(np.asarray(arrays[array][() if field is None else field], dtype=np.float64))
            # MATLAB stores (n, samples): the longest axis is that of the samples.
            if values.ndim == 2 and values.shape[0] < values.shape[1]:
                values = values.T
            for name, k in columns.items():
                log_columns[name] = LogColumn(
                    np.atleast_1d(values) if k is None else np.ascontiguousarray(values[:, k])
                )
    return log_columns


@contextlib.contextmanager
def _arrays(path: Path) -> Iterator[Mapping[str, Any]]:
    """Open the arrays of a file by their names: NumPy's, MATLAB's, which are HDF5 from version 7.3 on, or HDF5."""
    if path.suffix.lower() == ".npz":
        with np.load(path, allow_pickle=False) as file:
            yield dict(file)
        return
    import h5py

    if path.suffix.lower() == ".mat" and not h5py.is_hdf5(path):
        yield _matlab_arrays(path)
        return
    arrays = dict[str, Any]()

    def visit(name: str, item: Any) -> None:
        if name.startswith(REFERENCED) or not isinstance(item, h5py.Dataset):
            return
        if item.external or item.is_virtual:  # any file of this machine could become a column of the recording
            raise DataError(f"{path}: {name!r} takes its numbers from other files; accepted: a file that holds all")
        if h5py.check_ref_dtype(item.dtype) is not h5py.Reference:
            arrays[name] = item
            return
        structure, _, field = name.rpartition("/")
        is_cell = item.attrs.get("MATLAB_class") == b"cell"
        for k, reference in enumerate(item[()].ravel()[:MOST]):
            element = f"{name}/{k}" if is_cell else f"{structure}/{k}/{field}"
            if reference:
                visit_element(element, file[reference])

    def visit_element(name: str, item: Any) -> None:
        if isinstance(item, h5py.Group):
            item.visititems(lambda below, part: visit(f"{name}/{below}", part))
        visit(name, item)

    with h5py.File(path, "r") as file:
        file.visititems(visit)
        yield arrays


def _matlab_arrays(path: Path) -> dict[str, NDArray[Any]]:
    """Return the arrays of a file of MATLAB of a version below 7.3.

    Raises:
        DataError: all that it holds are objects, such as a timeseries, of which MATLAB alone knows where numbers stand.
    """
    from scipy.io import loadmat
    from scipy.io.matlab import MatlabOpaque

    content = loadmat(path, simplify_cells=True)
    objects = [name for name, item in content.items() if isinstance(item, MatlabOpaque)]
    arrays = dict(_flat({name: content[name] for name in content if not name.startswith("__") and name not in objects}))
    if objects and not arrays:
        accepted = f"structures and arrays, such as `{STRUCTURE}`"
        raise DataError(f"{path}: holds objects, which MATLAB alone can read; accepted: {accepted}")
    return arrays


def _flat(content: Mapping[str, Any], above: str = "") -> Iterator[tuple[str, NDArray[Any]]]:
    """Yield the arrays of MATLAB's structures and cells, by their names with those of what holds them before them."""
    for name, item in content.items():
        is_array = isinstance(item, np.ndarray)
        if isinstance(item, dict):
            yield from _flat(item, f"{above}{name}/")
        elif isinstance(item, list) or (is_array and item.dtype == object):
            yield from _flat({str(k): element for k, element in enumerate(item[:MOST])}, f"{above}{name}/")
        elif is_array:
            yield above + name, item


def _array_parts(arrays: Mapping[str, Any]) -> dict[str, TableColumn]:
    """Return the columns of arrays by their names."""
    parts = dict[str, TableColumn]()
    for array, item in arrays.items():
        for field in item.dtype.names or [None]:
            kind = item.dtype if field is None else item.dtype[field]
            base, inner = kind.subdtype or (kind, ())
            axes = [size for size in (*item.shape, *inner) if size != 1]
            name = array if field is None else f"{array}.{field}"
            # Two long axes are those of a picture or a map, and no signal.
            if base.kind not in "fiub" or len(axes) > 2 or (len(axes) == 2 and min(axes) > MOST):
                continue
            if len(axes) < 2:
                parts[name] = TableColumn(array, field)
            else:
                parts |= {f"{name}.{k}": TableColumn(array, field, k) for k in range(min(axes))}
    return parts
