"""The limb network as it is trained: GRU, linear layer, softplus (section 4.1, Table 1)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import torch
from torch import Tensor, nn

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.learning.gru import run_gru

CELLS = {"GRU": nn.GRU}


class LimbNetwork(nn.Module):
    """GRU[n_in, hidden]-Linear[hidden, 2 n] of Table 1; inputs and outputs are z-scored, unitless.

    The paper gives the variance outputs a softplus and clips the standard deviation (section 4.4); here the softplus
    is the standard deviation itself, so that one clip serves both.
    """

    def __init__(self, inputs: int, hidden: int, joints: int, std_min: float, cell: str = "GRU") -> None:
        """Build the network with torch's default initial weights.

        Args:
            inputs: number of inputs n_in.
            hidden: size of the recurrent state.
            joints: number of joints n.
            std_min: smallest standard deviation, z-scored [-].
            cell: recurrent cell.

        Raises:
            ConfigError: the cell is unknown.
        """
        super().__init__()
        if cell not in CELLS:
            raise ConfigError(not_accepted("cell", cell, CELLS))
        self.cell = CELLS[cell](inputs, hidden)
        self.head = nn.Linear(hidden, 2 * joints)
        self.std_min = std_min

    def forward(self, x: Tensor, state: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        """Run over a stretch of time, eq. (18).

        Args:
            x: z-scored inputs (h, B, n_in).
            state: recurrent state (1, B, hidden).

        Returns:
            Mean (h, B, n), standard deviation (h, B, n), both z-scored, and the state after the stretch.
        """
        hidden, state = run_gru(self.cell, x, state)
        mean, raw = self.head(hidden).chunk(2, dim=-1)
        return mean, nn.functional.softplus(raw).clamp_min(self.std_min), state

    def fresh_state(self, lanes: int, device: torch.device | None = None) -> Tensor:
        """Return the zero state (1, B, hidden) of some lanes."""
        return torch.zeros(1, lanes, self.cell.hidden_size, device=device)


def build_network(row: Mapping[str, Any], inputs: int, joints: int, std_min: float, seed: int) -> LimbNetwork:
    """Build the network of a row of Table 1, its initial weights drawn from a seed; torch's own stream is untouched."""
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        return LimbNetwork(inputs, row["hidden"], joints, std_min, row["cell"])


def parameter_count(network: nn.Module) -> int:
    """Return the number of trained parameters, column `Network Size` of Table 1."""
    return sum(p.numel() for p in network.parameters())
