"""Writing and reading arrays; nothing else does so.

An array is two files: `NAME.parquet`, float32, one row for each sample, with unit and frame of each column, and
`NAME.json` with its columns, row count, segments and provenance. The JSON file is written last, so an array that has
one is complete. It also has a hash of the other file's footer, by which the array of another recording is noticed.
"""

import contextlib
import hashlib
import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from mobnet.core.code import SHORT
from mobnet.core.columns import EXTERNAL_LP, LABEL_LP, Column
from mobnet.core.contract import Values, column_faults
from mobnet.core.errors import DataError, not_accepted, refuse, refuse_lines
from mobnet.core.files import atomic_path, check_regular, write_json
from mobnet.core.joints import JointLayout
from mobnet.core.motion import MotionCheck
from mobnet.core.notes import check_array_note, pair_differences, read_array_note

ARRAY = ".parquet"
NOTE = ".json"
# docs/notes/workflow.md has the measurements behind these numbers.
GROUP_ROWS = 60_000  # rows stored together, a minute at 1 kHz: writer and reader hold as many besides their result
BLOCK_ROWS = 256  # rows transposed together: they fit into the processor's cache
STREAMED = {"buffer_size": 2**16, "pre_buffer": False}  # a foreign file may be a single group of rows
MAGIC = b"PAR1"  # first and last bytes of a Parquet file
FLOATS = (pa.float32(), pa.float64())  # types of columns
CODING = {
    "compression": "lz4",
    "use_byte_stream_split": True,
    "use_dictionary": False,
    "write_statistics": False,
    "write_page_checksum": True,
}


def file_of(stem: Path, ending: str) -> Path:
    """Return one of the two files of an array; a stem may have dots."""
    return stem.with_name(stem.name + ending)


def files_of(stem: Path) -> tuple[Path, Path]:
    """Return both files of an array, the one that is written last at the end."""
    return file_of(stem, ARRAY), file_of(stem, NOTE)


class ArrayWriter:
    """Writes an array row by row; `array_writer` makes one."""

    def __init__(self, stem: Path, columns: Sequence[Column], file: pq.ParquetWriter, descriptor: int) -> None:
        """Write columns (C,) into an open file, which also has a descriptor of the operating system."""
        self.rows = 0
        self._stem = stem
        self._columns = columns
        self._file = file
        self._descriptor = descriptor
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

        Raises:
            DataError: there is no row, or the note is not accepted.
        """
        described = [dict(zip(("name", "unit", "frame"), column, strict=True)) for column in self._columns]
        spans = [list(span) for span in (segments or [(0, self.rows)])]
        note = {"rows": self.rows, "segments": spans, **meta, "columns": described}
        check_array_note(file_of(self._stem, NOTE), note)
        self._note = note

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
            # pa.array would import pandas, which takes about a second of each job.
            columns = [pa.Array.from_buffers(pa.float32(), count, [None, pa.py_buffer(row)]) for row in self._group]
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
    with atomic_path(file_of(stem, ARRAY)) as temporary:
        with temporary.open("wb") as raw, pq.ParquetWriter(raw, pa.schema(described), **CODING) as file:
            writer = ArrayWriter(stem, columns, file, raw.fileno())
            yield writer
            note = writer.finish()
        note["footer"] = footer_hash(temporary)
        file_of(stem, NOTE).unlink(missing_ok=True)
    write_json(file_of(stem, NOTE), note)


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


def read_array(
    stem: Path, names: Sequence[str] | None = None, layout: JointLayout | None = None
) -> tuple[NDArray[np.float32], dict[str, Any]]:
    """Return samples (T, C) of an array, contiguous, and the description of the whole file.

    Of the columns only the wanted ones are read, in the order of their names; all when none are given. Numbers, units
    and frames are compared with `mobnet.core.contract`; with a layout, also with what the robot's joints can do.

    Raises:
        DataError: a file is missing, damaged or not accepted, lacks a column, or the two do not agree; all faults of a
            kind are told, one line each.
    """
    note = read_array_note(file_of(stem, NOTE))
    wanted = [column["name"] for column in note["columns"]] if names is None else list(names)
    array = np.empty((0, 0), dtype=np.float32)
    for first, columns in read_pieces(stem, note, wanted, layout):
        if not first:
            array = np.empty((note["rows"], len(wanted)), dtype=np.float32)
        rows = array[first : first + columns.shape[1]]
        for start in range(0, len(rows), BLOCK_ROWS):
            rows[start : start + BLOCK_ROWS] = columns[:, start : start + BLOCK_ROWS].T
    return array, note


def read_pieces(
    stem: Path, note: Mapping[str, Any], names: Sequence[str], layout: JointLayout | None = None
) -> Iterator[tuple[int, NDArray[np.float32]]]:
    """Yield the number of the first row and the columns (C, n) of each piece of an array, in the memory of one.

    A piece is overwritten by the next one. Nothing read before the end may be used: faults are told there.

    Raises:
        DataError: as `read_array`.
    """
    path = file_of(stem, ARRAY)
    check_regular(path)
    whole = sum(end - start for start, end in note["segments"]) == note["rows"]
    values = Values(names, layout, whole)
    motion = MotionCheck(names, note["segments"], note["rate_hz"])
    try:
        with pq.ParquetFile(path, page_checksum_verification=True, **STREAMED) as file:
            faults = [f"{stem}{NOTE}: {fault}" for fault in column_faults(note["columns"], layout)]
            refuse_lines(faults + [f"{path}: {fault}" for fault in _disagreements(file, stem, note, names)])
            for first, columns in _pieces(file, names):
                values.look(first, columns)
                motion.look(first, columns)
                yield first, columns
    except FileNotFoundError:
        raise DataError(f"{path}: file is missing; accepted: a Parquet file") from None
    except (pa.ArrowException, OSError, ValueError, MemoryError) as error:
        text = f"truncated or damaged ({' '.join(str(error).split())}); accepted: a whole Parquet file"
        raise DataError(f"{path}: {text}") from None
    refuse(path, [*values.faults(), *motion.faults()])
    _check_footer(stem, note)


def _pieces(file: pq.ParquetFile, names: Sequence[str]) -> Iterator[tuple[int, NDArray[np.float32]]]:
    """Yield the pieces of an open file: the first row, and columns (C, n), each overwritten by the next one."""
    first = 0
    rows = file.metadata.num_rows
    piece = np.empty((len(names), min(rows, GROUP_ROWS)), dtype=np.float32)
    for batch in file.iter_batches(GROUP_ROWS, columns=list(names), use_threads=False):
        columns = piece[:, : batch.num_rows]
        with np.errstate(over="ignore"):  # a foreign file may hold more than float32 can; infinite is refused
            for column, name in zip(columns, names, strict=True):
                column[:] = _numbers(batch.column(name))
        yield first, columns
        first += batch.num_rows
    if first != rows:
        raise ValueError(f"{first} of {rows} rows")


def _numbers(column: Any) -> NDArray[Any]:
    """Return a column as NumPy's array, NaN where it has no number.

    Arrow's own conversion imports pandas, about a second of each job.
    """
    return np.from_dlpack(column.fill_null(np.nan) if column.null_count else column)


def footer_hash(path: Path) -> str:
    """Return a short hash of a Parquet file's footer, in which sizes and places of all columns stand.

    Raises:
        DataError: the file does not begin and end as Parquet does.
    """
    with path.open("rb") as file:
        size = os.fstat(file.fileno()).st_size
        head = file.read(len(MAGIC))
        tail = os.pread(file.fileno(), 2 * len(MAGIC), max(size - 2 * len(MAGIC), 0))
        if head != MAGIC or tail[-len(MAGIC) :] != MAGIC:
            raise DataError(f"{path}: {not_accepted('first and last bytes', (head, tail[-len(MAGIC) :]), [MAGIC])}")
        length = int.from_bytes(tail[: len(MAGIC)], "little") + len(tail)
        return hashlib.sha256(os.pread(file.fileno(), length, max(size - length, 0))).hexdigest()[:SHORT]


def _check_footer(stem: Path, note: Mapping[str, Any]) -> None:
    """Raise a DataError if an array is not the one that its note was written for, where the note says which."""
    path = file_of(stem, ARRAY)
    footer = footer_hash(path)
    if note.get("footer", footer) != footer:
        accepted = [f"{note['footer']}, as {stem.name}{NOTE} says: the array that was written with it"]
        raise DataError(f"{path}: {not_accepted('hash of the footer', footer, accepted)}")


def _disagreements(file: pq.ParquetFile, stem: Path, note: Mapping[str, Any], names: Sequence[str]) -> Iterator[str]:
    """Yield where a file's columns are not what its note says, or lack what its reader expects."""
    schema = file.schema_arrow
    stored_names = file.schema_arrow.names
    shape = (file.metadata.num_rows, len(stored_names))
    noted_shape = (note["rows"], len(note["columns"]))
    if shape != noted_shape:
        apart = sorted(set(stored_names) ^ {column["name"] for column in note["columns"]})
        named = f" (columns of one alone: {', '.join(apart[:3])})" if apart else ""
        yield f"shape {shape}{named} is not accepted; accepted: {noted_shape}, as {stem.name}{NOTE} says"
        return
    described = {column["name"]: column for column in note["columns"]}
    if others := set(stored_names) - described.keys():
        known = [f"those that {stem.name}{NOTE} has", *described.keys() - set(stored_names)]
        yield from (not_accepted("column", name, known) for name in sorted(others))
        return
    for stored in schema:
        column = described[stored.name]
        if stored.type not in FLOATS:
            yield not_accepted(f"column {stored.name!r}: type", str(stored.type), map(str, FLOATS))
        for key in ("unit", "frame"):
            value = (stored.metadata or {}).get(key.encode(), column[key].encode()).decode(errors="replace")
            if value != column[key]:
                yield not_accepted(f"column {stored.name!r}: {key}", value, [f"{column[key]!r}, as its note says"])
    for name in names:
        if name not in stored_names:
            first = ", ".join(stored_names[:3])
            yield f"column {name!r} is missing; accepted: it, beside {len(stored_names)} others: {first}, ..."


def check_finite(name: str, rows: NDArray[Any], names: Sequence[str], first: int = 0) -> None:
    """Raise a DataError that names row and column if samples (n, C), of which `first` is the first, are not finite."""
    finite = np.isfinite(rows)
    if not finite.all():
        row, column = np.argwhere(~finite)[0]
        where = f"{name}: column {names[column]!r}, row {first + row}"
        raise DataError(not_accepted(where, float(rows[row, column]), ["finite numbers"]))


def spans_and_rate(meta: Mapping[str, Any]) -> tuple[tuple[tuple[int, int], ...], float]:
    """Return segments, (start, end) each, and rate [Hz] of an array's description."""
    return tuple((int(start), int(end)) for start, end in meta["segments"]), float(meta["rate_hz"])


def label_of(residual: Path) -> str:
    """Return the signal of a residual file that methods learn as external torque: that of foot sensors if it has one.

    Raises:
        DataError: the file's description is missing or damaged.
    """
    columns = read_array_note(file_of(residual, NOTE))["columns"]
    return LABEL_LP if any(column["name"].startswith(f"{LABEL_LP}.") for column in columns) else EXTERNAL_LP


def check_pair(recording: Path, residual: Path) -> None:
    """Raise a DataError that says in what a residual is not of its recording, one line for each difference."""
    note, other = (read_array_note(file_of(stem, NOTE)) for stem in (residual, recording))
    refuse(f"{residual}{NOTE}", pair_differences(note, other, f"{recording}{NOTE}, its recording"))


def check_rate(stem: Path, rate_hz: float | None) -> None:
    """Raise a DataError unless an array is sampled at a rate [Hz], that of the configuration, if one is given."""
    noted_hz = read_array_note(file_of(stem, NOTE))["rate_hz"]
    if rate_hz is not None and noted_hz != rate_hz:
        raise DataError(f"{stem}{NOTE}: {not_accepted('rate_hz', noted_hz, [f'{rate_hz:g}, `rates.data_hz`'])}")
