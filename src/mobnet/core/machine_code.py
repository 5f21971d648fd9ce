"""The decorator for compiled code, its cache, and arguments that compiled code holds.

Code under `compiled` owns no memory: numba then counts no references to arrays, which took half of the controller's
time and keeps loops from vector instructions, and refuses code that allocates. Arrays come from the caller.

To tell whether cached machine code is stale, numba looks only at the file of the function itself, not at those of the
functions it calls. The cache of each module therefore lives in a folder with a name of its own: here the hash of all
modules beside it, so that compiled code may call only what lies in its own folder. `mobnet.core.compilation` follows
imports.

At each call from Python numba takes tuples, records and generators of random numbers apart, field by field, which takes
longer than many a function that gets them. What `hold` returns is one pointer to fields that were taken apart before.
"""

import contextlib
import functools
import hashlib
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import Any

import numba
from numba import types
from numba.experimental import structref

from mobnet.core.root import caches


def compiled(
    function: Callable[..., Any] | None = None,
    *,
    allocating: bool = False,
    fastmath: Collection[str] = (),
    name_of: Callable[[str], str] | None = None,
) -> Any:
    """Return a function compiled by numba at its first call, or, without a function, the decorator with its options.

    Only the outermost loop is `allocating`: it makes the buffers. `fastmath` lists the freedoms that the compiler takes
    with floating-point numbers, in LLVM's words. `name_of` names the folder of the cache by the function's file; it
    is `folder_hash` if None.
    """
    if function is None:
        return functools.partial(compiled, allocating=allocating, fastmath=fastmath, name_of=name_of)
    options: dict[str, Any] = {} if allocating else {"_nrt": False}  # no run time of numba: no memory and no counts
    file = function.__code__.co_filename
    name = folder_hash(file) if name_of is None else name_of(file)
    with cached_in(cache_root() / name):
        return numba.njit(cache=True, error_model="numpy", fastmath=set(fastmath) or False, **options)(function)


def folder_hash(file: str) -> str:
    """Return a short hash of all modules in the folder of a file, and of this one."""
    return _hash_of(Path(file).parent)


@functools.cache
def _hash_of(folder: Path) -> str:
    """Return a short hash of all modules in a folder, and of this one."""
    content = hashlib.blake2b(digest_size=8)
    for path in [Path(__file__), *sorted(folder.glob("*.py"))]:
        content.update(path.name.encode())
        content.update(path.read_bytes())
    return content.hexdigest()


def cache_root() -> Path:
    """Return the folder of all machine code."""
    return Path(numba.config.CACHE_DIR or caches() / "numba")


@contextlib.contextmanager
def cached_in(folder: Path) -> Iterator[None]:
    """Let numba cache the functions that are decorated meanwhile in a folder; it takes none but from its settings."""
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(folder)
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before


@structref.register
class HeldType(types.StructRef):
    """The type of a `HeldValue` in compiled code: it has the type of its value."""


class HeldValue(structref.StructRefProxy):
    """A value that compiled code finds as `value`; what it refers to may change, but not which objects those are.

    Attributes:
        of: the value in Python. A record in it is a mere address to compiled code, so that it has to live as long.
    """

    of: Any


structref.define_proxy(HeldValue, HeldType, ["value"])


def hold(value: Any) -> HeldValue:
    """Return a value held for compiled code, such as a named tuple of arrays, records and other tuples.

    Only functions that are compiled as `allocating` take it, because it counts references.
    """
    holder = _hold(value)
    holder.of = value
    return holder


@compiled(allocating=True)
def _hold(value: Any) -> Any:
    """Return a value held for compiled code."""
    return HeldValue(value)
