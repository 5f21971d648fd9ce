"""The GRU of Table 1 on a CPU, forward and back through time: it computes what `torch.nn.GRU` does, in less time.

Per step only two products forward, one back and the compiled loops over the gates remain, on memory that stays in the
cache; the gradients of the weights are one large product each, after the loop. All products but those of the inputs are
in float32, or in bfloat16 from float32 weights and into float32 gates and states (docs/notes/0014). Gates and weights
are laid out as `torch.nn.GRU` documents them: reset, update, new.
"""

from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from mobnet.learning.gates import step_backward, step_forward


class FusedGru(torch.autograd.Function):
    """GRU over a stretch of time with a hand-written backward pass, to the weights alone."""

    @staticmethod
    def forward(ctx: Any, x: Tensor, state: Tensor, precision: torch.dtype, *weights: Tensor) -> Tensor:
        """Return the states (h, B, H) after each of the inputs (h, B, n_in), from a state (B, H), unitless."""
        steps, lanes, hidden = len(x), *state.shape
        w_in, w_state, b_in, b_state = (weight.detach() for weight in weights)
        bias = torch.cat([b_in, b_state[2 * hidden :]])
        bias[: 2 * hidden] += b_state[: 2 * hidden]
        inputs, w_state = x.detach(), w_state.to(precision)
        sums, recurrent = torch.empty(lanes, 3 * hidden), torch.empty(lanes, 3 * hidden, dtype=precision)
        gates = torch.empty(steps, lanes, 4 * hidden).numpy()
        states = torch.empty(steps + 1, lanes, hidden)
        rounded = torch.empty(steps + 1, lanes, hidden, dtype=precision)
        states[0] = rounded[0] = state.detach()
        found, given, fed, low = states.numpy(), sums.numpy(), memory(recurrent), memory(rounded)
        for k, (new, before) in enumerate(zip(inputs.unbind(), rounded[:-1].unbind(), strict=True)):
            product(new, w_in.T, out=sums)  # in float32: rounded inputs would cost likelihood
            product(before, w_state.T, out=recurrent)
            step_forward(given, fed, bias.numpy(), found[k], gates[k], found[k + 1], low[k + 1])
        ctx.kept = inputs, w_state, gates, found, rounded[:-1]
        return states[1:]

    @staticmethod
    def backward(ctx: Any, *gradients: Tensor) -> tuple[Tensor | None, ...]:
        """Return the gradients of the weights from that of the states (h, B, H), unitless."""
        inputs, w_state, gates, states, rounded = ctx.kept
        given = gradients[0].contiguous().numpy()
        steps, lanes, hidden = given.shape
        d_sums, d_new = (rounded.new_empty(steps, lanes, width) for width in (3 * hidden, hidden))
        d_bias, carried = torch.zeros(4 * hidden), torch.zeros(lanes, hidden).numpy()
        fed = rounded.new_zeros(lanes, hidden)
        sums, new, after = memory(d_sums), memory(d_new), memory(fed)
        for k in reversed(range(steps)):
            step_backward(gates[k], states[k], given[k], after, carried, sums[k], new[k], d_bias.numpy())
            product(d_sums[k], w_state, out=fed)
        d_sums, d_new, inputs = d_sums.flatten(0, 1).T, d_new.flatten(0, 1).T, inputs.flatten(0, 1).to(rounded.dtype)
        d_in = torch.cat([product(d_sums[: 2 * hidden], inputs), product(d_new, inputs)])
        d_state = product(d_sums, rounded.flatten(0, 1))
        reset_update, inner, last = d_bias.split([2 * hidden, hidden, hidden])
        d_biases = torch.cat([reset_update, last]), torch.cat([reset_update, inner])
        return None, None, None, d_in.float(), d_state.float(), *d_biases


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


def product(a: Tensor, b: Tensor, out: Tensor | None = None) -> Tensor:
    """Return the product (m, n) of two matrices (m, k) and (k, n) of one format; NumPy is the faster one in float32."""
    if a.dtype == torch.float32:
        return torch.from_numpy(np.matmul(a.numpy(), b.numpy(), out=None if out is None else out.numpy()))
    return torch.mm(a, b, out=out)


def memory(tensor: Tensor) -> NDArray[Any]:
    """Return a tensor's memory for compiled loops: float32 as it is, bfloat16, which NumPy lacks, as uint16."""
    return tensor.numpy() if tensor.dtype == torch.float32 else tensor.view(torch.uint16).numpy()
