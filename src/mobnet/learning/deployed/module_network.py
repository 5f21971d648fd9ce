"""Trained networks of any cell of section 6.1 as they run on a robot, by the torch module that was trained."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import torch
from torch import Tensor

from mobnet.learning.deployed.networks import Array, Deployed, Prediction
from mobnet.learning.model import build_network
from mobnet.settings.networks import Cell

CHUNK = 2000  # samples of a recording run at once, so that memory does not grow with its length


class ModuleNetwork(Deployed):
    """A network of any cell with its z-scores, dropout off; the state is the cell's, (rows, 1, columns)."""

    def __init__(self, tensors: Mapping[str, Array], *names: Any, cell: Cell) -> None:
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
        mean, std, state = self._advance(state, x[None])
        return state, self._physical(mean[0], std[0])

    def run(self, x: Array) -> Prediction:
        """Run over a contiguous recording of inputs (T, n_in) from a fresh state; return (T, n) [N, N m]."""
        state, means, stds = self.init(), [], []
        for start in range(0, len(x), CHUNK):
            mean, std, state = self._advance(state, x[start : start + CHUNK])
            means.append(mean)
            stds.append(std)
        return self._physical(np.concatenate(means), np.concatenate(stds))

    @torch.no_grad()
    def _advance(self, state: Tensor, x: Array) -> tuple[Array, Array, Tensor]:
        """Return z-scored mean and standard deviation (T, n) of physical inputs (T, n_in), and the state after."""
        mean, std, state = self._module(torch.from_numpy(self._z_score(x))[:, None], state)
        return mean[:, 0].numpy(), std[:, 0].numpy(), state
