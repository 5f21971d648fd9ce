"""The decorator for compiled code, and where its machine code is cached.

Code under `compiled` owns no memory: numba then counts no references to arrays, which took half of the controller's
time and keeps loops from vector instructions, and refuses code that allocates. Arrays come from the caller or from
`mobnet.control.stack`.

To tell whether cached machine code is stale, numba looks only at the file of the function itself, not at those of the
functions it calls. The cache of each module therefore lives in a folder named after the hash of the module's code with
all that it imports (`mobnet.core.code`), so that an edit of a called function is noticed, and one of a comment in its
file is not.
"""

import contextlib
import functools
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import Any

import numba

from mobnet.core.code import ROOT, code_hash


def compiled(
    function: Callable[..., Any] | None = None, *, allocating: bool = False, fastmath: Collection[str] = ()
) -> Any:
    """Return a function compiled by numba at its first call, or, without a function, the decorator with its options.

    Args:
        function: what is compiled, in a source file.
        allocating: True for the outermost loop, which makes the buffers and so owns memory.
        fastmath: freedoms that the compiler takes with floating-point numbers, in LLVM's words; none by default.
    """
    if function is None:
        return functools.partial(compiled, allocating=allocating, fastmath=fastmath)
    options: dict[str, Any] = {} if allocating else {"_nrt": False}  # no run time of numba: no memory and no counts
    with cached_in(cache_folder(function.__code__.co_filename)):
        return numba.njit(cache=True, error_model="numpy", fastmath=set(fastmath) or False, **options)(function)


@functools.cache
def cache_folder(file: str) -> Path:
    """Return the folder for the machine code of a source file's functions."""
    return Path(numba.config.CACHE_DIR or ROOT / ".cache" / "numba") / code_hash(Path(file))


@contextlib.contextmanager
def cached_in(folder: Path) -> Iterator[None]:
    """Let numba cache the functions that are decorated meanwhile in a folder; it takes none but from its settings."""
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(folder)
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before
