"""The samples of stacked networks on the device that trains, and the plans of an epoch side by side."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from mobnet.learning.dataset import ZScore
from mobnet.learning.schedule import Schedule
from mobnet.learning.streams import EpochPlan


class StackedSamples:
    """Inputs and targets of K networks: recordings once, each network with its own rows and z-scores."""

    def __init__(
        self, arrays: Sequence[tuple[Tensor, Tensor]], places: Sequence[int], schedules: Sequence[Schedule]
    ) -> None:
        """Take inputs (N, n_in) and targets (N, n) [N, N m] on the device, and at which place a network has its own."""
        lengths = [0, *(len(inputs) for inputs, _ in arrays[:-1])]
        first_rows = np.cumsum(lengths)
        self._inputs = torch.cat([inputs for inputs, _ in arrays])
        self._targets = torch.cat([targets for _, targets in arrays])
        self.device = self._inputs.device
        self._offsets = torch.from_numpy(first_rows[list(places)]).to(self.device)[:, None, None]
        self._scales = [_stacked([schedule.scales[side] for schedule in schedules], self.device) for side in (0, 1)]
        self.partial = schedules[0].partial

    @property
    def joints(self) -> int:
        """Number of targets of each network."""
        return self._targets.shape[1]

    def take(self, rows: Tensor, steps: Tensor) -> tuple[Tensor, Tensor]:
        """Return z-scored inputs (K, h, B, n_in) and targets (K, h, B, n) of horizons.

        `rows` (K, B) are the first ones of each network's own data, `steps` (h,) the distances from there [samples].
        """
        index = self._offsets + rows[:, None, :] + steps[None, :, None]
        flat = index.flatten()
        taken: list[Tensor] = []
        for array, (mean, std) in zip((self._inputs, self._targets), self._scales, strict=True):
            taken.append((array.index_select(0, flat).view(*index.shape, -1) - mean) / std)
        return taken[0], taken[1]


def _stacked(scales: Sequence[ZScore], device: torch.device) -> tuple[Tensor, Tensor]:
    """Return means and standard deviations (K, 1, 1, n) of z-scores."""
    means = torch.from_numpy(np.stack([scale.mean for scale in scales])).to(device)
    stds = torch.from_numpy(np.stack([scale.std for scale in scales])).to(device)
    return means[:, None, None], stds[:, None, None]


@dataclass(frozen=True)
class StackedPlan:
    """The plans of K networks through an epoch, which is as long as the longest of them.

    Attributes:
        rows: first row of each horizon in a network's own data, (updates, K, lanes).
        fresh: True where a lane enters a stream, (updates, K, lanes).
        active: True where a network still has an update to do, (updates, K).
        used: True where a network has a lane, (K, lanes).
        stride: distance between two steps of a horizon [samples].
    """

    rows: Tensor
    fresh: Tensor
    active: Tensor
    used: Tensor
    stride: int

    def __len__(self) -> int:
        return len(self.rows)


def side_by_side(plans: Sequence[EpochPlan], device: torch.device) -> StackedPlan:
    """Return plans of one stride side by side; a network whose plan has ended, or has fewer lanes, sees its row 0."""
    updates = max(len(plan) for plan in plans)
    lanes = max(plan.rows.shape[1] for plan in plans)
    rows = np.zeros((updates, len(plans), lanes), np.int64)
    fresh = np.ones(rows.shape, bool)
    active = np.zeros((updates, len(plans)), bool)
    used = np.zeros((len(plans), lanes), bool)
    for k, plan in enumerate(plans):
        width = plan.rows.shape[1]
        rows[: len(plan), k, :width] = plan.rows
        fresh[: len(plan), k, :width] = plan.fresh
        active[: len(plan), k] = True
        used[k, :width] = True
    arrays = (torch.from_numpy(array).to(device) for array in (rows, fresh, active, used))
    return StackedPlan(*arrays, stride=plans[0].stride)
