"""Several limb networks run as one: the six independent networks of section 4.1 with their outputs concatenated."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.joints import JointLayout
from mobnet.core.recording import Sensed
from mobnet.learning.deployed.networks import Array, GruNetwork, GruNetworks, Prediction, Runnable
from mobnet.learning.features import signal_names, signals

State = tuple[Any, ...]  # of each network but GRUs, then of all GRUs together


class LimbNetworks:
    """Limb networks side by side, Figure 2 (b); `joints` are the names of all their joints, (n,), in their order."""

    def __init__(self, networks: Sequence[Runnable], layout: JointLayout) -> None:
        """Find each network's inputs among the robot's signals."""
        self.networks = tuple(networks)
        self.joints = tuple(chain.from_iterable(network.joints for network in networks))
        self._columns = [_columns(network, layout) for network in networks]
        grus = {k: network for k, network in enumerate(self.networks) if isinstance(network, GruNetwork)}
        others = {k: network for k, network in enumerate(self.networks) if k not in grus}
        self._steppers: list[Any] = [_Alone(network, self._columns[k]) for k, network in others.items()]
        if grus:
            self._steppers.append(GruNetworks(list(grus.values()), [self._columns[k] for k in grus]))
        of = np.repeat(np.arange(len(self.networks)), [len(network.joints) for network in self.networks])
        # Numbers come stepper after stepper: where that of each joint stands among them.
        ranks = {k: rank for rank, k in enumerate((*others, *grus))}
        self._order = np.argsort(np.argsort([ranks[int(k)] for k in of], kind="stable"))

    def init(self) -> State:
        """Return the states before the first sample."""
        return tuple(stepper.init() for stepper in self._steppers)

    def step(self, state: State, sample: Sensed) -> tuple[State, Prediction]:
        """Take one sample (1-D arrays); return the new states and the prediction (n,) [N, N m]."""
        # The six networks share the pelvis' inputs and each other's joints (Figure 2), so signals are made once.
        x = signals(sample)
        stepped = [stepper.step(carried, x) for stepper, carried in zip(self._steppers, state, strict=True)]
        joined = _joined([prediction for _, prediction in stepped])
        std = None if joined.std is None else joined.std[self._order]
        return tuple(after for after, _ in stepped), Prediction(joined.mean[self._order], std)

    def run_all(self, recordings: Sequence[Sensed]) -> list[Prediction]:
        """Run over contiguous recordings side by side, each from fresh states; return (T_i, n) [N, N m] of each."""
        seen = [signals(sensed) for sensed in recordings]
        limbs = list[Sequence[Prediction]]()
        for network, columns in zip(self.networks, self._columns, strict=True):
            inputs = [x[:, columns] for x in seen]
            limbs.append(network.run_all(inputs))
        return [_joined(predictions) for predictions in zip(*limbs, strict=True)]


@dataclass(frozen=True)
class _Alone:
    """A network that advances by itself; its inputs stand in `columns` (n_in,) of the signals."""

    network: Runnable
    columns: NDArray[np.intp]

    def init(self) -> Any:
        """Return the network's state before the first sample."""
        return self.network.init()

    def step(self, state: Any, x: Array) -> tuple[Any, Prediction]:
        """Advance by one sample of the signals; return the new state and the prediction (n,) [N, N m]."""
        return self.network.step(state, x[self.columns])


def _columns(network: Runnable, layout: JointLayout) -> NDArray[np.intp]:
    """Return where a network's inputs stand in `signals`, (n_in,)."""
    where = {name: i for i, name in enumerate(signal_names(layout))}
    return np.array([where[name] for name in network.input_names], dtype=np.intp)


def _joined(predictions: Sequence[Prediction]) -> Prediction:
    if len(predictions) == 1:
        return predictions[0]
    mean = np.concatenate([p.mean for p in predictions], axis=-1)
    stds = [p.std for p in predictions if p.std is not None]
    return Prediction(mean, np.concatenate(stds, axis=-1) if stds else None)
