"""Arrays of a long log in files without a name, so that an hour of it takes disk in place of memory.

Such an array is NumPy's own, over pages of a file. The pages that were read or written stay with the process until they
are given back, which `mobnet.robotlog.pieces.pieces` does as it goes through the rows.
"""

import math
import mmap
import os
import tempfile
import weakref
from pathlib import Path

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError
from mobnet.core.files import FULL, refusal

LARGE_BYTES = 2**28  # of an array that lies in a file: smaller ones of a log fit into the memory together
_maps = weakref.WeakSet[mmap.mmap]()


def long_array(shape: tuple[int, ...], folder: Path | None) -> Array:
    """Return an array to be filled; a large one lies in a file in a folder, where one is given, and goes with it.

    Raises:
        DataError: the disk is full.
    """
    size = math.prod(shape) * np.dtype(np.float64).itemsize
    if folder is None or size < LARGE_BYTES:
        return np.empty(shape)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder) as file:
            # All of it at once: a disk that is full later would end the process without a line.
            os.posix_fallocate(file.fileno(), 0, size)
            pages = mmap.mmap(file.fileno(), size)
    except OSError as error:
        if error.errno in FULL:
            raise DataError(refusal(error, folder, size=size)) from None
        return np.empty(shape)  # some file systems of containers and networks map no files
    _maps.add(pages)
    return np.frombuffer(pages, dtype=np.float64).reshape(shape)


def give_back() -> None:
    """Give the pages of all long arrays back to the system, which keeps what was written in them."""
    for pages in _maps:
        pages.madvise(mmap.MADV_DONTNEED)
