"""The decorator for compiled code, its cache, small arrays on its stack, and arguments that it holds.

Code under `compiled` owns no memory: numba then counts no references to arrays, which took half of the controller's
time and keeps loops from vector instructions, and refuses code that allocates. Arrays come from the caller or from
`on_stack`.

To tell whether cached machine code is stale, numba looks only at the file of the function itself, not at those of the
functions it calls. The cache of each module therefore lives in a folder named after the hash of the module's code with
all that it imports (`mobnet.core.code`), so that an edit of a called function is noticed, and one of a comment in its
file is not.

At each call from Python numba takes tuples, records and generators of random numbers apart, field by field, which takes
longer than many a function that gets them. What `hold` returns is one pointer to fields that were taken apart before.

The first process that needs a function compiles it, which takes up to half a minute for the plant's loop, and says so
every few seconds; those that find it in the cache say nothing.
"""

import contextlib
import functools
import logging
import math
import threading
import time
from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import Any

import numba
import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core import event as events
from numba.experimental import structref
from numba.extending import intrinsic
from numba.np.arrayobj import populate_array

from mobnet.core.code import code_hash
from mobnet.core.place import caches

ITEM = np.dtype(np.float64).itemsize  # bytes
TOLD_S = 5.0  # between two words on how far the compiler is
log = logging.getLogger(__name__)


class Compilations(events.Listener):
    """Logs that a process compiles: at its first compilation, then how many functions it has compiled, every while.

    Functions that a function calls are compiled within it; how many there will be is not known before.
    """

    def __init__(self) -> None:
        """Wait for the first."""
        self.count = 0
        self.took_s = 0.0  # of all that have ended, each with those within it
        self.begun_s: list[float] = []  # of those that are going on, the outermost first
        self.ended = threading.Event()

    def on_start(self, event: events.Event) -> None:
        """Say so at the first one; while any goes on, a thread says how far it is."""
        if not self.count and not self.begun_s:
            log.info("compiling code for this processor, which may take a minute, once")
        self.begun_s.append(time.monotonic())
        if len(self.begun_s) == 1:
            self.ended = threading.Event()
            threading.Thread(target=self.tell, args=[self.ended, self.begun_s[0]], daemon=True).start()

    def on_end(self, event: events.Event) -> None:
        """Count."""
        begun_s = self.begun_s.pop()
        self.count += 1
        if not self.begun_s:
            self.took_s += time.monotonic() - begun_s
            self.ended.set()

    def tell(self, ended: threading.Event, begun_s: float) -> None:
        """Say every while how far a compilation is, until it has ended."""
        while not ended.wait(TOLD_S):
            took_s = self.took_s + time.monotonic() - begun_s
            log.info("compiling code for this processor: %d functions in %.0f s so far", self.count, took_s)


events.register("numba:compile", Compilations())


def compiled(
    function: Callable[..., Any] | None = None, *, allocating: bool = False, fastmath: Collection[str] = ()
) -> Any:
    """Return a function compiled by numba at its first call, or, without a function, the decorator with its options.

    Only the outermost loop is `allocating`: it makes the buffers. `fastmath` lists the freedoms that the compiler takes
    with floating-point numbers, in LLVM's words.
    """
    if function is None:
        return functools.partial(compiled, allocating=allocating, fastmath=fastmath)
    options: dict[str, Any] = {} if allocating else {"_nrt": False}  # no run time of numba: no memory and no counts
    with cached_in(cache_folder(function.__code__.co_filename)):
        return numba.njit(cache=True, error_model="numpy", fastmath=set(fastmath) or False, **options)(function)


@functools.cache
def cache_folder(file: str) -> Path:
    """Return the folder for the machine code of a source file's functions."""
    return cache_root() / code_hash(Path(file))


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


def on_stack(*shape: int) -> Any:
    """Return a function for compiled code: room of that shape, not set, until the function that asks returns."""

    @intrinsic
    def room(typingctx: Any) -> Any:
        kind = types.Array(types.float64, len(shape), "C")

        def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            array = context.make_array(kind)(context, builder)
            strides = [ITEM * math.prod(shape[i + 1 :]) for i in range(len(shape))]
            sizes = [context.get_constant(types.intp, size) for size in shape]
            steps = [context.get_constant(types.intp, stride) for stride in strides]
            data = cgutils.alloca_once(builder, ir.DoubleType(), size=math.prod(shape))
            item = context.get_constant(types.intp, ITEM)
            populate_array(array, data=data, shape=sizes, strides=steps, itemsize=item, meminfo=None)
            return array._getvalue()

        return kind(), codegen

    return room


vector3 = on_stack(3)
matrix3 = on_stack(3, 3)


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
