"""A leg in a recording as its detectors see it: the gate, its swings, and a method's estimate of its joints."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL, STD, named
from mobnet.core.estimator import Estimate
from mobnet.core.joints import JointLayout
from mobnet.core.notes import read_array_note
from mobnet.core.recording import read_sensed
from mobnet.core.store import NOTE, file_of, read_array
from mobnet.detection.chain import Chain, low_passed, make_chain
from mobnet.detection.detector import Alarm, LegGate, Watch, run_segments
from mobnet.detection.swings import Spans, segment_of, swings_of
from mobnet.plan.detection import Walk
from mobnet.robot.description import RobotDescription
from mobnet.settings.detection import Detection

UNKNOWN = "-"  # terrain of a recording that does not say it


@dataclass(frozen=True)
class Watched:
    """A leg in a recording: contiguous segments, when it is watched, its whole swings and the terrain of each."""

    recording: Path
    segments: Spans
    watch: Watch
    swings: Spans
    terrains: tuple[str, ...]

    @property
    def seed(self) -> int:
        """Seed of the recording."""
        return int(self.recording.name.removeprefix("s"))

    @property
    def samples(self) -> int:
        """Number of samples in segments."""
        return sum(end - start for start, end in self.segments)

    def run(self, chain: Chain, signals: Array) -> Alarm:
        """Run a chain over signals (T, m), each segment from rest; return what it says of the samples (T,)."""
        return run_segments(chain, signals, self.watch, self.segments)


@dataclass(frozen=True)
class Leg:
    """A leg of a robot whose detectors are tried: its joints, its gate and the numbers of all detectors."""

    detection: Detection
    robot: RobotDescription
    limb: str
    rate_hz: float
    gate: LegGate

    @classmethod
    def of(cls, detection: Detection, robot: RobotDescription, limb: str, rate_hz: float) -> "Leg":
        """Return a leg; a ConfigError names a limb that is none."""
        return cls(detection, robot, limb, rate_hz, LegGate.of(detection.gate, robot, limb, rate_hz))

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the joints."""
        return self.robot.layout.limb(self.limb)

    @property
    def inward(self) -> float:
        """Direction of the other leg along the y axis."""
        return -1.0 if self.robot.layout.legs.get("left") == self.limb else 1.0

    def chain(self, thresholds: Array, *, norm: bool = False) -> Chain:
        """Return a chain with thresholds (phases, c)."""
        return make_chain(self.detection.low_pass_hz, self.detection.hold_s, self.rate_hz, thresholds, norm=norm)

    def low_passed(self, signals: Array, segments: Spans) -> Array:
        """Return signals (T, m) behind the low-pass of the chain, each segment from rest."""
        pole, out = self.chain(np.ones((1, 1))).pole, np.zeros(signals.shape)
        for start, end in segments:
            low_passed(pole, signals[start:end], out[start:end])
        return out

    def watch(self, walk: Walk) -> list[Watched]:
        """Run the gate over the recordings of a walk; none where the gate's method does not estimate the leg."""
        gating = walk.estimates[self.detection.gate.method]
        found = [self._watch(*pair) for pair in zip(walk.recordings, gating, strict=True)]
        return [one for one in found if one is not None]

    def _watch(self, recording: Path, gating: Path) -> Watched | None:
        """Run the gate over a recording, on an estimate; None if this does not hold the leg's joints."""
        estimate = read_estimate(gating, self.joints)
        if estimate is None:
            return None
        read = read_sensed(recording, self.robot.layout)
        watch = self.gate.watch(read, estimate.tau_ext)
        swings = swings_of(read.sensed.swing[:, self.gate.foot], read.segments)
        terrains = read.meta.get("terrains") or [UNKNOWN] * len(read.segments)
        walked = tuple(terrains[segment_of(swing, read.segments)] for swing in swings)
        return Watched(recording, read.segments, watch, swings, walked)


def read_estimate(stem: Path, joints: Sequence[str]) -> Estimate | None:
    """Return the estimate of some joints (T, n) [N m], with what std it has; None where it does not hold them."""
    held = {column["name"] for column in read_array_note(file_of(stem, NOTE))["columns"]}
    if not held.issuperset(named(EXTERNAL, joints)):
        return None
    std = read_array(stem, named(STD, joints))[0] if held.issuperset(named(STD, joints)) else None
    return Estimate(read_array(stem, named(EXTERNAL, joints))[0], std)


def read_positions(recording: Path, layout: JointLayout, rows: Sequence[int]) -> NDArray[Any]:
    """Return the generalized positions of some samples of a recording (n, nq) [m, -, rad]."""
    return read_sensed(recording, layout).sensed.q[list(rows)]
