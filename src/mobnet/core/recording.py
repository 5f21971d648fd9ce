"""The signals that a robot senses, and those that only a simulator has, sample by sample."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from numpy.typing import NDArray

ABSENT = "absent"  # in the note of a recording from a log: signals that the log does not have, and that are zero
PLANNED = ("swing", "landing")  # signals that tell when a leg is in the air


@dataclass(frozen=True)
class Sensed:
    """Proprioception of a robot; all that an estimator may see. Time is the first axis, one row a sample.

    What a robot does not have has no columns (T, 0): the base where it is fixed, feet that are not there, and commands
    where nothing walks.

    Attributes:
        q: generalized position (T, nq): base position [m] in world, base quaternion w x y z, joints [rad].
        v: generalized velocity (T, nv): base linear [m/s] in world, base angular [rad/s] in base, joints [rad/s].
        acc_base_in_base: specific force of the IMU (T, 3) [m/s^2], gravity included, base axes.
        tau_des: desired torque that the drives get, within the motor limits (T, nu) [N m], mean over the control ticks.
        tau_motor: torque the motors gave, after their limits (T, nu) [N m], mean over the control ticks.
        swing: 1 where the walking plan has the left, right foot in the air (T, 2).
        command: step x, step y [m], turn [rad], duration [s] and foot height [m] of the step being made (T, 5),
            Table 2; zero while the robot stands.
        landing: time until the plan has the left, right foot land (T, 2) [s]; zero on the ground and once it is late.
    """

    q: NDArray[Any]
    v: NDArray[Any]
    acc_base_in_base: NDArray[Any]
    tau_des: NDArray[Any]
    tau_motor: NDArray[Any]
    swing: NDArray[Any]
    command: NDArray[Any]
    landing: NDArray[Any]

    def __len__(self) -> int:
        """Return the number of samples."""
        return len(self.q)

    def __getitem__(self, rows: int | slice) -> Sensed:
        """Return one sample (1-D arrays) or a span of samples."""
        return Sensed(*(getattr(self, f.name)[rows] for f in fields(self)))


@dataclass(frozen=True)
class Truth:
    """Signals that no estimator may see: those that only the plant has, foot wrenches, and the random torque by itself.

    Foot wrenches also serve as training labels (section 4.2.3).

    Attributes:
        tau_ext: external torque (T, nv) [N, N m], mean over the control ticks of the sample; J^T F of (2).
        wrench_left_foot: wrench the ground and pushes exert on the left foot (T, 6) [N, N m], as the foot's
            sensor reads it: foot axes, about the sensor.
        wrench_right_foot: the same of the right foot (T, 6).
        contact: 1 where the left, right foot touches the ground (T, 2).
        pushed: 1 where a push of the scenario acts (T, 1).
        tau_random: random torque (T, nu) [N m] that exploration added to the desired torque, in which it is contained;
            mean over the control ticks of the sample. Zero where there is none.
        tau_push: what the pushes of the scenario alone add to the external torque (T, nv) [N, N m], mean over the
            control ticks of the sample. Zero where nothing pushes.
        push: the force that pushes (T, 4): its row among the pushes of the scenario, counted from 1, the last one if
            there are several, and the force of all together in world axes [N], mean over the control ticks of the
            sample. Zero where no force does.
    """

    tau_ext: NDArray[Any]
    wrench_left_foot: NDArray[Any]
    wrench_right_foot: NDArray[Any]
    contact: NDArray[Any]
    pushed: NDArray[Any]
    tau_random: NDArray[Any]
    tau_push: NDArray[Any]
    push: NDArray[Any]

    def __getitem__(self, rows: int | slice) -> Truth:
        """Return one sample (1-D arrays) or a span of samples."""
        return Truth(*(getattr(self, f.name)[rows] for f in fields(self)))


@dataclass(frozen=True)
class SensedRecording:
    """The sensed part of a stored run: samples at a fixed rate [Hz], in segments that are contiguous in time.

    A segment is its start and end row; a fall ends one and the next starts anew. `meta` has scenario, level, seed,
    provenance and what else the writer noted.
    """

    sensed: Sensed
    segments: tuple[tuple[int, int], ...]
    rate_hz: float
    meta: Mapping[str, Any]

    def spans(self) -> list[slice]:
        """Return the segments as slices."""
        return [slice(start, end) for start, end in self.segments]

    def unplanned(self) -> list[str]:
        """Return which of the signals that tell when a leg is in the air are missing."""
        return [name for name in PLANNED if name in self.meta.get(ABSENT, ())]


@dataclass(frozen=True)
class Recording(SensedRecording):
    """A stored run with the signals that only the plant has."""

    truth: Truth
