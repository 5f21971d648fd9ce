"""Columns of a log, and what their readers share."""

import os
import resource
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError

MOST = 1000  # entries of an array above which it is a picture or a map, and no signal
GIB = 2**30


@dataclass(frozen=True)
class LogColumn:
    """One column of a log.

    Attributes:
        values: numbers (T,) in the log's own unit, or a function that reads them: all columns of a file may be larger
            than the memory.
        time_s: in logs of messages, the time of each (T,) [s] since the log began: the stamp of its header, or, where
            it has none or all are zero, that at which it was recorded.
        recorded_s: in logs of messages, the times at which they were recorded (T,) [s] since the log began.
        topic: of the messages.
        is_stamped: whether `time_s` are stamps of headers; None where messages have no header.
        hint: what its reader left out of the file, if anything.
        found: what it holds where that is no numbers.
    """

    values: NDArray[Any] | Callable[[], NDArray[Any]]
    time_s: Array | None = None
    recorded_s: Array | None = None
    topic: str = ""
    is_stamped: bool | None = None
    hint: str = ""
    found: str = ""

    def numbers(self) -> NDArray[Any]:
        """Return the numbers (T,) in the log's own unit, read anew each time where `values` is a function."""
        return self.values() if callable(self.values) else self.values


Columns = Mapping[str, LogColumn]


def check_memory(path: Path, rows: int, columns: int) -> None:
    """Raise a DataError where columns of a log do not fit into the memory of this machine, or of the process."""
    needed = 8 * rows * columns
    limits = [os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"), resource.getrlimit(resource.RLIMIT_AS)[0]]
    most = min(limit for limit in limits if limit != resource.RLIM_INFINITY)
    if needed > most:
        text = f"{rows} rows x {columns} columns x 8 B are {needed / GIB:.1f} GiB, and the memory has {most / GIB:.1f}"
        raise DataError(f"{path}: {text}; accepted: a log that fits, such as a part of it")
