"""One time step of a trained GRU with its linear layer at batch 1, as compiled loops over its weights.

At this size the time goes into reading the weights once; NumPy's calls around the products took as long again.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.compilation import compiled
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
    one = np.float32(1.0)
    for k in range(joints):
        mean[k] = (net.b_out[k] + dot(net.w_out[k], after)) * net.target_std[k] + net.target_mean[k]
        raw = net.b_out[joints + k] + dot(net.w_out[joints + k], after)
        # (N10), the softplus in a form that does not overflow, and (N11).
        soft = max(raw, zero) + math.log(one + math.exp(-abs(raw)))
        std[k] = max(soft, net.std_min) * net.std_unit[k]
