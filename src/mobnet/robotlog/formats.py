"""Reading a log as columns of numbers, whatever its format.

A format is two functions: one names the columns that a log holds and reads next to nothing, the other reads those that
are wanted.
"""

from collections.abc import Callable, Collection, Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from numpy.typing import NDArray

from mobnet.core.errors import DataError, not_accepted
from mobnet.core.files import check_regular
from mobnet.robotlog.columns import Columns, LogColumn
from mobnet.robotlog.delimited import PACKED, csv_columns, csv_names
from mobnet.robotlog.messages import message_columns, message_names
from mobnet.robotlog.piped import NAME, is_piped
from mobnet.robotlog.sources import FILES, METADATA
from mobnet.robotlog.tables import array_columns, array_names, parquet_columns, parquet_names

MENDED = {".bag": ", such as `rosbag reindex` makes of one that was not closed"}  # what makes a cut file whole
Found = TypeVar("Found")


class Format(NamedTuple):
    """How a kind of log is read: the names of its columns, and the columns of some names."""

    names: Callable[[Path], list[str]]
    read: Callable[[Path, Collection[str]], dict[str, LogColumn]]


TEXTS = dict.fromkeys((".csv", ".tsv", ".txt", ".dat", ".log", ".lvm"), Format(csv_names, csv_columns))
TABLES = {**TEXTS, ".parquet": Format(parquet_names, parquet_columns)}
ARRAYS = dict.fromkeys((".h5", ".hdf5", ".mat", ".npz"), Format(array_names, array_columns))
BAGS = dict.fromkeys((".mcap", ".bag", ".db3", ".active", METADATA), Format(message_names, message_columns))
FORMATS: Mapping[str, Format] = {**TABLES, **ARRAYS, **BAGS}
ACCEPTED = (
    *(kind for kind in FORMATS if kind not in (METADATA, ".active")),
    f"texts packed as .csv{PACKED}",
    "a folder of `ros2 bag`",
)


def format_of(path: Path) -> str:
    """Return the ending in `FORMATS` that a log has; that of a text that is packed stands before the last one."""
    if path.is_dir():
        return METADATA
    ending = path.suffix.lower()
    inner = path.with_suffix("").suffix.lower()
    return inner if ending == PACKED and inner in TEXTS else ending


def stem_of(path: Path) -> str:
    """Return the name of a log without its ending, or both endings of a text that is packed; a pipe has none."""
    if is_piped(path):
        return NAME
    return path.with_suffix("").stem if format_of(path) in TEXTS and path.suffix.lower() == PACKED else path.stem


def column_names(path: Path) -> list[str]:
    """Return the names of all columns of a log; of messages those in the first ones of each topic.

    Raises:
        DataError: the format is not known, or the file is missing or damaged.
    """
    names = _asked(path, lambda kind: kind.names(path))
    if not names:
        raise DataError(f"{path}: holds no column of numbers; accepted: at least positions, velocities and torques")
    return names


def read_log(path: Path, wanted: Collection[str] | None = None) -> Columns:
    """Read columns of numbers of a log: the wanted ones, or all of them, texts left out.

    Raises:
        DataError: as `column_names`, or a wanted column is missing or holds no numbers.
    """
    names = column_names(path) if wanted is None else list(wanted)
    columns = _asked(path, lambda kind: kind.read(path, names))
    if wanted is not None and (missing := [name for name in wanted if name not in columns]):
        raise DataError(f"{path}: {not_accepted('column', missing[0], columns)}")
    texts = {name: column.found for name, column in columns.items() if column.found}
    if texts and wanted is not None:
        name, text = next(iter(texts.items()))
        accepted = "numbers, dates as 2026-05-03T12:00:00.5, or durations of Parquet"
        raise DataError(f"{path}: column {name!r} holds {text}; accepted: {accepted}")
    columns = {name: column for name, column in columns.items() if not column.found}
    if not columns:
        raise DataError(f"{path}: holds no column of numbers; accepted: at least positions, velocities and torques")
    for name, column in columns.items():
        if callable(column.values):
            columns[name] = replace(column, values=partial(_numbers, path, column))
    return columns


def _numbers(path: Path, column: LogColumn) -> NDArray[Any]:
    """Read the numbers of a column; whatever goes wrong is one line."""
    return _asked(path, lambda _: column.numbers())


def _asked(path: Path, ask: Callable[[Format], Found]) -> Found:
    """Return what a question to the format of a log finds; whatever goes wrong is one line."""
    if not path.is_dir():
        check_regular(path)
    if not path.exists():
        raise DataError(f"{path}: file is missing; accepted: a log, {', '.join(ACCEPTED)}")
    kind = format_of(path)
    if path.is_dir() and not any(file.name == METADATA or file.suffix in FILES for file in path.iterdir()):
        raise DataError(f"{path}: a folder without {METADATA} is not accepted; accepted: {', '.join(ACCEPTED)}")
    if kind == PACKED:
        accepted = f"a text packed as .csv{PACKED}; unpack other formats first"
        raise DataError(f"{path}: its name does not say which format is packed; accepted: {accepted}")
    if kind not in FORMATS:
        raise DataError(not_accepted(f"{path}: format", kind or path.name, [", ".join(ACCEPTED)]))
    try:
        return ask(FORMATS[kind])
    except (DataError, MemoryError):
        raise
    except Exception as error:  # five libraries, each with errors of its own for a damaged file
        text = " ".join(str(error).split()) or type(error).__name__
        accepted = f"a whole file{MENDED.get(kind, '')}"
        packed = PACKED if path.suffix.lower() == PACKED else ""
        raise DataError(f"{path}: cannot be read as {kind}{packed}: {text}; accepted: {accepted}") from error
