"""The GRU of Table 1 on a CPU, forward and back through time: it computes what `torch.nn.GRU` does, in less time.

The loops over time are compiled with all their products (`gates`, `tiles`). Those with the state and those of the
gradients are in float32, or in bfloat16 from float32 weights into float32 gates, states and gradients
(docs/notes/precision.md). Weights are laid out as `torch.nn.GRU` documents them: reset, update, new.
"""

from typing import Any

import torch
from torch import Tensor, nn

from mobnet.learning.gates import go_back, go_forward, ordered
from mobnet.learning.tiles import left_factor, left_room, room, up


class FusedGru(torch.autograd.Function):
    """GRU over a stretch of time with a hand-written backward pass, to the weights alone."""

    @staticmethod
    def forward(ctx: Any, x: Tensor, state: Tensor, precision: torch.dtype, *weights: Tensor) -> Tensor:
        """Return the states (h, B, H) after each of the inputs (h, B, n_in), from a state (B, H), unitless."""
        steps = len(x)
        (lanes, hidden) = state.shape
        paired = precision == torch.bfloat16
        w_in, w_state, bias = ordered(*(weight.detach().numpy() for weight in weights))
        x = with_ones(x.detach(), inputs := x.shape[2])
        states = x.new_zeros(steps + 1, hidden, up(lanes))
        gates = x.new_empty(steps, 4, hidden * up(lanes))
        states[0, :, :lanes] = state.detach().T
        arrays = w_in, bias, gates.numpy(), states.flatten(1).numpy()
        h = with_ones(x.new_empty(steps + 1, lanes, 0), hidden)
        columns = x[..., :inputs].permute(2, 0, 1).contiguous().numpy()
        go_forward(left_factor(w_state, paired), room(hidden, up(lanes), paired), columns, *arrays, h.numpy())
        ctx.inputs = inputs
        ctx.kept = (x, w_state, gates, states, h, paired)
        return h[1:, :lanes, :hidden]

    @staticmethod
    def backward(ctx: Any, *gradients: Tensor) -> tuple[Tensor | None, ...]:
        """Return the gradients of the weights from that of the states (h, B, H), unitless."""
        x, w_state, gates, states, h, paired = ctx.kept
        given = gradients[0].contiguous()
        d = torch.zeros_like(states[0])
        hidden, padded = d.shape
        d_in, d_state = (torch.zeros(3 * hidden, rows.shape[2]) for rows in (x, h))
        sizes = (3 * hidden, padded), (padded, x.shape[2]), (padded, h.shape[2])
        tensors = given, gates, states.flatten(1), x, h, d, torch.empty_like(gates[0]), d_in, d_state
        go_back(
            left_factor(w_state.T, paired),
            left_room(4 * hidden, padded, paired),
            *(room(*size, paired) for size in sizes),
            *(tensor.numpy() for tensor in tensors),
        )
        # Torch has the order r, z, c, and the loops have i, r, z, whose first is c's part of the state's weights.
        d_state = d_state.roll(-hidden, 0)
        n = ctx.inputs
        return None, None, None, d_in[:, :n], d_state[:, :hidden], d_in[:, n], d_state[:, hidden]


def run_gru(cell: nn.GRU, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
    """Run a GRU over a stretch of time: on a CPU by the loops above, on a GPU by torch.

    The products are in float32, or under `torch.autocast` in its number format. On a CPU the inputs (h, B, n_in),
    unitless, get no gradient, and back-propagation is truncated at the state (1, B, H). Return the states (h, B, H) and
    the last of them (1, B, H), float32.
    """
    # The loops are compiled for a CPU, and a state that went there at each horizon would make a GPU wait.
    if x.device.type != "cpu":
        return cell(x, state)
    precision = torch.get_autocast_dtype("cpu") if torch.is_autocast_enabled("cpu") else torch.float32
    weights = cell.weight_ih_l0, cell.weight_hh_l0, cell.bias_ih_l0, cell.bias_hh_l0
    states = FusedGru.apply(x, state[0], precision, *weights)
    return states, states[-1:]


def with_ones(rows: Tensor, width: int) -> Tensor:
    """Return a copy (h, L, m) of rows (h, B, n), a one after so many columns, for the biases, and zero elsewhere."""
    # The products (N15) with such rows have the gradients of the biases in their last column.
    copy = torch.zeros(len(rows), up(rows.shape[1]), up(width + 1))
    copy[:, : rows.shape[1], : rows.shape[2]] = rows
    copy[..., width] = 1.0
    return copy
