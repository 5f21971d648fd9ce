"""One time step of trained GRUs with their linear layers at batch 1, as compiled loops over their weights.

At this size the time goes into reading the weights once; NumPy's calls around the products took as long again, and one
call for each of six networks half as long.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.compilation import compiled
from mobnet.core.machine_code import HeldValue
from mobnet.learning.gates import MATHS, open_gates

Array = NDArray[np.float32]


class GruWeights(NamedTuple):
    """Weights as `gates.ordered` lays them, z-scores, and room for what a step adds up.

    Gates are in the order inner, reset, update, new; those of inputs begin with reset.
    """

    w_in: Array  # (3 H, n_in)
    w_state: Array  # (3 H, H)
    bias: Array  # (4 H,)
    w_out: Array  # (2 n, H), of means and standard deviations
    b_out: Array  # (2 n,)
    input_mean: Array  # (n_in,), in units of the inputs
    input_std: Array  # (n_in,), in units of the inputs
    target_mean: Array  # (n,) [N, N m]
    target_std: Array  # (n,) [N, N m]
    std_unit: Array  # target_std times the calibration's factor (n,) [N, N m]
    std_min: np.float32  # smallest standard deviation, z-scored
    scaled: Array  # room: z-scored inputs (n_in,)
    gates: Array  # room: (4 H,)


@compiled(fastmath=MATHS | {"reassoc"})
def dot(a: Array, b: Array) -> np.float32:
    """Return the product of two vectors (n,), summed in the order that is fastest."""
    total = np.float32(0.0)
    for i in range(len(a)):
        total += a[i] * b[i]
    return total


@compiled(fastmath=MATHS)
def advance(net: GruWeights, state: Array, x: Array, after: Array, mean: Array, std: Array) -> None:
    """Write the next state (H,), the mean and the standard deviation (n,) [N, N m] for inputs x (n_in,)."""
    hidden = len(state)
    for i in range(len(x)):
        net.scaled[i] = (x[i] - net.input_mean[i]) / net.input_std[i]
    for j in range(hidden):
        net.gates[j] = net.bias[j] + dot(net.w_state[j], state)
    for j in range(hidden, 3 * hidden):
        net.gates[j] = net.bias[j] + dot(net.w_state[j], state) + dot(net.w_in[j - hidden], net.scaled)
    for j in range(3 * hidden, 4 * hidden):
        net.gates[j] = net.bias[j] + dot(net.w_in[j - hidden], net.scaled)
    inner = net.gates[:hidden]
    reset = net.gates[hidden : 2 * hidden]
    update = net.gates[2 * hidden : 3 * hidden]
    new = net.gates[3 * hidden :]
    open_gates(inner, reset, update, new, state, after)
    joints = len(mean)
    zero = np.float32(0.0)
    unit = np.float32(1.0)
    for k in range(joints):
        mean[k] = (net.b_out[k] + dot(net.w_out[k], after)) * net.target_std[k] + net.target_mean[k]
        raw = net.b_out[joints + k] + dot(net.w_out[joints + k], after)
        # (N10), the softplus in a form that does not overflow, and (N11).
        soft = max(raw, zero) + math.log(unit + math.exp(-abs(raw)))
        std[k] = max(soft, net.std_min) * net.std_unit[k]


class GruRow(NamedTuple):
    """Networks one after the other, and room for what a step of one of them adds up."""

    sizes: NDArray[np.int64]  # of each one: hidden units, inputs, joints (k, 3)
    numbers: Array  # of each one: its arrays in the order of `GruWeights`, from w_in to std_unit
    std_min: Array  # (k,), z-scored
    columns: NDArray[np.intp]  # of each one: where its inputs stand among the signals
    x: Array  # inputs
    scaled: Array  # z-scored inputs
    gates: Array


def row_of(networks: Sequence[GruWeights], columns: Sequence[NDArray[np.intp]]) -> GruRow:
    """Return networks one after the other, of which each has its inputs in columns (n_in,) of the signals."""
    numbers = list[Array]()
    for net in networks:
        numbers += [array.ravel() for array in net[: GruWeights._fields.index("std_min")]]
    widest = max(map(len, columns))
    return GruRow(
        sizes=np.array([(net.w_state.shape[1], len(net.input_mean), len(net.target_mean)) for net in networks]),
        numbers=np.concatenate(numbers),
        std_min=np.array([net.std_min for net in networks]),
        columns=np.concatenate(columns),
        x=np.empty(widest, np.float32),
        scaled=np.empty(widest, np.float32),
        gates=np.empty(max(len(net.bias) for net in networks), np.float32),
    )


@compiled(allocating=True)
def advance_row(row: HeldValue, signals: Array, state: Array, after: Array, mean: Array, std: Array) -> None:
    """Write of networks of which a `GruRow` is held, one after the other, what `advance` writes of each."""
    _advance_each(row.value, signals, state, after, mean, std)


@compiled
def _advance_each(row: GruRow, signals: Array, state: Array, after: Array, mean: Array, std: Array) -> None:
    """Do so without counting references."""
    at = 0
    column = 0
    unit = 0
    joint = 0
    for k in range(len(row.sizes)):
        (hidden, inputs, joints) = (row.sizes[k, 0], row.sizes[k, 1], row.sizes[k, 2])
        w_in, at = _matrix(row.numbers, at, 3 * hidden, inputs)
        w_state, at = _matrix(row.numbers, at, 3 * hidden, hidden)
        bias, at = _vector(row.numbers, at, 4 * hidden)
        w_out, at = _matrix(row.numbers, at, 2 * joints, hidden)
        b_out, at = _vector(row.numbers, at, 2 * joints)
        input_mean, at = _vector(row.numbers, at, inputs)
        input_std, at = _vector(row.numbers, at, inputs)
        target_mean, at = _vector(row.numbers, at, joints)
        target_std, at = _vector(row.numbers, at, joints)
        std_unit, at = _vector(row.numbers, at, joints)
        x = row.x[:inputs]
        for i in range(inputs):
            x[i] = signals[row.columns[column + i]]
        room = (row.scaled[:inputs], row.gates[: 4 * hidden])
        scores = (input_mean, input_std, target_mean, target_std, std_unit)
        net = GruWeights(w_in, w_state, bias, w_out, b_out, *scores, row.std_min[k], *room)
        units = slice(unit, unit + hidden)
        columns = slice(joint, joint + joints)
        advance(net, state[units], x, after[units], mean[columns], std[columns])
        column += inputs
        unit += hidden
        joint += joints


@compiled
def _vector(numbers: Array, at: int, count: int) -> tuple[Array, int]:
    """Return so many of the numbers from `at` on, and where the next ones begin."""
    return numbers[at : at + count], at + count


@compiled
def _matrix(numbers: Array, at: int, rows: int, columns: int) -> tuple[Array, int]:
    """Return numbers from `at` on as a matrix, and where the next ones begin."""
    end = at + rows * columns
    return numbers[at:end].reshape(rows, columns), end
