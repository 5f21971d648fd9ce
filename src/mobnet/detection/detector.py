"""A detector of collisions with one leg: sample by sample in a closed loop, or over a stretch with the same flags.

It runs on the estimate of any method. Flags come from the gate, the low-pass, the thresholds and the time for which
these must be exceeded (section 5.3).
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.columns import FEET
from mobnet.core.estimator import Estimate
from mobnet.core.machine_code import HeldValue, hold
from mobnet.core.recording import Sensed, SensedRecording
from mobnet.detection.chain import Chain, ChainState, advance_chain, chain_state, run_chain
from mobnet.detection.gate import Gate, Spans, advance_held, gate_state, make_gate, run_gate
from mobnet.detection.leg import Leg, make_leg
from mobnet.detection.signals import Watched
from mobnet.kernel.detecting import GateNumbers
from mobnet.robot.description import RobotDescription

ALARM_RATIO = 1.0  # of a signal to its threshold: above it there is a collision


class GateSignal(NamedTuple):
    """What a gate says of samples: whether the leg is watched (T,), and the phase of its swing (T,) [-]."""

    watched: NDArray[np.bool_]
    phase: Array


class DetectorOutput(NamedTuple):
    """What a detector says of samples (T,), or of one: ratio to the threshold, above 1 a collision; the signal."""

    ratio: Any
    signal: Any


class DetectorState(NamedTuple):
    """State of a detector."""

    gate: Any
    chain: ChainState


@dataclass(frozen=True)
class LegGate:
    """The gate of a leg: `foot` is the column of its foot in the plan's signals."""

    gate: Gate
    leg: Leg
    foot: int

    @classmethod
    def of(cls, numbers: GateNumbers, robot: RobotDescription, limb: str, rate_hz: float) -> "LegGate":
        """Return the gate of a leg at a rate of samples [Hz]; a ConfigError names a limb that is no leg."""
        # Recordings hold the signals of the feet that the robot has, in the order of FEET.
        leg = make_leg(robot, limb)
        sides = {name: side for side, name in robot.layout.legs.items()}
        feet = [foot for foot in FEET if foot.removesuffix("_foot") in robot.layout.legs]
        return cls(make_gate(numbers, rate_hz), leg, feet.index(f"{sides[limb]}_foot"))

    @cached_property
    def _held(self) -> HeldValue:
        """Gate and leg, taken apart once: they have many fields."""
        return hold((self.gate, self.leg))

    def step(self, state: Any, q: Array, tau: Array, swing: float, landing: float) -> bool:
        """Take one sample as `advance_gate` does; return whether the leg is watched. The state is changed in place."""
        return advance_held(self._held, state, q, tau, swing, landing)

    def watch(self, recording: SensedRecording, tau: NDArray[Any]) -> GateSignal:
        """Return when the leg is watched in a recording, tau (T, 6) [N m] being the estimate of its joints."""
        signal = GateSignal(np.zeros(len(tau), dtype=bool), np.zeros(len(tau)))
        for span in recording.spans():
            signal.watched[span], signal.phase[span] = self.run(recording.sensed[span], tau[span])
        return signal

    def run(self, sensed: Sensed, tau: NDArray[Any]) -> GateSignal:
        """Return the same of a contiguous stretch."""
        signal = GateSignal(np.zeros(len(sensed), dtype=bool), np.zeros(len(sensed)))
        q = np.asarray(sensed.q, dtype=np.float64)
        torque = np.ascontiguousarray(tau, dtype=np.float64)
        swing, landing = (np.asarray(part[:, self.foot], dtype=np.float64) for part in (sensed.swing, sensed.landing))
        run_gate(self.gate, self.leg, gate_state(), q, torque, swing, landing, *signal)
        return signal


def run_segments(chain: Chain, signals: Array, gate: GateSignal, segments: Spans) -> DetectorOutput:
    """Run a chain over the signals (T, m) of a recording, each contiguous segment from rest."""
    alarm = DetectorOutput(np.zeros(len(signals)), np.zeros(len(signals), dtype=np.int64))
    # Between two segments the robot fell or was set anew, so that nothing of one is held in the next.
    for start, end in segments:
        part = GateSignal(gate.watched[start:end], gate.phase[start:end])
        alarm.ratio[start:end], alarm.signal[start:end] = run_over(chain, signals[start:end], part)
    return alarm


@dataclass(frozen=True)
class LegDetector:
    """A detector with its thresholds."""

    watched: Watched
    gate: LegGate
    chain: Chain

    def init(self) -> DetectorState:
        """Return the state before the first sample."""
        signals = len(self.watched.detector.signals) * len(self.gate.leg.load)
        return DetectorState(gate_state(), chain_state(self.chain, signals))

    def step(self, state: DetectorState, sample: Sensed, estimate: Estimate, gating: NDArray[Any]) -> DetectorOutput:
        """Take one sample (1-D arrays), the estimate of the leg's joints (6,) and that of the gate's method (6,) [N m].

        The state is changed in place.
        """
        foot = self.gate.foot
        q = np.asarray(sample.q, dtype=np.float64)
        tau = np.asarray(gating, dtype=np.float64)
        swing = float(sample.swing[foot])
        landing = float(sample.landing[foot])
        # The gate has the estimate of one method for all detectors, so that they differ by their signals alone.
        is_watched = self.gate.step(state.gate, q, tau, swing, landing)
        signals = self.watched.of(estimate, sample.command)
        phase = float(state.gate["phase"])  # by its name: NumPy takes seven times as long for an attribute of a record
        ratio = advance_chain(self.chain, state.chain, signals, is_watched, phase)
        return DetectorOutput(ratio, int(state.chain.place[1]))

    def run(self, gate: GateSignal, sensed: Sensed, estimate: Estimate) -> DetectorOutput:
        """Return what the detector says of a contiguous stretch (T,), of which the gate has run."""
        return run_over(self.chain, self.watched.of(estimate, sensed.command), gate)


def run_over(chain: Chain, signals: Array, gate: GateSignal) -> DetectorOutput:
    """Run a chain over the signals (T, m) of a contiguous stretch from rest."""
    alarm = DetectorOutput(np.zeros(len(signals)), np.zeros(len(signals), dtype=np.int64))
    run_chain(chain, chain_state(chain, signals.shape[1]), signals, *gate, *alarm)
    return alarm
