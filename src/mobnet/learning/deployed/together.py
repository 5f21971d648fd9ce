"""GRU networks that take a sample in one compiled call: a call for each of them costs half of a step."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from mobnet.core.held import hold
from mobnet.learning.deployed.networks import Array, GruNetwork, Prediction
from mobnet.learning.deployed.tick import advance_row, row_of


class GruNetworks:
    """GRU networks with one state (units of all,), which predict to the bit what each predicts by itself.

    As a network does, they add up in room of their own, so that steps must not run at the same time.
    """

    def __init__(self, networks: Sequence[GruNetwork], columns: Sequence[NDArray[np.intp]]) -> None:
        """Join networks of which each has its inputs in columns (n_in,) of the signals."""
        self._units = sum(network.hidden for network in networks)
        ends = np.cumsum([0, *(len(network.joints) for network in networks)]).tolist()
        self._parts = [slice(*ends) for ends in pairwise(ends)]
        self._width = ends[-1]
        self._held = hold(row_of([network.weights for network in networks], columns))

    def init(self) -> Array:
        """Return the zero state."""
        return np.zeros(self._units, dtype=np.float32)

    def step(self, state: Array, signals: Array) -> tuple[Array, list[Prediction]]:
        """Advance by one sample of the robot's signals; return the new state and each prediction (n,) [N, N m]."""
        after = np.empty_like(state)
        (mean, std) = np.empty((2, self._width), dtype=np.float32)
        advance_row(self._held, signals, state, after, mean, std)
        return after, [Prediction(mean[part], std[part]) for part in self._parts]
