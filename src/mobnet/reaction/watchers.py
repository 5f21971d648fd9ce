"""Detectors in the pipeline: of swinging legs (section 5.3), of what nothing should touch, and by feet's sensors."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.estimator import Estimate, TorqueEstimator
from mobnet.core.recording import Sensed
from mobnet.detection.chain import Chain, ChainState, advance_chain, chain_state
from mobnet.detection.detector import DetectorState, LegDetector, LegGate
from mobnet.detection.gate import gate_state
from mobnet.detection.signals import Watched
from mobnet.reaction.contacts import Ends, end_effectors, make_ends, unexpected_force, unexpected_forces
from mobnet.reaction.numbers import WrenchDamping
from mobnet.robot.description import RobotDescription

Columns = NDArray[Any]


def some(estimate: Estimate, columns: Columns) -> Estimate:
    """Return the estimate of some joints (..., n) [N, N m]."""
    # NumPy takes five times as long for the columns of one sample where an ellipsis stands before them.
    places = columns if estimate.tau_ext.ndim == 1 else (..., columns)
    return Estimate(estimate.tau_ext[places], None if estimate.std is None else estimate.std[places])


@dataclass(frozen=True)
class LegWatcher:
    """A leg's detector on the estimate of all joints (nv,), of which `columns` are the leg's."""

    detector: LegDetector
    columns: Columns

    def init(self) -> DetectorState:
        """Return the state before the first sample."""
        return self.detector.init()

    def ratio(self, state: DetectorState, sample: Sensed, estimate: Estimate) -> float:
        """Return how far the highest signal lies above its threshold in the watched part of a swing, else zero."""
        of_leg = some(estimate, self.columns)
        return float(self.detector.step(state, sample, of_leg, of_leg.tau_ext).ratio)

    def highest(self, state: DetectorState) -> int:
        """Return the signal that lay highest above its threshold at the last sample, counted from 0."""
        return int(state.chain.place[1])


@dataclass
class OwnState:
    """States of an estimator and of the detector on it."""

    estimator: Any
    detector: DetectorState


@dataclass(frozen=True)
class OwnLegWatcher:
    """A leg's detector on an estimator of its own, of whose joints `held` are the leg's; the gate has the other one."""

    detector: LegDetector
    columns: Columns
    estimator: TorqueEstimator
    held: Columns

    def init(self) -> OwnState:
        """Return the state before the first sample."""
        return OwnState(self.estimator.init(), self.detector.init())

    def ratio(self, state: OwnState, sample: Sensed, estimate: Estimate) -> float:
        """Return how far the highest signal lies above its threshold in the watched part of a swing, else zero."""
        state.estimator, estimate_of_leg = self.estimator.step(state.estimator, sample)
        gating = estimate.tau_ext[self.columns]
        return float(self.detector.step(state.detector, sample, some(estimate_of_leg, self.held), gating).ratio)


@dataclass(frozen=True)
class LimbWatcher:
    """Joints that no intended contact loads, watched by the signals of a detector from some sample on."""

    watched: Watched
    chain: Chain
    columns: Columns
    settle: int = 0

    def init(self) -> ChainState:
        """Return the state before the first sample."""
        return chain_state(self.chain, len(self.watched.detector.signals) * len(self.columns))

    def ratio(self, state: ChainState, sample: Sensed, estimate: Estimate) -> float:
        """Return how far the highest signal lies above its threshold."""
        signals = self.watched.of(some(estimate, self.columns), sample.command)
        is_watched = int(state.place[0]) >= self.settle
        return float(advance_chain(self.chain, state, signals, is_watched, 0.0))

    def highest(self, state: ChainState) -> int:
        """Return the signal that lay highest above its threshold at the last sample, counted from 0."""
        return int(state.place[1])


@dataclass(frozen=True)
class BaseForce:
    """The unexpected force on the base, (24), in base axes, from the estimate of all joints.

    `ends` are room of its own for places and Jacobians. A foot that swings at most height_m [m] above the other one may
    touch the ground.
    """

    ends: Ends
    height_m: float

    @classmethod
    def of(cls, robot: RobotDescription, numbers: WrenchDamping, height_m: float) -> "BaseForce":
        """Return the force on a robot's base."""
        return cls(make_ends(robot, end_effectors(robot), numbers), height_m)

    def step(self, sample: Sensed, estimate: Estimate) -> Estimate:
        """Return force and standard deviation (3,) [N] at one sample, from the estimate of all joints (nv,)."""
        force = np.zeros(3)
        deviation = np.zeros(3)
        self._fill(unexpected_force, sample, estimate, force, deviation)
        return Estimate(force, None if estimate.std is None else deviation)

    def run(self, sensed: Sensed, estimate: Estimate) -> Estimate:
        """Return the same of a stretch (T, 3) [N], from the estimate of all joints (T, nv)."""
        force = np.zeros((len(sensed), 3))
        deviation = np.zeros((len(sensed), 3))
        self._fill(unexpected_forces, sensed, estimate, force, deviation)
        return Estimate(force, None if estimate.std is None else deviation)

    def _fill(self, compute: Any, sensed: Sensed, estimate: Estimate, force: Array, deviation: Array) -> None:
        q = np.ascontiguousarray(sensed.q, dtype=np.float64)
        tau = np.ascontiguousarray(estimate.tau_ext, dtype=np.float64)
        std = np.zeros_like(tau) if estimate.std is None else np.ascontiguousarray(estimate.std, dtype=np.float64)
        swing = np.ascontiguousarray(sensed.swing, dtype=np.float64)
        compute(self.ends, q, tau, std, swing, self.height_m, force, deviation)


@dataclass(frozen=True)
class BaseWatcher:
    """The base, watched all the time by the signals of a detector on the unexpected force."""

    watched: Watched
    chain: Chain
    base: BaseForce

    def init(self) -> ChainState:
        """Return the state before the first sample."""
        return chain_state(self.chain, self.chain.thresholds.shape[1])

    def ratio(self, state: ChainState, sample: Sensed, estimate: Estimate) -> float:
        """Return how far the highest signal lies above its threshold."""
        signals = self.watched.of(self.base.step(sample, estimate), sample.command)
        return float(advance_chain(self.chain, state, signals, True, 0.0))


@dataclass(frozen=True)
class FootWatcher:
    """The force sensor of a foot in its swing, for comparison: `wrenches` (2, 6) are those of the sensors just now."""

    gate: LegGate
    chain: Chain
    columns: Columns
    wrenches: Array

    def init(self) -> DetectorState:
        """Return the state before the first sample."""
        return DetectorState(gate_state(), chain_state(self.chain, 3))

    def ratio(self, state: DetectorState, sample: Sensed, estimate: Estimate) -> float:
        """Return how far the force lies above its threshold in the watched part of a swing, else zero."""
        foot = self.gate.foot
        gate = self.gate
        q = np.asarray(sample.q, dtype=np.float64)
        tau = estimate.tau_ext[self.columns].astype(np.float64)
        times = float(sample.swing[foot]), float(sample.landing[foot])
        is_watched = gate.step(state.gate, q, tau, *times)
        return float(advance_chain(self.chain, state.chain, self.wrenches[foot, :3], is_watched, state.gate.phase))
