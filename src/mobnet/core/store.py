"""The only reader and writer of result files: atomic, described, checked.

An array is two files: `NAME.npy`, float32, one row a sample, and `NAME.json`, its columns (name, unit, frame), row
count, segments and provenance. The JSON is written last, so a pair with a JSON is whole.
"""

from __future__ import annotations

import contextlib
import json
import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Column, Recording, Sensed, Truth, recording_columns

CHECKED_ROWS = 1 << 16  # rows looked at together when searching for NaN: bounds memory on hour-long files


@contextlib.contextmanager
def atomic_path(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside `path`; on success it is synced to disk and takes its place, else it goes."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=path.suffix, dir=path.parent)
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        temporary.chmod(0o644)
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def write_text(path: Path, text: str) -> None:
    """Write a text file atomically."""
    with atomic_path(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def write_json(path: Path, value: Mapping[str, Any]) -> None:
    """Write a JSON file atomically, keys in the order given."""
    write_text(path, json.dumps(value, indent=1) + "\n")


def read_json(path: Path) -> dict[str, Any]:
    """Read a JSON object.

    Raises:
        DataError: the file is missing or is not JSON.
    """
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise DataError(f"{path}: file is missing") from None
    except json.JSONDecodeError as error:
        raise DataError(f"{path}: not JSON, {error}") from None


def write_array(
    stem: Path,
    array: NDArray[Any],
    columns: Sequence[Column],
    meta: Mapping[str, Any],
    segments: Sequence[tuple[int, int]] | None = None,
) -> None:
    """Write `stem.npy` (float32) and then `stem.json`.

    Args:
        stem: path without a suffix.
        array: samples (T, C).
        columns: name, unit and frame of each column, (C,).
        meta: what else to note; must hold `rate_hz` [Hz].
        segments: contiguous stretches (start, end) of rows; one stretch when not given.

    Raises:
        DataError: the shape does not fit the columns, or a value is not finite.
    """
    if array.ndim != 2 or array.shape[1] != len(columns):
        raise DataError(f"{stem}: array of shape {array.shape}, but {len(columns)} columns are named")
    check_finite(f"{stem}.npy", array, columns)
    stem.with_suffix(".json").unlink(missing_ok=True)
    with atomic_path(stem.with_suffix(".npy")) as temporary:
        np.save(temporary, np.ascontiguousarray(array, dtype=np.float32))
    described = [dict(zip(("name", "unit", "frame"), column, strict=True)) for column in columns]
    spans = [list(span) for span in (segments or [(0, len(array))])]
    write_json(stem.with_suffix(".json"), {"rows": len(array), "segments": spans, **meta, "columns": described})


def read_array(stem: Path) -> tuple[NDArray[np.float32], dict[str, Any]]:
    """Read an array written by `write_array`, memory-mapped, and its description.

    Raises:
        DataError: a file is missing, truncated, holds NaN, or the two do not agree.
    """
    meta = read_json(stem.with_suffix(".json"))
    path = stem.with_suffix(".npy")
    try:
        array = np.load(path, mmap_mode="r", allow_pickle=False)
    except FileNotFoundError:
        raise DataError(f"{path}: file is missing") from None
    except (ValueError, EOFError) as error:
        raise DataError(f"{path}: truncated or damaged ({error})") from None
    expected = (meta["rows"], len(meta["columns"]))
    if array.shape != expected:
        raise DataError(f"{path}: shape {array.shape}, but {stem.name}.json says {expected}")
    check_finite(str(path), array, [(c["name"], c["unit"], c["frame"]) for c in meta["columns"]])
    return array, meta


def check_finite(name: str, array: NDArray[Any], columns: Sequence[Column]) -> None:
    """Raise a DataError that names row and column if an array (T, C) holds NaN or infinity."""
    for start in range(0, len(array), CHECKED_ROWS):
        bad = np.argwhere(~np.isfinite(array[start : start + CHECKED_ROWS]))
        if len(bad):
            row, column = bad[0]
            value = array[start + row, column]
            raise DataError(
                f"{name}: column {columns[column][0]!r}, row {start + row}: {value} (accepted: finite numbers)"
            )


def write_recording(stem: Path, recording: Recording, layout: JointLayout) -> None:
    """Write a recording as one array of all fields, (T, C)."""
    columns = recording_columns(layout)
    fields = {**vars(recording.sensed), **vars(recording.truth)}
    parts = [fields[name] for name in columns]
    flat = [column for group in columns.values() for column in group]
    meta = {"rate_hz": recording.rate_hz, **recording.meta}
    write_array(stem, np.concatenate(parts, axis=1), flat, meta, recording.segments)


def read_recording(stem: Path, layout: JointLayout) -> Recording:
    """Read a recording; arrays are float32 views of the memory-mapped file.

    Columns are found by name, so a robot's log may hold others too and in any order.

    Raises:
        DataError: a file is missing or damaged, or a column is missing.
    """
    array, meta = read_array(stem)
    where = {column["name"]: i for i, column in enumerate(meta["columns"])}
    values: dict[str, NDArray[Any]] = {}
    for field, columns in recording_columns(layout).items():
        missing = [name for name, _, _ in columns if name not in where]
        if missing:
            raise DataError(
                f"{stem}.json: column {missing[0]!r} is missing; it holds {len(where)} columns: "
                f"{', '.join(list(where)[:3])}, ..."
            )
        values[field] = _select(array, [where[name] for name, _, _ in columns])
    sensed = {name: values[name] for name in Sensed.__dataclass_fields__}
    truth = {name: values[name] for name in Truth.__dataclass_fields__}
    segments = tuple((int(start), int(end)) for start, end in meta["segments"])
    return Recording(Sensed(**sensed), Truth(**truth), segments, float(meta["rate_hz"]), meta)


def _select(array: NDArray[Any], columns: list[int]) -> NDArray[Any]:
    """Return columns of an array, as a view where they are contiguous."""
    first, last = columns[0], columns[-1]
    return array[:, first : last + 1] if columns == list(range(first, last + 1)) else array[:, columns]
