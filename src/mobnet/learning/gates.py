"""One time step of the GRU's gates, forward and back, as compiled loops (Cho et al. 2014, as `torch.nn.GRU` has it).

Each loop writes one array: with more of them the compiler cannot show that they do not overlap, and does not vectorize.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.compiled import compiled

Array = NDArray[np.float32]
Products = NDArray[Any]  # float32, or bfloat16 as its bits in uint16
MATHS = {"contract", "nsz", "arcp"}  # NaN stays NaN


@compiled(fastmath=MATHS)
def rational_tanh(x: np.float32) -> np.float32:
    """Return tanh(x), unitless, within a few float32 roundings; loops over it vectorize, which tanh's do not.

    tanh(x / 2) by the seventh convergent of Lambert's continued fraction, x / (1 + x^2 / (3 + x^2 / (5 + ...))), then
    the double of the argument: tanh(2 y) = 2 t / (1 + t^2).
    """
    x = min(np.float32(9.0), max(np.float32(-9.0), x)) if x == x else x  # tanh(9) rounds to 1; NaN passes
    y = np.float32(0.5) * x
    s = y * y
    p = np.float32(135135) + s * (np.float32(17325) + s * (np.float32(378) + s))
    q = np.float32(135135) + s * (np.float32(62370) + s * (np.float32(3150) + s * np.float32(28)))
    t = y * p / q
    return (t + t) / (np.float32(1.0) + t * t)


@compiled(fastmath=MATHS)
def read(array: Products, j: int) -> np.float32:
    """Return an element of an array (n,) of either format, unitless: bfloat16 is the upper half of a float32."""
    if array.itemsize == 2:
        return np.uint32(np.uint32(array[j]) << np.uint32(16)).view(np.float32)
    return np.float32(array[j])


@compiled(fastmath=MATHS)
def write(array: Products, j: int, value: np.float32) -> None:
    """Set an element of an array (n,) of either format, unitless, rounded to the nearest, ties to even."""
    if array.itemsize == 2:
        word = np.float32(value).view(np.uint32)
        even = (word >> np.uint32(16)) & np.uint32(1)
        array[j] = np.uint16((word + np.uint32(0x7FFF) + even) >> np.uint32(16))
    else:
        array[j] = value


@compiled(fastmath=MATHS)
def step_forward(
    inputs: Array, recurrent: Products, bias: Array, before: Array, gates: Array, after: Array, rounded: Products
) -> None:
    """Open the gates and write the next state (B, H), unitless, as it is and `rounded` to the products' format.

    The inputs' and the state's (`recurrent`) shares of the gates' sums are (B, 3 H): reset, update, new. `bias` has
    their biases and that of the new gate's recurrent part (4 H,); `gates` gets the same four (B, 4 H).
    """
    half = np.float32(0.5)
    n = before.shape[1]
    for i in range(before.shape[0]):
        x, h, x_new, h_new = inputs[i], recurrent[i], inputs[i, 2 * n :], recurrent[i, 2 * n :]
        opened, update, new, inner = gates[i, : 2 * n], gates[i, n : 2 * n], gates[i, 2 * n : 3 * n], gates[i, 3 * n :]
        last, state, low = before[i], after[i], rounded[i]
        for j in range(2 * n):
            opened[j] = half + half * rational_tanh(half * (x[j] + read(h, j) + bias[j]))
        for j in range(n):
            inner[j] = read(h_new, j) + bias[3 * n + j]
        for j in range(n):
            new[j] = rational_tanh(x_new[j] + bias[2 * n + j] + opened[j] * inner[j])
        for j in range(n):
            state[j] = new[j] + update[j] * (last[j] - new[j])
        for j in range(n):
            write(low, j, state[j])


@compiled(fastmath=MATHS)
def step_backward(
    gates: Array, before: Array, given: Array, fed: Products, carried: Array, d_sums: Products, d_new: Products,
    d_bias: Array,
) -> None:  # fmt: skip
    """Take the gradient (B, H), unitless, of a state back through one step with the gates (B, 4 H) of `step_forward`.

    Args:
        gates: reset, update, new and the new gate's recurrent part (B, 4 H).
        before: state before the step (B, H).
        given: gradient of the state after the step, as an output (B, H).
        fed: what reaches that state through the products of the step after (B, H).
        carried: what reaches it past them (B, H); overwritten by the same for the state before.
        d_sums: gets the gradient of the recurrent sums (B, 3 H).
        d_new: gets the gradient of the new gate's input sum (B, H).
        d_bias: the gradients of the biases (4 H,) are added here: reset, update, the new gate's recurrent part, new.
    """
    one = np.float32(1.0)
    n = before.shape[1]
    for i in range(before.shape[0]):
        reset, update, new, inner = gates[i, :n], gates[i, n : 2 * n], gates[i, 2 * n : 3 * n], gates[i, 3 * n :]
        d, last, direct, through = carried[i], before[i], given[i], fed[i]
        d_all, d_update, d_inner, d_last = d_sums[i], d_sums[i, n : 2 * n], d_sums[i, 2 * n :], d_new[i]
        for j in range(n):
            d[j] += direct[j] + read(through, j)
        for j in range(n):
            write(d_update, j, d[j] * (last[j] - new[j]) * update[j] * (one - update[j]))
        for j in range(n):
            write(d_last, j, d[j] * (one - update[j]) * (one - new[j] * new[j]))
        for j in range(n):
            write(d_all, j, read(d_last, j) * inner[j] * reset[j] * (one - reset[j]))
        for j in range(n):
            write(d_inner, j, read(d_last, j) * reset[j])
        for j in range(n):
            d[j] *= update[j]
        for j in range(3 * n):
            d_bias[j] += read(d_all, j)
        for j in range(n):
            d_bias[3 * n + j] += read(d_last, j)
