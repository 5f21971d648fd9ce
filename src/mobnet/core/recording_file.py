"""The files of a recording: one array of all its fields."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import recording_columns
from mobnet.core.joints import JointLayout
from mobnet.core.notes import read_array_note
from mobnet.core.recording import Recording, Sensed, SensedRecording, Truth
from mobnet.core.store import NOTE, file_of, read_array, read_pieces, spans_and_rate, write_array


def write_recording(stem: Path, recording: Recording, layout: JointLayout) -> None:
    """Write a recording as one array of all fields, (T, C)."""
    columns = recording_columns(layout)
    fields = {**vars(recording.sensed), **vars(recording.truth)}
    parts = [fields[name] for name in columns]
    flat = list(chain.from_iterable(columns.values()))
    meta = {"rate_hz": recording.rate_hz, **recording.meta}
    write_array(stem, np.concatenate(parts, axis=1), flat, meta, recording.segments)


def read_sensed(stem: Path, layout: JointLayout) -> SensedRecording:
    """Read the sensed signals of a recording, float32, and not its truth: an estimator gets no more.

    Columns are found by name, so a robot's log may have others too and in any order.

    Raises:
        DataError: a file is missing or damaged, or a column is missing.
    """
    values, meta = _read_fields(stem, layout, list(Sensed.__dataclass_fields__))
    return SensedRecording(Sensed(**values), *spans_and_rate(meta), meta)


def read_recording(stem: Path, layout: JointLayout) -> Recording:
    """Read a recording, sensed and truth, float32, as `read_sensed` does."""
    values, meta = _read_fields(stem, layout, [*Sensed.__dataclass_fields__, *Truth.__dataclass_fields__])
    sensed = {name: values[name] for name in Sensed.__dataclass_fields__}
    truth = {name: values[name] for name in Truth.__dataclass_fields__}
    return Recording(Sensed(**sensed), *spans_and_rate(meta), meta, Truth(**truth))


def read_blocks(
    stem: Path, layout: JointLayout, fields: Sequence[str], rows: int
) -> Iterator[tuple[int, dict[str, NDArray[np.float32]]]]:
    """Yield the first row and some fields (n, C), float32, of each block of so many rows, in the memory of a minute.

    The arrays are the reader's. Nothing read before the end may be used: faults are told there.

    Raises:
        DataError: as `read_sensed`.
    """
    names, ends = _names_of(layout, fields)
    for first, piece in read_pieces(stem, read_array_note(file_of(stem, NOTE)), names, layout):
        for start in range(0, piece.shape[1], rows):
            block = np.ascontiguousarray(piece[:, start : start + rows].T)
            yield first + start, dict(zip(fields, np.split(block, ends[:-1], axis=1), strict=True))


def _read_fields(
    stem: Path, layout: JointLayout, fields: Sequence[str]
) -> tuple[dict[str, NDArray[np.float32]], dict[str, Any]]:
    """Return fields of a recording, each (T, C) and a view of one array, and the file's description."""
    names, ends = _names_of(layout, fields)
    array, meta = read_array(stem, names, layout)
    return dict(zip(fields, np.split(array, ends[:-1], axis=1), strict=True)), meta


def _names_of(layout: JointLayout, fields: Sequence[str]) -> tuple[list[str], list[int]]:
    """Return the names of the columns of fields, one field after another, and where each field ends."""
    columns = recording_columns(layout)
    names = list[str]()
    ends = list[int]()
    for field in fields:
        names += [name for name, _, _ in columns[field]]
        ends.append(len(names))
    return names, ends
