"""The GRU over a stretch of time, forward and back, as compiled loops (Cho et al. 2014, as `torch.nn.GRU` has it).

Units are rows and lanes are columns, their number a multiple of `PADDED`, so that a vector instruction takes lanes and
no unit is left over. The gates are in the order inner (the new gate's recurrent part), reset, update, new: the state's
products reach the first three, those of the inputs the last three.

Each loop over numbers writes one array: with more of them the compiler cannot show that they do not overlap, and does
not vectorize.
"""

import numpy as np
from numpy.typing import NDArray

from mobnet.core.compilation import compiled
from mobnet.learning.tiles import Factor, add_product, lay_left, lay_right

Array = NDArray[np.float32]
MATHS = {"contract", "nsz", "arcp"}  # NaN stays NaN


def ordered(w_in: Array, w_state: Array, b_in: Array, b_state: Array) -> tuple[Array, Array, Array]:
    """Return the weights of inputs and state and the bias as the loops take them, of those that torch has.

    They are weight_ih (3 H, n_in) and weight_hh (3 H, H), bias_ih and bias_hh (3 H,): reset, update, new.
    """
    n = w_state.shape[1]
    # Two of torch's biases are one number to (N5); that of i stays apart, because the reset gate multiplies it, (N4).
    bias = np.concatenate([b_state[2 * n :], b_in])
    bias[n : 3 * n] += b_state[: 2 * n]
    return np.ascontiguousarray(w_in), np.roll(w_state, n, axis=0), bias


@compiled(fastmath=MATHS)
def rational_tanh(x: np.float32) -> np.float32:
    """Return tanh(x), unitless, within a few float32 roundings; loops over it vectorize, which tanh's do not.

    (N8) at half the argument, whose double (N9) gives with a single division.
    """
    # (N8) grows without bound further out, where tanh is 1 to a rounding. NaN passes, so that a divergence is seen.
    x = min(np.float32(9.0), max(np.float32(-9.0), x)) if x == x else x
    y = np.float32(0.5) * x
    s = y * y
    u = y * (np.float32(135135) + s * (np.float32(17325) + s * (np.float32(378) + s)))
    q = np.float32(135135) + s * (np.float32(62370) + s * (np.float32(3150) + s * np.float32(28)))
    return (u + u) * q / (q * q + u * u)


@compiled(fastmath=MATHS)
def open_gates(inner: Array, reset: Array, update: Array, new: Array, last: Array, state: Array) -> None:
    """Turn the sums of gates (n,) into the gates, and write the next state (n,), unitless."""
    # (N5) and (N6), with (N7) for the logistic function.
    half = np.float32(0.5)
    for j in range(len(reset)):
        reset[j] = half + half * rational_tanh(half * reset[j])
    for j in range(len(update)):
        update[j] = half + half * rational_tanh(half * update[j])
    for j in range(len(new)):
        new[j] = rational_tanh(new[j] + reset[j] * inner[j])
    for j in range(len(state)):
        state[j] = new[j] + update[j] * (last[j] - new[j])


@compiled
def turn(values: Array, turned: Array) -> None:
    """Write a matrix (n, L) with rows as columns (L, m), m at least n."""
    for i in range(len(values)):
        row = values[i]
        for j in range(len(row)):
            turned[j, i] = row[j]


@compiled
def go_forward(
    w_state: Factor, right: Factor, inputs: Array, w_in: Array, bias: Array, gates: Array, states: Array, h: Array
) -> None:
    """Run a GRU over a stretch of time; L lanes, a multiple of `PADDED`, all unitless.

    Args:
        w_state: weights of the state, inner, reset, update (3 H, H), as left factor.
        right: room for a state as right factor.
        inputs: (n_in, h, L).
        w_in: weights of the inputs, reset, update, new (3 H, n_in).
        bias: (4 H,), those of inputs and state added.
        gates: gets inner, reset, update and new of each step (h, 4, H L), or has room for fewer and keeps the last.
        states: has the state before the first step, and gets that after each one (h + 1, H L).
        h: gets all of these with lanes as rows (h + 1, L, m), m at least H.
    """
    lanes = inputs.shape[2]
    n = states.shape[1] // lanes
    for k in range(inputs.shape[1]):
        # Training keeps every step's gates for the way back, (N12); without training there is room for one.
        parts = gates[k % len(gates)]
        sums = parts.reshape(4 * n, lanes)
        for i in range(4 * n):
            sums[i] = bias[i]
        state = states[k].reshape(n, lanes)
        turn(state, h[k])
        lay_right(state, right)
        add_product(sums[n:], w_in, inputs[:, k])
        add_product(sums[: 3 * n], w_state, right)
        open_gates(parts[0], parts[1], parts[2], parts[3], states[k], states[k + 1])
    turn(states[len(states) - 1].reshape(n, lanes), h[len(h) - 1])


@compiled(fastmath=MATHS)
def close_gates(
    inner: Array,
    reset: Array,
    update: Array,
    new: Array,
    last: Array,
    d: Array,
    d_inner: Array,
    d_reset: Array,
    d_update: Array,
    d_new: Array,
) -> None:
    """Take the gradient `d` (n,) of a state, unitless, back through its gates: to their sums, and past them to `last`.

    What reaches the state before the step past the gates is left in `d`.
    """
    # (N12) and (N13): the slopes of tanh and of the logistic function follow from the gates, so no sums are kept.
    unit = np.float32(1.0)
    for j in range(len(d)):
        d_update[j] = d[j] * (last[j] - new[j]) * update[j] * (unit - update[j])
    for j in range(len(d)):
        d_new[j] = d[j] * (unit - update[j]) * (unit - new[j] * new[j])
    for j in range(len(d)):
        d_reset[j] = d_new[j] * inner[j] * reset[j] * (unit - reset[j])
    for j in range(len(d)):
        d_inner[j] = d_new[j] * reset[j]
    for j in range(len(d)):
        # The first part of (N14): what is past the gates decays by the update gate alone, hence a GRU's long memory.
        d[j] *= update[j]


@compiled
def go_back(
    w_state: Factor,
    left: Factor,
    right: Factor,
    x_right: Factor,
    h_right: Factor,
    given: Array,
    gates: Array,
    states: Array,
    x: Array,
    h: Array,
    d: Array,
    d_gates: Array,
    d_in: Array,
    d_state: Array,
) -> None:
    """Take the gradients of the states back through `go_forward`, to the weights; all unitless.

    Args:
        w_state: transposed weights of the state, inner, reset, update (H, 3 H), as left factor.
        left: room for `d_gates` (4 H, L) as left factor.
        right: room for the first three of them (3 H, L) as right factor.
        x_right: room for the inputs of a step (L, n) as right factor.
        h_right: room for the state before it (L, m) as right factor.
        given: gradient of the state after each step, as an output (h, B, H).
        gates: as `go_forward` left them (h, 4, H L).
        states: as `go_forward` left them (h + 1, H L).
        x: inputs with lanes as rows (h, L, n), a one after each.
        h: states with lanes as rows (h + 1, L, m), a one after each.
        d: zero; gets the gradient of the state before the first step (H, L).
        d_gates: room for the gradients of a step's sums (4, H L).
        d_in: zero; gets the products of reset, update, new with `x` (3 H, n): gradients of weights and, last, biases.
        d_state: zero; gets the products of inner, reset, update with `h` (3 H, m).
    """
    n, lanes = d.shape
    flat = d.reshape(d.size)
    for k in range(len(given) - 1, -1, -1):
        output = given[k]
        g = gates[k]
        for i in range(n):
            for j in range(len(output)):
                d[i, j] += output[j, i]
        # (N14) and (N15). Gradients of weights are summed step by step, as one product after the loop would round
        # and reorder its factors once more, which takes longer (docs/notes/precision.md).
        close_gates(g[0], g[1], g[2], g[3], states[k], flat, d_gates[0], d_gates[1], d_gates[2], d_gates[3])
        lay_left(d_gates.reshape(1, d_gates.size), left.reshape(1, left.size))
        lay_right(d_gates[:3].reshape(3 * n, lanes), right)
        lay_right(x[k], x_right)
        lay_right(h[k], h_right)
        add_product(d, w_state, right)
        add_product(d_in, left[n:], x_right)
        add_product(d_state, left[: 3 * n], h_right)
