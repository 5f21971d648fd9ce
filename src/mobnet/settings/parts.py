"""Rows of a robot's table: bodies, joints, feet, shapes. SI units; vectors in the axes of the body they belong to."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import AfterValidator, model_validator

from mobnet.settings.base import (
    BodyName,
    Count,
    Index,
    LimbName,
    MotorName,
    NotNegative,
    Positive,
    Range,
    Real,
    Section,
    Share,
    Text,
    ToneName,
    Vector3,
)  # fmt: skip

UNIT_TOLERANCE = 1e-5  # figures are published with six digits
INERTIA_TOLERANCE = 1e-3  # share by which rounded figures may miss the triangle inequality
SIZES = {"box": 3, "ellipsoid": 3, "sphere": 1, "capsule": 2, "cylinder": 2}  # of a shape that stands at a point

Side = Literal["left", "right"]
Tensor = tuple[Real, Real, Real, Real, Real, Real]
Colour = tuple[Share, Share, Share, Share]


def _unit(values: tuple[float, ...]) -> tuple[float, ...]:
    """Check that a vector or a quaternion has unit length."""
    length = float(np.linalg.norm(values))
    if abs(length - 1) > UNIT_TOLERANCE:
        raise ValueError(f"{list(values)} has length {length:.6g}; accepted: length 1")
    return values


def _possible(inertia: Tensor) -> Tensor:
    """Check that a rigid body can have an inertia: principal moments above zero, none above the sum of the others."""
    xx, yy, zz, xy, xz, yz = inertia
    low, middle, high = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    if low <= 0 or high > (1 + INERTIA_TOLERANCE) * (low + middle):
        found = f"{list(inertia)} has the principal moments {low:.6g}, {middle:.6g}, {high:.6g}"
        raise ValueError(f"{found}; accepted: all above 0 and none above the sum of the others")
    return inertia


UnitVector = Annotated[Vector3, AfterValidator(_unit)]
UnitQuaternion = Annotated[tuple[Real, Real, Real, Real], AfterValidator(_unit)]
Inertia = Annotated[Tensor, AfterValidator(_possible)]


class BodyRow(Section):
    """A link, without its rotor.

    Attributes:
        parent: a body that stands before it, `world` for the first.
        pos: origin in the parent's frame [m].
        quat: orientation in the parent's frame, w x y z.
        mass: mass of the link [kg].
        com: centre of mass [m].
        inertia: xx yy zz xy xz yz about the centre of mass [kg m^2].
    """

    name: Text
    parent: Text
    pos: Vector3
    quat: UnitQuaternion
    mass: Positive
    com: Vector3
    inertia: Inertia


class JointRow(Section):
    """An actuated hinge at the origin of the body that it moves.

    Attributes:
        name: name in the source of the table.
        range: lower and upper limit [rad].
        torque_limit: largest torque of the motor [N m].
        armature: inertia of the rotor, reflected to the joint [kg m^2].
        velocity_limit: largest speed [rad/s].
    """

    id: MotorName
    name: Text | None = None
    body: BodyName
    axis: UnitVector
    range: Range
    torque_limit: Positive
    armature: NotNegative
    velocity_limit: Positive


class FootRow(Section):
    """A foot: the last body of the leg `limb`."""

    body: BodyName
    limb: LimbName


class SoleRow(Section):
    """What every foot stands on, in the foot's frame.

    Attributes:
        sensor_pos: origin of the force/torque sensor [m].
        box_centre: centre of the box that touches the ground [m].
        box_half: its half lengths [m].
        height: height of its lower face [m].
    """

    sensor_pos: Vector3
    box_centre: Vector3
    box_half: tuple[Positive, Positive, Positive]
    height: Real


class LegRow(Section):
    """Geometry of both legs, whose hip axes meet in a point, as do their ankle axes.

    Attributes:
        hip_pos: left hip in the base [m].
        link_length: length of the thigh, and of the shank [m].
    """

    hip_pos: Vector3
    link_length: Positive


class PointRow(Section):
    """A named point; the row of one whose name begins with `left_` stands for its mirror image in y too."""

    name: Text
    body: BodyName
    pos: Vector3 = (0.0, 0.0, 0.0)


class ShapeRow(PointRow):
    """A solid without mass, at a point or along a segment; mirrored as points are.

    Attributes:
        size: radius, radius and half length, or three half lengths [m]; along a segment the radius alone.
        segment: both ends of a capsule or a cylinder [m].
    """

    type: Literal["capsule", "cylinder", "box", "ellipsoid", "sphere"]
    size: tuple[Positive, ...]
    segment: Tensor | None = None
    tone: ToneName

    @model_validator(mode="after")
    def _has_its_size(self) -> ShapeRow:
        """Check that there are as many sizes as the solid takes, and one place."""
        if self.segment is not None and (any(self.pos) or SIZES[self.type] != 2):
            raise ValueError(f"{self.type} {self.name} with `segment`; accepted: capsule and cylinder without `pos`")
        wanted = SIZES[self.type] if self.segment is None else 1
        if len(self.size) != wanted:
            raise ValueError(f"{self.type} {self.name} with {len(self.size)} sizes; accepted: {wanted}")
        return self


class ImuRow(Section):
    """Where the inertial sensor is, pos [m]."""

    body: BodyName
    pos: Vector3


class PostureRow(Section):
    """How a limb is held while nothing moves it, one number a joint.

    Attributes:
        angle_rad: angles.
        stiffness_nm_rad: torque of a position error.
        damping_nms_rad: torque of a velocity error.
    """

    angle_rad: tuple[Real, ...]
    stiffness_nm_rad: tuple[NotNegative, ...]
    damping_nms_rad: tuple[NotNegative, ...]


class Totals(Section):
    """Published figures of the whole robot, which the rows must add up to; mass [kg]."""

    mass: Positive
    bodies: Count
    actuated_joints: Count
    virtual_joints: Index
    dof: Count
    height_m: Positive
