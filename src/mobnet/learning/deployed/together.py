"""GRU networks that take a sample in one compiled call: a call for each of them costs half of a step."""

from collections.abc import Sequence

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
        self._joints = sum(len(network.joints) for network in networks)
        self._held = hold(row_of([network.weights for network in networks], columns))

    def init(self) -> Array:
        """Return the zero state."""
        return np.zeros(self._units, dtype=np.float32)

    def step(self, state: Array, x: Array) -> tuple[Array, Prediction]:
        """Advance by one sample of the signals; return the new state and what they predict, one after the other."""
        after = np.empty_like(state)
        (mean, std) = np.empty((2, self._joints), dtype=np.float32)
        advance_row(self._held, x, state, after, mean, std)
        return after, Prediction(mean, std)
