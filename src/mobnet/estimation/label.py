"""The training label of section 4.2.3 by the sensors in the feet, freed of the plates below them."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.recording import Sensed, SensedRecording
from mobnet.estimation.low_pass import low_pass
from mobnet.robot.description import RobotDescription
from mobnet.robot.dynamics import momentum_and_beta
from mobnet.robot.nominal import NominalModel
from mobnet.robot.wrench import feet_torque


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
    sensed = read.sensed
    swings = dict(zip(wrenches, read.sensed.swing.T, strict=True))
    loads = {side: zeroed(wrench, swings[side]) for side, wrench in wrenches.items()}
    torque = feet_torque(nominal, sensed.q, loads)
    models = {side: plate_of(nominal.robot, side) for side in wrenches} if plates else {}
    # (O8) is mapped first and filtered then, because J^T times a low-passed F is not the low-pass of J^T F.
    for span in read.spans():
        for side, model in models.items():
            torque[span] += plate_torque(model, sensed[span], swings[side][span], read.rate_hz)
        torque[span] = low_pass(torque[span], gain_hz, read.rate_hz)
    return torque


def zeroed(wrench: NDArray[Any], swing: NDArray[Any]) -> NDArray[np.float64]:
    """Return a foot's wrench (T, 6) [N] and [N m] without its constant error, the median where the foot swings (T,)."""
    # F_0 of (O8): a foot in the air is touched by pushes alone, which are too short to move a median, and come from
    # any side. A recording without a swing tells nothing of the error.
    hanging = wrench[swing > 0]
    return wrench - (np.median(hanging, axis=0) if len(hanging) else 0.0)


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
