"""Logs that come through a pipe: standard input, or what a shell's `<(zcat log.csv.gz)` stands for."""

import contextlib
import shutil
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path

from mobnet.core.errors import DataError
from mobnet.core.files import STDIN, descriptor_of, refusal

NAME = "stdin"  # of the log, for messages and for what is made of it
KINDS = {  # first bytes -> ending of the formats that are no texts
    b"\x1f\x8b": ".csv.gz",
    b"PAR1": ".parquet",
    b"\x89HDF": ".h5",
    b"MATLAB": ".mat",
    b"\x89MCAP": ".mcap",
    b"#ROSBAG": ".bag",
    b"SQLite": ".db3",
}
LOOKED_BYTES = 8


def is_piped(path: Path) -> bool:
    """Return whether a log comes through standard input or a pipe that this process was given open.

    A pipe with a name is none: where nobody writes to it, opening it would wait for ever.
    """
    is_open = descriptor_of(path) is not None and path.exists() and stat.S_ISFIFO(path.stat().st_mode)
    return is_open or path == STDIN


@contextlib.contextmanager
def as_file(path: Path) -> Iterator[Path]:
    """Yield a log as a file: what comes through a pipe is copied into one, as its reader goes through it several times.

    Raises:
        DataError: standard input is a terminal or a device, or the disk is full.
    """
    if not is_piped(path):
        yield path
        return
    if stat.S_ISCHR(path.stat().st_mode):
        raise DataError(
            "standard input is a terminal or a device; accepted: a log, such as that of `zcat log.csv.gz |`"
        )
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, NAME)
        try:
            with path.open("rb") as pipe, copy.open("wb") as file:
                shutil.copyfileobj(pipe, file)
        except OSError as error:
            raise DataError(refusal(error, copy)) from None
        with copy.open("rb") as file:
            start = file.read(LOOKED_BYTES)
        ending = next((ending for first, ending in KINDS.items() if start.startswith(first)), ".csv")
        yield copy.rename(f"{copy}{ending}")
