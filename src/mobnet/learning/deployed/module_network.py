"""Trained networks of any cell of section 6.1 as they run on a robot, by the torch module that was trained."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import torch
from torch import Tensor

from mobnet.formats.network import NetworkCell
from mobnet.learning.deployed.lanes import side_by_side
from mobnet.learning.deployed.networks import Array, Deployed, Prediction
from mobnet.learning.model import build_network


class ModuleNetwork(Deployed):
    """A network of any cell with its z-scores, dropout off; the state is the cell's, (rows, 1, columns)."""

    def __init__(self, tensors: Mapping[str, Array], *names: Any, cell: NetworkCell) -> None:
        """Build the module of a cell and load its weights; `names` are the other arguments of `Deployed`."""
        super().__init__(tensors, *names)
        sizes = len(self.input_names), len(self.joints), float(self.std_min)
        self._module = build_network(cell, *sizes, seed=0).eval()
        weights = {name: tensor for name, tensor in tensors.items() if name.startswith(("cell.", "head."))}
        self._module.load_state_dict({name: torch.from_numpy(np.array(tensor)) for name, tensor in weights.items()})

    def init(self) -> Tensor:
        """Return the zero state (rows, 1, columns)."""
        return self._module.fresh_state(1)

    def step(self, state: Tensor, x: Array) -> tuple[Tensor, Prediction]:
        """Advance by one sample of inputs (n_in,); return the new state and the prediction (n,) [N, N m]."""
        state, output = self._advance(state, x[None, None])
        return state, self._physical(*np.split(output[0, 0], 2))

    def run_all(self, lanes: Sequence[Array]) -> list[Prediction]:
        """Run over contiguous recordings of inputs (T_i, n_in), each from a fresh state; return (T_i, n) [N, N m]."""
        outputs = side_by_side(lanes, self._module.fresh_state(len(lanes)), self._advance)
        return [self._physical(*np.split(output, 2, axis=-1)) for output in outputs]

    @torch.no_grad()
    def _advance(self, state: Tensor, x: Array) -> tuple[Tensor, Array]:
        """Return the state after physical inputs (h, B, n_in), and z-scored mean and std side by side (h, B, 2 n)."""
        mean, std, state = self._module(torch.from_numpy(self._z_score(x)), state)
        return state, torch.cat([mean, std], dim=-1).numpy()
