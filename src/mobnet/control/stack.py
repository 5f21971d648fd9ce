"""Small arrays on the stack, for compiled code that owns no memory."""

import math
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numba.np.arrayobj import populate_array

ITEM = np.dtype(np.float64).itemsize  # bytes


def on_stack(*shape: int) -> Any:
    """Return a function for compiled code: room of that shape, not set, until the function that asks returns."""

    @intrinsic
    def room(typingctx: Any) -> Any:
        kind = types.Array(types.float64, len(shape), "C")

        def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            array = context.make_array(kind)(context, builder)
            strides = [ITEM * math.prod(shape[i + 1 :]) for i in range(len(shape))]
            sizes, steps = ([context.get_constant(types.intp, n) for n in row] for row in (shape, strides))
            data = cgutils.alloca_once(builder, ir.DoubleType(), size=math.prod(shape))
            item = context.get_constant(types.intp, ITEM)
            populate_array(array, data=data, shape=sizes, strides=steps, itemsize=item, meminfo=None)
            return array._getvalue()

        return kind(), codegen

    return room


vector3, matrix3 = on_stack(3), on_stack(3, 3)
