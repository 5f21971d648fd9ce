"""Several recordings through one network side by side: each is a lane, and a time step of all is one matrix product.

A single lane multiplies a matrix with a vector at each step, and most of its time goes into reading the weights and
into Python. Lanes start together from fresh states; one that ends leaves, so that lengths may differ. The state of a
lane does not depend on the others but for the order of summation in a product, which the size of a matrix decides:
numbers differ in their last bits from those of a lane alone; tests/library/learning/deployed/test_lanes.py has the
bound.
"""

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from mobnet.learning.gates import go_forward, ordered
from mobnet.learning.tiles import room, up

Array = NDArray[np.float32]
State = TypeVar("State", bound=Any)  # an array or a tensor; lanes are its second axis
Advance = Callable[[State, Array], tuple[State, Array]]
CHUNK = 500  # steps run at once: the memory of inputs, gates and states does not grow with the length


def side_by_side(lanes: Sequence[Array], state: State, advance: Advance[State]) -> list[Array]:
    """Return the outputs (T_i, m) of lanes of inputs (T_i, n_in) from a state (rows, B, columns).

    The function `advance` takes a state and inputs (h, B, n_in), and returns the state after them and outputs
    (h, B, m).
    """
    order = sorted(range(len(lanes)), key=lambda i: -len(lanes[i]))
    outputs_of: list[list[Array]] = [[] for _ in lanes]
    for start in range(0, len(lanes[order[0]]), CHUNK):
        alive = [i for i in order if len(lanes[i]) > start]
        parts = [lanes[i][start : start + CHUNK] for i in alive]
        inputs = np.zeros((len(parts[0]), len(parts), parts[0].shape[1]), dtype=np.float32)
        for lane, part in enumerate(parts):
            inputs[: len(part), lane] = part
        state, outputs = advance(state[:, : len(alive)], inputs)
        for lane, (i, part) in enumerate(zip(alive, parts, strict=True)):
            outputs_of[i].append(outputs[: len(part), lane])
    return [np.concatenate(parts) for parts in outputs_of]


def gru_states(weights: Sequence[Array], state: Array, inputs: Array) -> tuple[Array, Array]:
    """Return the state after inputs (h, B, n_in), (1, B, H), and all states (h, B, H), of a GRU from a state (1, B, H).

    Weights are those that torch names weight_ih (3 H, n_in), weight_hh (3 H, H), bias_ih (3 H,) and bias_hh (3 H,).
    """
    w_in, w_state, bias = ordered(*weights)
    steps = len(inputs)
    (lanes, hidden) = state.shape[1:]
    columns = np.zeros((inputs.shape[2], steps, up(lanes)), np.float32)
    columns[..., :lanes] = inputs.transpose(2, 0, 1)
    gates = np.empty((1, 4, hidden * up(lanes)), np.float32)
    states = np.zeros((steps + 1, hidden, up(lanes)), np.float32)
    states[0, :, :lanes] = state[0].T
    all_states = np.empty((steps + 1, up(lanes), hidden), np.float32)
    flat = states.reshape(steps + 1, -1)
    go_forward(w_state, room(hidden, up(lanes), False), columns, w_in, bias, gates, flat, all_states)
    return all_states[-1:, :lanes], all_states[1:, :lanes]
