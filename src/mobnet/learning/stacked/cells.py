"""The cells of stacked networks: what `cells` has, for K networks at once.

Weights are those of a `LimbNetwork`'s cell, one network behind the other, by their names there. All numbers are
unitless; the state of a stack is (K, rows, B, columns).
"""

from collections.abc import Mapping
from typing import Protocol

import torch
from torch import Tensor, nn

from mobnet.learning.cells import Carried, CellModule, Gru, Lstm, WindowCell
from mobnet.learning.stacked.gru import StackedGru

Weights = Mapping[str, Tensor]
GRU_WEIGHTS = tuple(f"cell.{name}_l0" for name in ("weight_ih", "weight_hh", "bias_ih", "bias_hh"))


class StackedCell(Protocol):
    """What a stacked network needs of its cells."""

    def run(self, weights: Weights, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
        """Return features (K, h, B, width) of inputs (K, h, B, n_in), and the state (K, rows, B, columns) after."""
        ...


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
        own = {name: weight for name, weight in weights.items() if name.startswith("cell.")}

        def one(weights: dict[str, Tensor], x: Tensor, state: Tensor) -> tuple[Tensor, Tensor]:
            return torch.func.functional_call(self._runner, weights, (x, state))

        return torch.vmap(one, randomness="different")(own, x, state)


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
