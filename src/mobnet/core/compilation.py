"""The decorator for compiled code that calls other packages of the library, and small arrays on its stack.

It is that of `mobnet.core.machine_code`, but for the name of the cache's folder: the hash of the module's code with all
that it imports (`mobnet.core.code`), so that an edit of a called function is noticed, and one of a comment in its file
is not. Arrays of compiled code come from the caller or from `on_stack`.
"""

import functools
import math
from pathlib import Path
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core import event as events
from numba.extending import intrinsic
from numba.np.arrayobj import populate_array

from mobnet.core import machine_code
from mobnet.core.code import code_hash
from mobnet.core.compile_log import Compilations

ITEM = np.dtype(np.float64).itemsize  # bytes

events.register("numba:compile", Compilations())


@functools.cache
def imports_hash(file: str) -> str:
    """Return a short hash of a file's code with all that it imports."""
    return code_hash(Path(file))


compiled = functools.partial(machine_code.compiled, name_of=imports_hash)


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
