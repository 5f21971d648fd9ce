"""Writing and reading arrays; nothing else does so.

An array is two files: `NAME.parquet`, float32, one row for each sample, with unit and frame of each column, and
`NAME.json` with its columns, row count, segments and provenance. The JSON file is written last, so an array that has
one is complete.
"""

import contextlib
import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from mobnet.core.columns import Column
from mobnet.core.errors import DataError
from mobnet.core.files import atomic_path, read_json, write_json

ARRAY, NOTE = ".parquet", ".json"
# Note 0010 has the measurements behind these numbers.
GROUP_ROWS = 60_000  # rows stored together, a minute at 1 kHz: writer and reader hold as many besides their result
BLOCK_ROWS = 256  # rows transposed together: they fit into the processor's cache
CODING = {
    "compression": "lz4",
    "use_byte_stream_split": True,
    "use_dictionary": False,
    "write_statistics": False,
    "write_page_checksum": True,
}


class ArrayWriter:
    """Writes an array row by row; `array_writer` makes one."""

    def __init__(self, stem: Path, columns: Sequence[Column], file: pq.ParquetWriter, descriptor: int) -> None:
        """Write columns (C,) into an open file, which also has a descriptor of the operating system."""
        self.rows = 0
        self._stem, self._columns, self._file, self._descriptor = stem, columns, file, descriptor
        self._names = [name for name, _, _ in columns]
        self._note: dict[str, Any] = {}
        self._group = np.empty((len(columns), GROUP_ROWS), dtype=np.float32)

    def append(self, rows: NDArray[Any]) -> None:
        """Add samples (n, C), stored as float32; n is any number.

        Raises:
            DataError: the shape does not fit the columns, or a value is not finite.
        """
        if rows.ndim != 2 or rows.shape[1] != len(self._columns):
            raise DataError(f"{self._stem}: array of shape {rows.shape}, but {len(self._columns)} columns are named")
        done = 0
        while done < len(rows):
            filled = self.rows % GROUP_ROWS
            with np.errstate(over="ignore"):  # what float32 cannot hold becomes infinite and is refused
                block = rows[done : done + min(BLOCK_ROWS, GROUP_ROWS - filled)].astype(np.float32, copy=False)
            check_finite(f"{self._stem}{ARRAY}", block, self._names, self.rows)
            self._group[:, filled : filled + len(block)] = block.T
            done += len(block)
            self.rows += len(block)
            if self.rows % GROUP_ROWS == 0:
                self._store(GROUP_ROWS)

    def close(self, meta: Mapping[str, object], segments: Sequence[tuple[int, int]] | None = None) -> None:
        """Describe the rows, of which no more follow; the files appear when the writer's block ends.

        The note must hold `rate_hz` [Hz]; segments are contiguous stretches (start, end) of rows, one when not given.
        """
        described = [dict(zip(("name", "unit", "frame"), column, strict=True)) for column in self._columns]
        spans = [list(span) for span in (segments or [(0, self.rows)])]
        self._note = {"rows": self.rows, "segments": spans, **meta, "columns": described}

    def finish(self) -> dict[str, Any]:
        """Store the remaining rows and return the description; `array_writer` calls this at its end.

        Raises:
            DataError: rows were never described, or more came after that.
        """
        if self._note.get("rows") != self.rows:
            raise DataError(f"{self._stem}{ARRAY}: close(meta, segments) must follow the last of its {self.rows} rows")
        self._store(self.rows % GROUP_ROWS)
        return self._note

    def _store(self, count: int) -> None:
        """Store the first `count` rows of the present group as a row group."""
        if count:
            columns = [pa.array(column[:count]) for column in self._group]
            self._file.write_batch(pa.RecordBatch.from_arrays(columns, schema=self._file.schema), GROUP_ROWS)
            # to disk at once, and out of the page cache: new pages of memory would take more time than the encoding
            os.posix_fadvise(self._descriptor, 0, 0, os.POSIX_FADV_DONTNEED)


@contextlib.contextmanager
def array_writer(stem: Path, columns: Sequence[Column]) -> Iterator[ArrayWriter]:
    """Write `stem.parquet` and then `stem.json` piece by piece, in the memory of a minute of samples.

    Both appear when the block ends, if `close` was called and nothing was raised; else what was there before stays. The
    columns (C,) have name, unit and frame.

    Raises:
        DataError: the block ended without `close`.
    """
    described = [pa.field(n, pa.float32(), nullable=False, metadata={"unit": u, "frame": f}) for n, u, f in columns]
    with atomic_path(stem.with_suffix(ARRAY)) as temporary:
        with temporary.open("wb") as raw, pq.ParquetWriter(raw, pa.schema(described), **CODING) as file:
            writer = ArrayWriter(stem, columns, file, raw.fileno())
            yield writer
            note = writer.finish()
        stem.with_suffix(NOTE).unlink(missing_ok=True)
    write_json(stem.with_suffix(NOTE), note)


def write_array(
    stem: Path,
    array: NDArray[Any],
    columns: Sequence[Column],
    meta: Mapping[str, object],
    segments: Sequence[tuple[int, int]] | None = None,
) -> None:
    """Write samples (T, C) as `stem.parquet`, float32, and then `stem.json`, described as `ArrayWriter.close` says.

    Raises:
        DataError: the shape does not fit the columns, or a value is not finite.
    """
    with array_writer(stem, columns) as writer:
        writer.append(array)
        writer.close(meta, segments)


def read_array(stem: Path, names: Sequence[str] | None = None) -> tuple[NDArray[np.float32], dict[str, Any]]:
    """Return samples (T, C) of an array, contiguous, and the description of the whole file.

    Of the columns only the wanted ones are read, in the order of their names; all when none are given.

    Raises:
        DataError: a file is missing, truncated, holds NaN, lacks a column, or the two do not agree.
    """
    meta = read_json(stem.with_suffix(NOTE))
    path = stem.with_suffix(ARRAY)
    try:
        with pq.ParquetFile(path, page_checksum_verification=True) as file:
            wanted = _agreed_names(stem, file, meta, names)
            return _read_columns(path, file, wanted), meta
    except FileNotFoundError:
        raise DataError(f"{path}: file is missing") from None
    except (pa.ArrowException, OSError) as error:
        raise DataError(f"{path}: truncated or damaged ({' '.join(str(error).split())})") from None


def _agreed_names(
    stem: Path, file: pq.ParquetFile, meta: Mapping[str, Any], names: Sequence[str] | None
) -> Sequence[str]:
    """Return the columns to read, after checking that the file has them and agrees with its description."""
    held, noted = file.schema_arrow.names, [column["name"] for column in meta["columns"]]
    shape, noted_shape = (file.metadata.num_rows, len(held)), (meta["rows"], len(noted))
    if shape != noted_shape:
        raise DataError(f"{stem}{ARRAY}: shape {shape}, but {stem.name}{NOTE} says {noted_shape}")
    for found, expected in zip(held, noted, strict=True):
        if found != expected:
            raise DataError(f"{stem}{ARRAY}: column {found!r}, but {stem.name}{NOTE} says {expected!r}")
    for name in names or ():
        if name not in held:
            raise DataError(
                f"{stem}{ARRAY}: column {name!r} is missing; it holds {len(held)} columns: {', '.join(held[:3])}, ..."
            )
    return held if names is None else names


def _read_columns(path: Path, file: pq.ParquetFile, names: Sequence[str]) -> NDArray[np.float32]:
    """Return columns of an open file, (T, C)."""
    array = np.empty((file.metadata.num_rows, len(names)), dtype=np.float32)
    start = 0
    for group in range(file.num_row_groups):
        table = file.read_row_group(group, columns=list(names), use_threads=False)
        columns = np.empty((len(names), table.num_rows), dtype=np.float32)
        with np.errstate(over="ignore"):  # a foreign file may hold more than float32 can; infinite is refused below
            for column, name in zip(columns, names, strict=True):
                column[:] = table.column(name)
        rows = array[start : start + table.num_rows]
        for first in range(0, len(rows), BLOCK_ROWS):
            rows[first : first + BLOCK_ROWS] = columns[:, first : first + BLOCK_ROWS].T
        check_finite(str(path), rows, names, start)
        start += len(rows)
    return array


def check_finite(name: str, rows: NDArray[Any], names: Sequence[str], first: int = 0) -> None:
    """Raise a DataError that names row and column if samples (n, C), of which `first` is the first, are not finite."""
    finite = np.isfinite(rows)
    if not finite.all():
        row, column = np.argwhere(~finite)[0]
        raise DataError(
            f"{name}: column {names[column]!r}, row {first + row}: {rows[row, column]} (accepted: finite numbers)"
        )


def spans_and_rate(meta: Mapping[str, Any]) -> tuple[tuple[tuple[int, int], ...], float]:
    """Return segments, (start, end) each, and rate [Hz] of an array's description."""
    return tuple((int(start), int(end)) for start, end in meta["segments"]), float(meta["rate_hz"])
