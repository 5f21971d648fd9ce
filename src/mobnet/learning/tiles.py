"""Products of small matrices inside compiled loops, in float32 or in bfloat16 with float32 sums.

A tile of the result stays in the processor's registers while rows of the left factor, one number at a time, and vectors
of the right one pass by. Neither factor is copied, which takes a third of the time that a library needs at the size of
a GRU's time step (docs/notes/precision.md). In bfloat16 two rows of the right factor lie side by side, as one word of
32 bits a column, and so do two columns of the left one: x86 multiplies and adds such pairs with one instruction, where
it has `avx512_bf16`. Elsewhere they are taken apart and multiplied in float32.
"""

from typing import Any

import llvmlite.binding as llvm
import numba
import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic
from numpy.typing import NDArray

from mobnet.core.compilation import compiled

Factor = NDArray[Any]  # float32, or uint32 for pairs of bfloat16
FEATURES = (numba.config.CPU_FEATURES or llvm.get_host_cpu_features().flatten()).split(",")
PAIRS_AT_ONCE = "+avx512bf16" in FEATURES
# A tile, its vectors of the right factor and one number of the left factor fill the registers: 32 with 16 numbers each,
# or 16 with 8.
ROWS = 6
WIDE, VECTORS = (16, 4) if "+avx512f" in FEATURES else (8, 2)
PADDED = 16  # columns are a multiple of this many
FLOATS, WORDS = (ir.VectorType(kind, WIDE) for kind in (ir.FloatType(), ir.IntType(32)))
WORD = np.dtype(np.uint32)
LOWER, UPPER = 16, 0xFFFF0000  # bits to shift, and bits of the second number of a pair


class _Bfloat(ir.Type):
    """LLVM's type of that name, which llvmlite lacks."""

    def _to_string(self) -> str:
        return "bfloat"


PAIRS = ir.VectorType(_Bfloat(), 2 * WIDE)


def _fused(builder: Any, a: Any, b: Any, total: Any) -> Any:
    """Return total + a * b, rounded once where the processor can."""
    kind = ir.FunctionType(FLOATS, [FLOATS] * 3)
    name = f"llvm.fmuladd.v{WIDE}f32"
    return builder.call(cgutils.get_or_insert_function(builder.module, kind, name), [a, b, total])


def _fused_pairs(builder: Any, a: Any, b: Any, total: Any) -> Any:
    """Return total + a * b summed over each pair of bfloat16 numbers."""
    if PAIRS_AT_ONCE:
        kind = ir.FunctionType(FLOATS, [FLOATS, PAIRS, PAIRS])
        call = cgutils.get_or_insert_function(builder.module, kind, f"llvm.x86.avx512bf16.dpbf16ps.{32 * WIDE}")
        return builder.call(call, [total, builder.bitcast(a, PAIRS), builder.bitcast(b, PAIRS)])
    for operate, number in ((builder.shl, LOWER), (builder.and_, UPPER)):
        same = ir.Constant(WORDS, [number] * WIDE)
        first, second = (builder.bitcast(operate(word, same), FLOATS) for word in (a, b))
        total = _fused(builder, first, second, total)
    return total


def _at(builder: Any, array: Any, row: Any, column: Any, kind: Any) -> Any:
    """Return a pointer to a `kind` that begins at an element of an array (m, n) of 4 bytes a number."""
    start = builder.ptrtoint(array.data, row.type)
    step = cgutils.unpack_tuple(builder, array.strides)[0]
    offset = builder.add(builder.mul(row, step), builder.mul(column, row.type(4)))
    return builder.inttoptr(builder.add(start, offset), kind.as_pointer())


def _spread(builder: Any, number: Any) -> Any:
    zero = ir.Constant(ir.VectorType(ir.IntType(32), WIDE), None)
    nothing = ir.Constant(ir.VectorType(number.type, WIDE), ir.Undefined)
    first = builder.insert_element(nothing, number, ir.IntType(32)(0))
    return builder.shuffle_vector(first, first, zero)


def _tile(rows: int, vectors: int) -> Any:
    """Return a function for compiled code that adds `rows` times `vectors` vectors of a product, from (i, j) on."""

    def add_tile(typingctx: Any, out: Any, left: Any, right: Any, i: Any, j: Any) -> Any:
        vector, multiply = (WORDS, _fused_pairs) if left.dtype == types.uint32 else (FLOATS, _fused)

        def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            *arrays, i, j = args
            kinds = signature.args[:3]
            out, left, right = (context.make_array(k)(context, builder, a) for k, a in zip(kinds, arrays, strict=True))
            down = [builder.add(i, i.type(r)) for r in range(rows)]
            along = [builder.add(j, j.type(v * WIDE)) for v in range(vectors)]
            places = [[_at(builder, out, row, column, FLOATS) for column in along] for row in down]
            sums = [[cgutils.alloca_once_value(builder, builder.load(p, align=4)) for p in row] for row in places]
            with cgutils.for_range(builder, cgutils.unpack_tuple(builder, left.shape)[1]) as loop:
                passing = [builder.load(_at(builder, right, loop.index, c, vector), align=4) for c in along]
                for row, totals in zip(down, sums, strict=True):
                    same = _spread(builder, builder.load(_at(builder, left, row, loop.index, vector.element)))
                    for other, total in zip(passing, totals, strict=True):
                        builder.store(multiply(builder, same, other, builder.load(total)), total)
            for row, totals in zip(places, sums, strict=True):
                for p, total in zip(row, totals, strict=True):
                    builder.store(builder.load(total), p, align=4)
            return context.get_dummy_value()

        return types.void(out, left, right, i, j), codegen

    return intrinsic(add_tile)


_block = _tile(ROWS, VECTORS)
_row = _tile(1, VECTORS)
_narrow_block = _tile(ROWS, 1)
_narrow_row = _tile(1, 1)


@compiled
def add_product(out: NDArray[np.float32], left: Factor, right: Factor) -> None:
    """Add the product of a left factor (m, k) and a right one (k, n), n a multiple of `PADDED`, to out (m, n)."""
    blocks = len(out) // ROWS * ROWS
    wide = out.shape[1] // (VECTORS * WIDE) * VECTORS * WIDE
    for j in range(0, wide, VECTORS * WIDE):
        for i in range(0, blocks, ROWS):
            _block(out, left, right, i, j)
        for i in range(blocks, len(out)):
            _row(out, left, right, i, j)
    for j in range(wide, out.shape[1], WIDE):
        for i in range(0, blocks, ROWS):
            _narrow_block(out, left, right, i, j)
        for i in range(blocks, len(out)):
            _narrow_row(out, left, right, i, j)


@compiled
def rounded(value: np.float32) -> np.uint32:
    """Return the bits of the bfloat16 number, float32's upper half, nearest to a value; ties go to even."""
    word = np.float32(value).view(np.uint32)
    even = (word >> np.uint32(16)) & np.uint32(1)
    return (word + np.uint32(0x7FFF) + even) >> np.uint32(16)


@compiled
def lay_left(values: NDArray[np.float32], factor: Factor) -> None:
    """Lay a matrix (m, k) out as a left factor: as it is, or pairs of columns (m, ceil(k / 2)) in bfloat16."""
    for i in range(len(factor)):
        row = values[i]
        laid = factor[i]
        if factor.dtype == WORD:
            for j in range(len(row) // 2):
                laid[j] = rounded(row[2 * j]) | rounded(row[2 * j + 1]) << np.uint32(16)
            if len(row) % 2:
                laid[len(row) // 2] = rounded(row[len(row) - 1])
        else:
            for j in range(len(laid)):
                laid[j] = row[j]


@compiled
def lay_right(values: NDArray[np.float32], factor: Factor) -> None:
    """Lay a matrix (k, n) out as a right factor: as it is, or pairs of rows (ceil(k / 2), n) in bfloat16."""
    for i in range(len(factor)):
        laid = factor[i]
        if factor.dtype == WORD:
            first = values[2 * i]
            second = values[min(2 * i + 1, len(values) - 1)]
            for j in range(len(laid)):
                laid[j] = rounded(first[j]) | rounded(second[j]) << np.uint32(16)
        else:
            row = values[i]
            for j in range(len(laid)):
                laid[j] = row[j]


def up(count: int) -> int:
    """Return the next multiple of `PADDED`."""
    return count + -count % PADDED


def room(rows: int, columns: int, paired: bool) -> Factor:
    """Return room for a right factor (rows, columns): float32, or pairs of bfloat16."""
    return np.empty((-(-rows // 2), columns), np.uint32) if paired else np.empty((rows, columns), np.float32)


def left_room(rows: int, columns: int, paired: bool) -> Factor:
    """Return room for a left factor (rows, columns): float32, or pairs of bfloat16."""
    return np.empty((rows, -(-columns // 2)), np.uint32) if paired else np.empty((rows, columns), np.float32)


def left_factor(matrix: NDArray[np.float32], paired: bool) -> Factor:
    """Return a matrix (m, k) as left factor: float32, or pairs of bfloat16 (m, ceil(k / 2))."""
    rows, columns = matrix.shape
    factor = left_room(rows, columns, paired)
    lay_left(np.ascontiguousarray(matrix), factor)
    return factor
