"""The GRU of Table 1 on a CPU, forward and back through time: it computes what `torch.nn.GRU` does, in less time.

The loops over time are compiled (`gates`); the gradients of the weights are one large product each, after them. All
products but those of the inputs are in float32, or in bfloat16 from float32 weights into float32 gates and states
(docs/notes/0014). Gates and weights are laid out as `torch.nn.GRU` documents them: reset, update, new.
"""

from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from mobnet.learning.gates import go_back, go_forward
from mobnet.learning.tiles import PADDED, lay_left


class FusedGru(torch.autograd.Function):
    """GRU over a stretch of time with a hand-written backward pass, to the weights alone."""

    @staticmethod
    def forward(ctx: Any, x: Tensor, state: Tensor, precision: torch.dtype, *weights: Tensor) -> Tensor:
        """Return the states (h, B, H) after each of the inputs (h, B, n_in), from a state (B, H), unitless."""
        w_in, w_state, b_in, b_state = (weight.detach() for weight in weights)
        steps, (lanes, hidden), padded = len(x), state.shape, up(len(state))
        w_state = w_state.roll(hidden, 0)  # inner, reset, update
        bias = torch.cat([b_state[2 * hidden :], b_in])
        bias[hidden : 3 * hidden] += b_state[: 2 * hidden]
        x, inputs = with_ones(x.detach(), padded), torch.zeros(x.shape[2], steps, padded)
        inputs[..., :lanes] = x[:, :lanes, : len(inputs)].permute(2, 0, 1)
        states, gates = torch.zeros(steps + 1, hidden, padded), torch.empty(steps, 4, hidden * padded)
        states[0, :, :lanes] = state.detach().T
        arrays = (tensor.numpy() for tensor in (inputs, w_in, bias, gates, states.flatten(1)))
        go_forward(left_factor(w_state, precision), room(hidden, padded, precision), *arrays)
        h = with_ones(states.transpose(1, 2), padded)
        ctx.inputs, ctx.kept = len(inputs), (x, w_state, gates, states, h, precision)
        return h[1:, :lanes, :hidden]

    @staticmethod
    def backward(ctx: Any, *gradients: Tensor) -> tuple[Tensor | None, ...]:
        """Return the gradients of the weights from that of the states (h, B, H), unitless."""
        x, w_state, gates, states, h, precision = ctx.kept
        (lanes, hidden), padded = gradients[0].shape[1:], states.shape[2]
        given, d = torch.zeros_like(states[1:]), torch.zeros_like(states[0])
        given[..., :lanes] = gradients[0].transpose(1, 2)
        d_in, d_state = (torch.zeros(3 * hidden, rows.shape[2]) for rows in (x, h))
        heights = 3 * hidden, padded, padded
        widths = padded, x.shape[2], h.shape[2]
        go_back(
            left_factor(w_state.T, precision), room(padded, 4 * hidden, precision).reshape(4 * hidden, -1),
            *(room(height, width, precision) for height, width in zip(heights, widths, strict=True)),
            *(t.numpy() for t in (given.flatten(1), gates, states.flatten(1), x, h, d, torch.empty_like(gates[0]))),
            d_in.numpy(), d_state.numpy(),
        )  # fmt: skip
        d_state, n = d_state.roll(-hidden, 0), ctx.inputs
        return None, None, None, d_in[:, :n], d_state[:, :hidden], d_in[:, n], d_state[:, hidden]


def run_gru(cell: nn.GRU, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
    """Run a GRU over a stretch of time: on a CPU by the loops above, on a GPU by torch.

    The products are in float32, or under `torch.autocast` in its number format. On a CPU the inputs (h, B, n_in),
    unitless, get no gradient, and back-propagation is truncated at the state (1, B, H). Return the states (h, B, H) and
    the last of them (1, B, H), float32.
    """
    if x.device.type != "cpu":
        return cell(x, state)
    precision = torch.get_autocast_dtype("cpu") if torch.is_autocast_enabled("cpu") else torch.float32
    weights = cell.weight_ih_l0, cell.weight_hh_l0, cell.bias_ih_l0, cell.bias_hh_l0
    states = FusedGru.apply(x, state[0], precision, *weights)
    return states, states[-1:]


def up(count: int) -> int:
    """Return the next multiple of `PADDED`."""
    return count + -count % PADDED


def with_ones(rows: Tensor, lanes: int) -> Tensor:
    """Return a copy (h, L, m) of rows (h, B, n), zero but for them and a one after each, for the biases."""
    copy = torch.zeros(len(rows), lanes, up(rows.shape[2] + 1))
    copy[:, : rows.shape[1], : rows.shape[2]] = rows
    copy[..., rows.shape[2]] = 1.0
    return copy


def left_factor(matrix: Tensor, precision: torch.dtype) -> NDArray[Any]:
    """Return a matrix (m, k) as left factor of `add_product`: float32, or pairs of bfloat16 (m, ceil(k / 2))."""
    factor = room(matrix.shape[1], len(matrix), precision).reshape(len(matrix), -1)
    lay_left(matrix.contiguous().numpy(), factor)
    return factor


def room(rows: int, lanes: int, precision: torch.dtype) -> NDArray[Any]:
    """Return room for a right factor of `add_product` with so many rows: float32, or pairs of bfloat16."""
    paired = precision != torch.float32
    return np.empty((-(-rows // 2) if paired else rows, lanes), np.uint32 if paired else np.float32)
