"""A limb in a recording as its detectors see it: the gate, its swings, and a method's estimate of its joints."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.columns import EXTERNAL, STD, named
from mobnet.core.estimator import Estimate
from mobnet.core.notes import read_array_note
from mobnet.core.recording import SensedRecording
from mobnet.core.recording_file import read_sensed
from mobnet.core.store import NOTE, file_of, read_array
from mobnet.detection.chain import Chain, low_passed, make_chain
from mobnet.detection.detector import DetectorOutput, GateSignal, LegGate, run_segments
from mobnet.detection.gate import Spans, segment_of, swings_of
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import GateNumbers
from mobnet.robot.description import RobotDescription
from mobnet.settings.detection import Detection

UNKNOWN = "-"  # terrain of a recording that does not say it


@dataclass(frozen=True)
class LegRecording:
    """A leg in a recording: contiguous segments, commands (T, 5), its gate, its whole swings, the terrain of each.

    Of a limb that is watched all the time, windows take the place of swings. Swings of one `episodes` are not
    independent of each other; without any, segments are episodes.
    """

    recording: Path
    segments: Spans
    command: NDArray[Any]
    gate: GateSignal
    swings: Spans
    terrains: tuple[str, ...]
    episodes: Spans = ()

    @property
    def seed(self) -> int:
        """Seed of the recording."""
        return int(self.recording.name.removeprefix("s"))

    @property
    def samples(self) -> int:
        """Number of samples in segments."""
        return sum(end - start for start, end in self.segments)

    def run(self, chain: Chain, signals: Array) -> DetectorOutput:
        """Run a chain over signals (T, m), each segment from rest; return what it says of the samples (T,)."""
        return run_segments(chain, signals, self.gate, self.segments)


@dataclass(frozen=True)
class LimbSetup:
    """What all detectors of a limb share: its joints, the filters, and the rate of samples [Hz]."""

    detection: Detection
    robot: RobotDescription
    limb: str
    rate_hz: float

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the joints."""
        return self.robot.layout.limb(self.limb)

    def chain(self, thresholds: Array, *, norm: bool = False) -> Chain:
        """Return a chain with thresholds (phases, c)."""
        return make_chain(self.detection.low_pass_hz, self.detection.hold_s, self.rate_hz, thresholds, norm=norm)

    def low_passed(self, signals: Array, segments: Spans) -> Array:
        """Return signals (T, m) behind the low-pass of the chain, each segment from rest."""
        pole = self.chain(np.ones((1, 1))).pole
        out = np.zeros(signals.shape)
        for start, end in segments:
            low_passed(pole, signals[start:end], out[start:end])
        return out


@dataclass(frozen=True)
class LegSetup(LimbSetup):
    """What all detectors of a leg share: that of a limb, and its gate."""

    gate: LegGate

    @classmethod
    def of(cls, detection: Detection, robot: RobotDescription, limb: str, rate_hz: float) -> "LegSetup":
        """Return the setup of a leg; a ConfigError names a limb that is none."""
        return cls(
            detection, robot, limb, rate_hz, LegGate.of(as_plain(detection.gate, GateNumbers), robot, limb, rate_hz)
        )

    @property
    def side(self) -> str:
        """Side of the leg, with which the names of its points begin."""
        return next(side for side, limb in self.robot.layout.legs.items() if limb == self.limb)

    @property
    def inward(self) -> float:
        """Direction of the other leg along the y axis."""
        return -1.0 if self.side == "left" else 1.0

    def record(self, path: Path, read: SensedRecording, tau: NDArray[Any]) -> LegRecording:
        """Run the gate over a recording, tau (T, 6) [N m] being the estimate of the leg's joints."""
        swings = swings_of(read.sensed.swing[:, self.gate.foot], read.segments)
        terrains = read.meta.get("terrains") or [UNKNOWN] * len(read.segments)
        walked = tuple(terrains[segment_of(swing, read.segments)] for swing in swings)
        # A copy: the columns of a recording are views of one array, and a view of five would keep all of them.
        command = read.sensed.command.copy()
        return LegRecording(path, read.segments, command, self.gate.watch(read, tau), swings, walked)

    def recordings(self, paths: Sequence[Path], estimates: Sequence[Path]) -> Iterator[LegRecording]:
        """Yield the leg in recordings, with estimates of the gate's method; not where that does not estimate it."""
        for path, stem in zip(paths, estimates, strict=True):
            if estimate := read_estimate(stem, self.joints):
                yield self.record(path, read_sensed(path, self.robot.layout), estimate.tau_ext)


def read_estimate(stem: Path, joints: Sequence[str]) -> Estimate | None:
    """Return the estimate of some joints (T, n) [N m], with what std it has; None where it does not hold them."""
    column_names = {column["name"] for column in read_array_note(file_of(stem, NOTE))["columns"]}
    if not column_names.issuperset(named(EXTERNAL, joints)):
        return None
    std = read_array(stem, named(STD, joints))[0] if column_names.issuperset(named(STD, joints)) else None
    return Estimate(read_array(stem, named(EXTERNAL, joints))[0], std)
