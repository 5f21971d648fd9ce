"""The GRU of Table 1 on a CPU, forward and back through time: what `torch.nn.GRU` computes, in less time.

Per step only the recurrent product and one fused loop over the gates remain; the products with the inputs and all
gradients of the weights are one large product each, after the loop. Gates and weights are laid out as `torch.nn.GRU`
documents them: reset, update, new.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

Array = NDArray[np.float32]
compiled = numba.njit(cache=True, error_model="numpy", fastmath={"contract", "nsz", "arcp"})  # NaN stays NaN


@compiled
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


@compiled
def _step_forward(gates: Array, recurrent: Array, bias_new: Array, before: Array, inner: Array, after: Array) -> None:
    """Turn the gates' sums (B, 3 H) into reset, update and new, in place, and write the next state (B, H).

    Args:
        gates: input's share of the gates, biases included; overwritten by the gates.
        recurrent: state's share W_hh h of the gates (B, 3 H).
        bias_new: bias of the new gate's recurrent part (H,).
        before: state before the step (B, H).
        inner: gets the new gate's recurrent part (B, H), for the way back.
        after: gets the state after the step (B, H).
    """
    half = np.float32(0.5)
    hidden = before.shape[1]
    for i in range(before.shape[0]):
        opened, sums = gates[i, : 2 * hidden], recurrent[i, : 2 * hidden]
        for j in range(2 * hidden):
            opened[j] = half + half * rational_tanh(half * (opened[j] + sums[j]))
        new, part = gates[i, 2 * hidden :], inner[i]
        for j in range(hidden):
            part[j] = recurrent[i, 2 * hidden + j] + bias_new[j]
        for j in range(hidden):
            new[j] = rational_tanh(new[j] + opened[j] * part[j])
        for j in range(hidden):
            after[i, j] = new[j] + opened[hidden + j] * (before[i, j] - new[j])


@compiled
def _step_backward(gates: Array, inner: Array, before: Array, carried: Array, d_sums: Array, d_new: Array) -> None:
    """Take the gradient (B, H) of a state through one step.

    Args:
        gates: reset, update and new of the step (B, 3 H).
        inner: new gate's recurrent part (B, H).
        before: state before the step (B, H).
        carried: gradient of the state after the step; overwritten by its direct share for the state before.
        d_sums: gets the gradient of the recurrent sums (B, 3 H).
        d_new: gets the gradient of the new gate's input sum (B, H).
    """
    one = np.float32(1.0)
    hidden = before.shape[1]
    for i in range(before.shape[0]):
        for j in range(hidden):
            reset, update, new = gates[i, j], gates[i, hidden + j], gates[i, 2 * hidden + j]
            d = carried[i, j]
            towards_new = d * (one - update) * (one - new * new)
            d_new[i, j] = towards_new
            d_sums[i, j] = towards_new * inner[i, j] * reset * (one - reset)
            d_sums[i, hidden + j] = d * (before[i, j] - new) * update * (one - update)
            d_sums[i, 2 * hidden + j] = towards_new * reset
            carried[i, j] = d * update


class FusedGru(torch.autograd.Function):
    """GRU over a stretch of time with a hand-written way back through it, to the weights alone."""

    @staticmethod
    def forward(ctx: Any, x: Tensor, state: Tensor, *weights: Tensor) -> Tensor:
        """Return the states (h, B, H) after each of the inputs (h, B, n_in), from a state (B, H)."""
        inputs, first, w_in, w_state, b_in, b_state = (tensor.detach().numpy() for tensor in (x, state, *weights))
        steps, lanes, _ = inputs.shape
        hidden = first.shape[1]
        bias = b_in.copy()
        bias[: 2 * hidden] += b_state[: 2 * hidden]
        gates = inputs.reshape(steps * lanes, -1) @ w_in.T
        gates += bias
        gates = gates.reshape(steps, lanes, 3 * hidden)
        states = np.empty((steps + 1, lanes, hidden), dtype=np.float32)
        states[0] = first
        inner = np.empty((steps, lanes, hidden), dtype=np.float32)
        recurrent = np.empty((lanes, 3 * hidden), dtype=np.float32)
        for k in range(steps):
            np.matmul(states[k], w_state.T, out=recurrent)
            _step_forward(gates[k], recurrent, b_state[2 * hidden :], states[k], inner[k], states[k + 1])
        ctx.kept = inputs, w_state, gates, inner, states
        return torch.from_numpy(states[1:])

    @staticmethod
    def backward(ctx: Any, *gradients: Tensor) -> tuple[Tensor | None, ...]:
        """Return the gradients of the weights from that of the states (h, B, H), unitless."""
        inputs, w_state, gates, inner, states = ctx.kept
        d_states = gradients[0].numpy()
        steps, lanes, hidden = d_states.shape
        d_sums, d_new = np.empty_like(gates), np.empty_like(inner)
        carried = np.zeros((lanes, hidden), dtype=np.float32)
        for k in reversed(range(steps)):
            carried += d_states[k]
            _step_backward(gates[k], inner[k], states[k], carried, d_sums[k], d_new[k])
            carried += d_sums[k] @ w_state
        sums, new = d_sums.reshape(-1, 3 * hidden), d_new.reshape(-1, hidden)
        x, before = inputs.reshape(steps * lanes, -1), states[:-1].reshape(-1, hidden)
        both = sums[:, : 2 * hidden]
        d_bias = sums.sum(axis=0)
        found = (
            np.concatenate([both.T @ x, new.T @ x]),
            sums.T @ before,
            np.concatenate([d_bias[: 2 * hidden], new.sum(axis=0)]),
            d_bias,
        )
        return None, None, *map(torch.from_numpy, found)


def run_gru(cell: nn.GRU, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
    """Run a GRU over a stretch of time: on a CPU by the loops above, on a GPU by torch.

    Args:
        cell: holds the weights.
        x: inputs (h, B, n_in), unitless; they get no gradient on a CPU.
        state: recurrent state (1, B, H); back-propagation is truncated there on a CPU.

    Returns:
        States (h, B, H) and the last of them (1, B, H).
    """
    if x.device.type != "cpu":
        return cell(x, state)
    states = FusedGru.apply(x, state[0], cell.weight_ih_l0, cell.weight_hh_l0, cell.bias_ih_l0, cell.bias_hh_l0)
    return states, states[-1:]
