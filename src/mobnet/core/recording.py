"""The signals that a robot senses, and those that only a simulator has, sample by sample."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from numpy.typing import NDArray

from mobnet.core.joints import JointLayout

FEET = ("left_foot", "right_foot")
COMMAND = (("step_x", "m"), ("step_y", "m"), ("turn", "rad"), ("duration", "s"), ("foot_height", "m"))  # Table 2
Column = tuple[str, str, str]  # name, unit, frame


@dataclass(frozen=True)
class Sensed:
    """Proprioception of a robot; all that an estimator may see. Time is the first axis, one row a sample.

    What a robot does not have has no columns (T, 0): the base where it is fixed, feet that are not there, and commands
    where nothing walks.

    Attributes:
        q: generalized position (T, nq): base position [m] in world, base quaternion w x y z, joints [rad].
        v: generalized velocity (T, nv): base linear [m/s] in world, base angular [rad/s] in base, joints [rad/s].
        acc_base_in_base: specific force of the IMU (T, 3) [m/s^2], gravity included, base axes.
        tau_des: desired torque before the motor limits (T, nu) [N m], mean over the control ticks of the sample.
        tau_motor: torque the motors gave, after their limits (T, nu) [N m], mean over the control ticks.
        swing: 1 where the walking plan has the left, right foot in the air (T, 2).
        command: step x, step y [m], turn [rad], duration [s] and foot height [m] of the step being made (T, 5),
            Table 2; zero while the robot stands.
    """

    q: NDArray[Any]
    v: NDArray[Any]
    acc_base_in_base: NDArray[Any]
    tau_des: NDArray[Any]
    tau_motor: NDArray[Any]
    swing: NDArray[Any]
    command: NDArray[Any]

    def __len__(self) -> int:
        """Return the number of samples."""
        return len(self.q)

    def __getitem__(self, rows: int | slice) -> Sensed:
        """Return one sample (1-D arrays) or a span of samples."""
        return Sensed(*(getattr(self, f.name)[rows] for f in fields(self)))


@dataclass(frozen=True)
class Truth:
    """Signals of the plant that a robot does not have; foot wrenches also serve as training labels (section 4.2.3).

    Attributes:
        tau_ext: external torque (T, nv) [N, N m], mean over the control ticks of the sample; J^T F of (2).
        wrench_left_foot: wrench the ground and pushes exert on the left foot (T, 6) [N, N m], as the foot's
            sensor reads it: foot axes, about the sensor.
        wrench_right_foot: the same of the right foot (T, 6).
        contact: 1 where the left, right foot touches the ground (T, 2).
        pushed: 1 where a push of the scenario acts (T, 1).
    """

    tau_ext: NDArray[Any]
    wrench_left_foot: NDArray[Any]
    wrench_right_foot: NDArray[Any]
    contact: NDArray[Any]
    pushed: NDArray[Any]

    def __getitem__(self, rows: int | slice) -> Truth:
        """Return one sample (1-D arrays) or a span of samples."""
        return Truth(*(getattr(self, f.name)[rows] for f in fields(self)))


@dataclass(frozen=True)
class SensedRecording:
    """The sensed part of a stored run: samples at a fixed rate, in segments that are contiguous in time.

    Attributes:
        sensed: signals that a robot has.
        segments: start and end row of each contiguous stretch; a fall ends one and the next starts anew.
        rate_hz: samples per second [Hz].
        meta: scenario, level, seed, provenance and what else the writer noted.
    """

    sensed: Sensed
    segments: tuple[tuple[int, int], ...]
    rate_hz: float
    meta: Mapping[str, Any]

    def spans(self) -> list[slice]:
        """Return the segments as slices."""
        return [slice(start, end) for start, end in self.segments]


@dataclass(frozen=True)
class Recording(SensedRecording):
    """A stored run with the signals that only the plant has.

    Attributes:
        truth: signals that only the plant has.
    """

    truth: Truth


def recording_columns(layout: JointLayout) -> dict[str, list[Column]]:
    """Return field -> columns (name, unit, frame) of a stored recording, in file order; some fields may have none."""
    actuated, xyz, wxyz = layout.actuated, "xyz" if layout.virtual else "", "wxyz" if layout.virtual else ""
    feet = [foot for foot in FEET if foot.removesuffix("_foot") in layout.legs]
    wrench = [(f"{kind}_{axis}", unit) for kind, unit in (("force", "N"), ("moment", "N m")) for axis in "xyz"]
    base_v = [(f"v.base_{a}", "m/s", "world") for a in xyz] + [(f"v.omega_{a}", "rad/s", "base") for a in xyz]
    base_q = [(f"q.base_{a}", "m", "world") for a in xyz] + [(f"q.quat_{a}", "-", "world") for a in wxyz]
    return {
        "q": base_q + [(f"q.{j}", "rad", "joint") for j in actuated],
        "v": base_v + [(f"v.{j}", "rad/s", "joint") for j in actuated],
        "acc_base_in_base": [(f"acc.{a}", "m/s^2", "base") for a in xyz],
        "tau_des": [(f"tau_des.{j}", "N m", "joint") for j in actuated],
        "tau_motor": [(f"tau_motor.{j}", "N m", "joint") for j in actuated],
        "swing": [(f"swing.{foot}", "-", "plan") for foot in feet],
        "command": [(f"command.{name}", unit, "stance foot") for name, unit in COMMAND if feet],
        "tau_ext": [
            (f"tau_ext.{j}", layout.unit(j), "world" if i < len(xyz) else "joint") for i, j in enumerate(layout.names)
        ],
        **{
            f"wrench_{foot}": [(f"wrench_{foot}.{name}", unit, foot) for name, unit in wrench if foot in feet]
            for foot in FEET
        },
        "contact": [(f"contact.{foot}", "-", "ground") for foot in feet],
        "pushed": [("pushed", "-", "scenario")],
    }


def recording_width(layout: JointLayout) -> int:
    """Return the number of columns of a stored recording."""
    return sum(map(len, recording_columns(layout).values()))
