"""Trained limb networks as they run on a robot: one sample at a time, those of MOB-Net without torch.

Small matrix-vector products at batch 1 cost less than a call into torch; weights are laid out as `torch.nn.GRU`
documents them. The other cells of section 6.1 run by the module that was trained.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from mobnet.core.machine import one_thread
from mobnet.learning.deployed.tensors import GRU_TENSORS, Z_SCORES, std_scale_of

Array = NDArray[np.float32]


@dataclass(frozen=True)
class Prediction:
    """Predicted torque and its standard deviation, (n,) or (T, n) [N, N m], eq. (18)."""

    mean: NDArray[Any]
    std: NDArray[Any] | None = None


class Runnable(Protocol):
    """A limb network that runs: one of `Deployed`, or one that was exported."""

    limb: str
    joints: tuple[str, ...]
    input_names: tuple[str, ...]

    def init(self) -> Any:
        """Return the state before the first sample."""
        ...

    def step(self, state: Any, x: Array) -> tuple[Any, Prediction]:
        """Advance by one sample of inputs (n_in,); return the new state and the prediction (n,) [N, N m]."""
        ...

    def run_all(self, lanes: Sequence[Array]) -> list[Prediction]:
        """Run over contiguous recordings of inputs (T_i, n_in), each from a fresh state; return (T_i, n) [N, N m]."""
        ...


class Deployed(ABC):
    """A trained network: physical inputs in, torques [N, N m] out, its state carried by the caller.

    `joints` (n,) and `input_names` (n_in,) are names.
    """

    def __init__(
        self,
        tensors: Mapping[str, Array],
        limb: str,
        joints: tuple[str, ...],
        input_names: tuple[str, ...],
        std_min: float,
    ) -> None:
        """Take the z-scores; each kind also takes its weights, which have the names that torch gives them.

        Tensors are `cell.*`, `head.*`, `input.mean|std` (n_in,), `target.mean|std` (n,) [N, N m] and, perhaps,
        `std.scale` (n,); `std_min`, the smallest standard deviation, is z-scored.
        """
        one_thread()
        self.limb = limb
        self.joints = joints
        self.input_names = input_names
        self.std_min = np.float32(std_min)
        self._input_mean, self._input_std, self._target_mean, self._target_std = (
            np.asarray(tensors[name], dtype=np.float32) for name in Z_SCORES
        )
        self._std_unit: Array = self._target_std * std_scale_of(tensors)

    @abstractmethod
    def init(self) -> Any:
        """Return the state before the first sample."""

    @abstractmethod
    def step(self, state: Any, x: Array) -> tuple[Any, Prediction]:
        """Advance by one sample of inputs (n_in,); return the new state and the prediction (n,) [N, N m]."""

    @abstractmethod
    def run_all(self, lanes: Sequence[Array]) -> list[Prediction]:
        """Run over contiguous recordings of inputs (T_i, n_in), each from a fresh state; return (T_i, n) [N, N m]."""

    def _z_score(self, x: Array) -> Array:
        return (x - self._input_mean) / self._input_std

    def _physical(self, mean: Array, std: Array) -> Prediction:
        # (N11). The factor of the calibration is on sigma alone.
        return Prediction(mean * self._target_std + self._target_mean, std * self._std_unit)

    def _predict(self, output: Array) -> Prediction:
        """Return the prediction in physical units from the linear layer's output (..., 2 n)."""
        n = len(self.joints)
        mean = output[..., :n]
        raw = output[..., n:]
        # (N10) by log(exp(raw) + exp(0)), which does not overflow.
        return self._physical(mean, np.maximum(np.logaddexp(raw, 0.0, dtype=np.float32), self.std_min))


class ConstantNetwork(Deployed):
    """The same mean and standard deviation at every sample: cell `constant`; there is no state."""

    def __init__(self, tensors: Mapping[str, Array], *names: Any) -> None:
        super().__init__(tensors, *names)
        self._output = np.asarray(tensors["head.bias"], dtype=np.float32)
        self._prediction = self._predict(self._output)

    def init(self) -> None:
        """Return the state before the first sample, none."""

    def step(self, state: None, x: Array) -> tuple[None, Prediction]:
        """Return no state and the prediction (n,) [N, N m], whatever the inputs (n_in,)."""
        return None, self._prediction

    def run_all(self, lanes: Sequence[Array]) -> list[Prediction]:
        """Return the predictions (T_i, n) [N, N m] for as many samples as the inputs (T_i, n_in) have."""
        return [self._predict(np.tile(self._output, (len(x), 1))) for x in lanes]


class GruNetwork(Deployed):
    """GRU-Linear of Table 1 with its z-scores, one compiled loop a time step.

    A step adds up in room that belongs to the network, so that steps of one network must not run at the same time.
    """

    def __init__(self, tensors: Mapping[str, Array], *names: Any) -> None:
        # Compiled code, which takes a second to import: the workflow reads this module whenever it starts.
        from mobnet.learning.deployed.tick import GruWeights, advance
        from mobnet.learning.gates import ordered

        super().__init__(tensors, *names)
        *self._as_trained, self._w_out, self._b_out = (
            np.ascontiguousarray(tensors[name], dtype=np.float32) for name in GRU_TENSORS
        )
        w_in, w_state, bias = ordered(*self._as_trained)
        self.hidden = w_state.shape[1]
        room = np.empty(w_in.shape[1], dtype=np.float32), np.empty(len(bias), dtype=np.float32)
        inputs = (self._input_mean, self._input_std)
        targets = (self._target_mean, self._target_std, self._std_unit)
        self.weights = GruWeights(w_in, w_state, bias, self._w_out, self._b_out, *inputs, *targets, self.std_min, *room)
        self._advance = advance

    def init(self) -> Array:
        """Return the zero state (hidden,)."""
        return np.zeros(self.hidden, dtype=np.float32)

    def step(self, state: Array, x: Array) -> tuple[Array, Prediction]:
        """Advance by one sample of inputs (n_in,); return the new state (hidden,) and the prediction (n,) [N, N m]."""
        after = np.empty_like(state)
        (mean, std) = np.empty((2, len(self.joints)), dtype=np.float32)
        self._advance(self.weights, state, x, after, mean, std)
        return after, Prediction(mean, std)

    def run_all(self, lanes: Sequence[Array]) -> list[Prediction]:
        """Run over contiguous recordings of inputs (T_i, n_in), each from a fresh state; return (T_i, n) [N, N m]."""
        from mobnet.learning.deployed.lanes import gru_states, side_by_side

        def further(state: Array, x: Array) -> tuple[Array, Array]:
            state, states = gru_states(self._as_trained, state, self._z_score(x))
            return state, states @ self._w_out.T + self._b_out

        fresh = np.zeros((1, len(lanes), self.hidden), dtype=np.float32)
        return [self._predict(output) for output in side_by_side(lanes, fresh, further)]


class GruNetworks:
    """GRU networks with one state (units of all,), which predict to the bit what each predicts by itself.

    As a network does, they add up in room of their own, so that steps must not run at the same time.
    """

    def __init__(self, networks: Sequence[GruNetwork], columns: Sequence[NDArray[np.intp]]) -> None:
        """Join networks of which each has its inputs in columns (n_in,) of the signals."""
        from mobnet.core.machine_code import hold
        from mobnet.learning.deployed.tick import advance_row, row_of

        self._units = sum(network.hidden for network in networks)
        self._joints = sum(len(network.joints) for network in networks)
        self._held = hold(row_of([network.weights for network in networks], columns))
        self._advance = advance_row

    def init(self) -> Array:
        """Return the zero state."""
        return np.zeros(self._units, dtype=np.float32)

    def step(self, state: Array, x: Array) -> tuple[Array, Prediction]:
        """Advance by one sample of the signals; return the new state and what they predict, one after the other."""
        after = np.empty_like(state)
        (mean, std) = np.empty((2, self._joints), dtype=np.float32)
        self._advance(self._held, x, state, after, mean, std)
        return after, Prediction(mean, std)
