"""The cells of stacked networks: what `cells` has, for K networks at once.

Weights are those of a `LimbNetwork`'s cell, one network behind the other, by their names there. All numbers are
unitless; the state of a stack is (K, rows, B, columns).
"""

from collections.abc import Mapping
from typing import Any, Protocol

import torch
from torch import Tensor, nn

from mobnet.learning.cells import Carried, CellModule, Gru, Lstm, WindowCell
from mobnet.learning.stacked.gates import gates_of

Weights = Mapping[str, Tensor]
GRU_WEIGHTS = tuple(f"cell.{name}_l0" for name in ("weight_ih", "weight_hh", "bias_ih", "bias_hh"))


class StackedCell(Protocol):
    """What a stacked network needs of its cells."""

    def run(self, weights: Weights, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
        """Return features (K, h, B, width) of inputs (K, h, B, n_in), and the state (K, rows, B, columns) after."""
        ...


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


class GruCells:
    """GRUs, whose gates are one kernel each way on a GPU."""

    def run(self, weights: Weights, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
        """See `StackedCell`."""
        states = StackedGru.apply(x, state[:, 0], *(weights[name] for name in GRU_WEIGHTS))
        return states, states[:, None, -1].detach()


class LoopedCells:
    """LSTMs, or vanilla recurrent networks: a loop in torch's own operations."""

    def __init__(self, *, has_memory: bool) -> None:
        """Build LSTMs, which have a cell state, or networks without one."""
        self._has_memory = has_memory

    def run(self, weights: Weights, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
        """See `StackedCell`."""
        w_in, w_state, b_in, b_state = (weights[name] for name in GRU_WEIGHTS)
        from_inputs = torch.baddbmm(b_in[:, None], x.flatten(1, 2), w_in.mT).unflatten(1, x.shape[1:3])
        bias = b_state[:, None]
        hidden = state[:, 0]
        memory = state[:, -1]
        states: list[Tensor] = []
        for step in range(x.shape[1]):
            sums = torch.baddbmm(bias, hidden, w_state.mT) + from_inputs[:, step]
            if self._has_memory:
                take, keep, new, show = sums.chunk(4, -1)
                memory = keep.sigmoid() * memory + take.sigmoid() * new.tanh()
                hidden = show.sigmoid() * memory.tanh()
            else:
                hidden = sums.tanh()
            states.append(hidden)
        after = torch.stack([hidden, memory], 1) if self._has_memory else hidden[:, None]
        return torch.stack(states, 1), after.detach()


class WindowCells:
    """Cells that see windows: each network's own module, mapped over the networks."""

    def __init__(self, cell: WindowCell) -> None:
        """Take one of the cells, for its shape."""
        self._runner = _Runner(cell)

    def run(self, weights: Weights, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
        """See `StackedCell`."""
        cell_weights = {name: weight for name, weight in weights.items() if name.startswith("cell.")}

        def of_network(weights: dict[str, Tensor], x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
            return torch.func.functional_call(self._runner, weights, (x, state))

        return torch.vmap(of_network, randomness="different")(cell_weights, x, state)


class _Runner(nn.Module):
    """A module whose call runs a cell."""

    def __init__(self, cell: WindowCell) -> None:
        super().__init__()
        self.cell = cell

    def forward(self, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
        return self.cell.run(x, state)


def stacked_cell(cell: CellModule) -> StackedCell:
    """Return the cells of a stack, of which `cell` is one."""
    if isinstance(cell, Gru):
        return GruCells()
    if isinstance(cell, WindowCell):
        return WindowCells(cell)
    assert isinstance(cell, Carried)
    return LoopedCells(has_memory=isinstance(cell, Lstm))
