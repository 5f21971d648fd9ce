"""The training label of section 4.2.3 by the sensors in the feet, freed of the plates below them."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.recording import Sensed, SensedRecording
from mobnet.kernel.low_pass import low_pass
from mobnet.robot.description import RobotDescription
from mobnet.robot.dynamics import momentum_and_beta
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import feet_torque


@dataclass(frozen=True)
class LabelState:
    """What the label carries from one sample to the next; all None before the first.

    Attributes:
        sample: the last sample, a stretch of one row.
        label: the label there (nv,) [N] and [N m].
    """

    sample: Sensed | None = None
    label: Array | None = None


class FootLabel:
    """The label of a robot with sensors in its feet, stretch by stretch; a stretch may come in pieces."""

    def __init__(
        self, nominal: NominalModel, zeros: Mapping[str, NDArray[Any]], gain_hz: float, rate_hz: float, *, plates: bool
    ) -> None:
        """Take the model, side -> constant error of the foot's sensor (6,) [N] and [N m], K_0 [1/s], and the rate [Hz].

        Without `plates`, the inertia of what lies below the sensors stays in the label.
        """
        self._nominal = nominal
        self._zeros = zeros
        self._gain_hz = gain_hz
        self._rate_hz = rate_hz
        self._plates = [plate_of(nominal.robot, side) for side in zeros] if plates else []

    def torque(self, sensed: Sensed, wrenches: Mapping[str, NDArray[Any]]) -> Array:
        """Return what wrenches, side -> (n, 6) [N] and [N m], do to the joints (n, nv) [N] and [N m]: J^T F of (O8)."""
        loads = {side: wrench - self._zeros[side] for side, wrench in wrenches.items()}
        return feet_torque(self._nominal, sensed.q, loads)

    def follow(self, state: LabelState, sensed: Sensed, torque: Array) -> LabelState:
        """Turn `torque` of contiguous samples into their label, in place; return the state after them."""
        known = sensed if state.sample is None else _behind(state.sample, sensed)
        # (O8) is mapped first and filtered then, because J^T times a low-passed F is not the low-pass of J^T F.
        for k, model in enumerate(self._plates):
            torque += plate_torque(model, known, known.swing[:, k], self._rate_hz)[-len(torque) :]
        torque[:] = low_pass(torque, self._gain_hz, self._rate_hz, state.label)
        last = Sensed(*(getattr(sensed, each.name)[-1:].copy() for each in fields(Sensed)))
        return LabelState(last, torque[-1].copy())


def foot_label(
    nominal: NominalModel,
    read: SensedRecording,
    wrenches: Mapping[str, NDArray[Any]],
    gain_hz: float,
    *,
    plates: bool = True,
) -> Array:
    """Return (O8) behind the low-pass of K_0 [1/s], (T, nv) [N] and [N m], segment by segment.

    Wrenches side -> (T, 6) [N] and [N m] are those that the feet's sensors read. Without `plates`, the inertia of what
    lies below the sensors stays in the label.
    """
    swings = dict(zip(wrenches, read.sensed.swing.T, strict=True))
    zeros = {side: zero_of(wrench[swings[side] > 0]) for side, wrench in wrenches.items()}
    label = FootLabel(nominal, zeros, gain_hz, read.rate_hz, plates=plates)
    torque = label.torque(read.sensed, wrenches)
    for span in read.spans():
        label.follow(LabelState(), read.sensed[span], torque[span])
    return torque


def zero_of(hanging: NDArray[Any]) -> NDArray[Any]:
    """Return the constant error of a foot's sensor (6,) [N] and [N m], the median of its wrenches in the air (k, 6)."""
    # F_0 of (O8): a foot in the air is touched by pushes alone, which are too short to move a median, and come from
    # any side. A recording without a swing tells nothing of the error.
    return np.median(hanging, axis=0) if len(hanging) else np.zeros(hanging.shape[1], dtype=hanging.dtype)


def _behind(before: Sensed, sensed: Sensed) -> Sensed:
    """Return samples behind the one before them."""
    pairs = ((getattr(before, each.name), getattr(sensed, each.name)) for each in fields(Sensed))
    return Sensed(*(np.concatenate(pair) for pair in pairs))


def plate_of(robot: RobotDescription, side: str) -> NominalModel:
    """Return the model of a robot that weighs nothing but the plate below the sensor of one foot, without gravity."""
    assert robot.sole is not None
    foot = robot.feet[side].body
    point = {"com": robot.sole.plate_com, "inertia": (0.0,) * 6}
    masses = {body.name: robot.sole.plate_kg if body.name == foot else 0.0 for body in robot.bodies}
    bodies = tuple(body.model_copy(update={"mass": masses[body.name], **point}) for body in robot.bodies)
    joints = tuple(joint.model_copy(update={"armature": 0.0}) for joint in robot.joints)
    return NominalModel(replace(robot, bodies=bodies, joints=joints), gravity_m_s2=0.0)


def plate_torque(plate: NominalModel, sensed: Sensed, swing: NDArray[Any], rate_hz: float) -> Array:
    """Return the torque that accelerates a plate while its foot swings (T,), (T, nv) [N] and [N m].

    The samples are contiguous, at a rate [Hz].
    """
    p, beta = momentum_and_beta(plate, sensed.q, sensed.v)
    torque = np.zeros_like(p)
    # (O1) of the plate, which no motor drives: no acceleration has to be measured. A foot on the ground is at rest,
    # whatever the gears' springs make of the encoders.
    torque[1:] = np.diff(p, axis=0) * rate_hz - (beta[1:] + beta[:-1]) / 2
    return torque * (swing > 0)[:, None]
