"""Stacked GRUs over a stretch of time, forward and back: what `torch.nn.GRU` computes, for K networks at once."""

from typing import Any

import torch
from torch import Tensor

from mobnet.learning.stacked.gates import gates_of


class StackedGru(torch.autograd.Function):
    """GRUs over a stretch of time with a hand-written backward pass, to the weights alone."""

    @staticmethod
    def forward(ctx: Any, x: Tensor, state: Tensor, *weights: Tensor) -> Tensor:
        """Return the states (K, h, B, H) after each of the inputs (K, h, B, n_in), from a state (K, B, H), unitless.

        The weights are those of `torch.nn.GRU`, one network behind the other: W_i (K, 3 H, n_in), W_h (K, 3 H, H), b_i
        and b_h (K, 3 H).
        """
        w_in, w_state, b_in, b_state = weights
        networks, steps, lanes, _ = x.shape
        hidden = state.shape[2]
        from_inputs = torch.baddbmm(b_in[:, None], x.flatten(1, 2), w_in.mT).view(networks, steps, lanes, -1)
        states = x.new_empty(networks, steps + 1, lanes, hidden)
        states[:, 0] = state
        kept = x.new_empty(networks, steps, lanes, 4 * hidden)
        gates = gates_of(x.device)
        bias = b_state[:, None]
        turned = w_state.mT
        for step in range(steps):
            last = states[:, step]
            from_state = torch.baddbmm(bias, last, turned)
            gates.forward(from_inputs[:, step], from_state, last, states[:, step + 1], kept[:, step])
        ctx.save_for_backward(x, states, kept, w_state)
        return states[:, 1:]

    @staticmethod
    def backward(ctx: Any, *gradients: Tensor) -> tuple[Tensor | None, ...]:
        """Return the gradients of the weights from that of the states (K, h, B, H), unitless."""
        x, states, kept, w_state = ctx.saved_tensors
        given = gradients[0].contiguous()
        networks, steps, lanes, hidden = given.shape
        sums = torch.empty_like(kept)
        later = x.new_zeros(networks, lanes, hidden)
        earlier = torch.empty_like(later)
        gates = gates_of(x.device)
        for step in range(steps - 1, -1, -1):
            gates.back(later, given[:, step], kept[:, step], states[:, step], sums[:, step], earlier)
            later = torch.baddbmm(earlier, sums[:, step, :, : 3 * hidden], w_state)
        flat = sums.flatten(1, 2)
        of_state = flat[..., : 3 * hidden]  # r, z and the state's part of n
        d_state = of_state.mT @ states[:, :-1].flatten(1, 2)
        inputs = x.flatten(1, 2)
        d_in = torch.cat([flat[..., : 2 * hidden].mT @ inputs, flat[..., 3 * hidden :].mT @ inputs], 1)
        whole = flat.sum(1)
        d_b_in = torch.cat([whole[:, : 2 * hidden], whole[:, 3 * hidden :]], 1)
        return None, None, d_in, d_state, d_b_in, whole[:, : 3 * hidden]
