"""Rows of a robot's table: bodies, joints, feet, shapes. SI units; vectors in the axes of the body they belong to."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import AfterValidator, Field, model_validator

from mobnet.formats import base
from mobnet.formats.base import Section

UNIT_TOLERANCE = 1e-5  # figures are published with six digits
INERTIA_TOLERANCE = 1e-3  # share by which rounded figures may miss the triangle inequality
TORQUE_NM = (0.001, 5000)  # largest torque of a joint
SPEED_RAD_S = (0.1, 100)  # largest speed of a joint
ARMATURE = (0, 1000)  # of a joint [kg m^2]
MOST_KG = 2000.0  # of a body; links of public files reach 1386 kg, in a robot that lifts 210 kg
# Radius of gyration of a body: what is outside has its mass or inertia in another unit. Links of public files whose
# figures were not measured reach 4.5 m, with 1 kg m^2 for 50 g.
GYRATION_M = (0.001, 5.0)
SIZES = {"box": 3, "ellipsoid": 3, "sphere": 1, "capsule": 2, "cylinder": 2}  # of a shape that stands at a point

Side = Literal["left", "right"]
Segment = tuple[base.Metres, base.Metres, base.Metres, base.Metres, base.Metres, base.Metres]
Tensor = tuple[base.Real, base.Real, base.Real, base.Real, base.Real, base.Real]
Colour = tuple[base.Share, base.Share, base.Share, base.Share]


def _unit(values: tuple[float, ...]) -> tuple[float, ...]:
    """Check that a vector or a quaternion has unit length."""
    length = float(np.linalg.norm(values))
    if abs(length - 1) > UNIT_TOLERANCE:
        raise ValueError(f"{list(values)} of length {length:.6g} is not accepted; accepted: length 1")
    return values


def principal_moments(inertia: Tensor) -> tuple[float, float, float]:
    """Return the principal moments of xx yy zz xy xz yz, which rise [kg m^2]."""
    xx, yy, zz, xy, xz, yz = inertia
    low, middle, high = np.linalg.eigvalsh(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])).tolist()
    return low, middle, high


def is_possible(inertia: Tensor) -> bool:
    """Return whether a rigid body can have an inertia: moments above zero, none above the sum of the others."""
    low, middle, high = principal_moments(inertia)
    return low > 0 and high <= (1 + INERTIA_TOLERANCE) * (low + middle)


def _possible(inertia: Tensor) -> Tensor:
    """Check that a rigid body can have an inertia."""
    if not is_possible(inertia):
        low, middle, high = principal_moments(inertia)
        refused = f"{list(inertia)} with the principal moments {low:.6g}, {middle:.6g}, {high:.6g} is not accepted"
        raise ValueError(f"{refused}; accepted: all above 0 and none above the sum of the others")
    return inertia


UnitVector = Annotated[base.Vector3, AfterValidator(_unit)]
UnitQuaternion = Annotated[tuple[base.Real, base.Real, base.Real, base.Real], AfterValidator(_unit)]
Inertia = Annotated[Tensor, AfterValidator(_possible)]


class BodyRow(Section):
    """A link, without its rotor; `parent` is a body that stands before it, `world` for the first.

    `pos` [m] and `quat`, w x y z, are in the parent's frame; mass [kg], `com` [m] and `inertia` [kg m^2], which is xx
    yy zz xy xz yz about the centre of mass, in body axes.
    """

    name: base.PartName
    parent: base.Text
    pos: base.Vector3
    quat: UnitQuaternion
    mass: base.Positive = Field(le=MOST_KG)
    com: base.Vector3
    inertia: Inertia


class JointRow(Section):
    """An actuated hinge at the origin of the body that it moves; `name` is that in the source of the table.

    Limits `range` [rad], `torque_limit` [N m] and `velocity_limit` [rad/s]; `armature` is the inertia of the rotor,
    reflected to the joint [kg m^2].
    """

    id: base.MotorName
    name: base.Text | None = None
    body: base.BodyName
    axis: UnitVector
    range: base.Span[base.Radians]
    torque_limit: base.Real = Field(ge=TORQUE_NM[0], le=TORQUE_NM[1])
    armature: base.NotNegative = Field(le=ARMATURE[1])
    velocity_limit: base.Real = Field(ge=SPEED_RAD_S[0], le=SPEED_RAD_S[1])


class FrictionRow(Section):
    """What lies between a motor's reported torque and its joint; the observer takes it into account.

    Of the reported torque tau the joint gets scale * tau - (coulomb_nm + load |tau|) s(v) - viscous_nms * v -
    offset_nm. s(v) = tanh(v / smoothing_rad_s), or with `breakaway_rad` the bend of Dahl's law, which follows a
    reversal over that angle (mobnet.kernel.drive).

    Attributes:
        coulomb_nm: dry friction [N m].
        viscous_nms: friction for each speed [N m s/rad].
        load: dry friction for each torque of the motor [-].
        offset_nm: by how much the motor reports too much [N m].
        scale: true torque over the reported one [-].
        smoothing_rad_s: width of the smooth sign of the speed [rad/s].
        breakaway_rad: angle of Dahl's law [rad].
    """

    coulomb_nm: base.NotNegative = Field(le=5000)
    viscous_nms: base.NotNegative = Field(le=50_000)
    load: base.Share = 0.0
    offset_nm: base.Real = Field(default=0.0, ge=-5000, le=5000)
    scale: base.Positive = Field(default=1.0, ge=0.001, le=1000)
    smoothing_rad_s: base.Positive = Field(ge=1e-4, le=20)
    breakaway_rad: Annotated[base.Positive, Field(ge=1e-5, le=1)] | None = None


class FootRow(Section):
    """A foot: the last body of the leg `limb`."""

    body: base.BodyName
    limb: base.LimbName


class SoleRow(Section):
    """What every foot stands on, in the foot's frame [m].

    The force/torque sensor is at `sensor_pos`; below it is a plate of the mass `plate_kg`, with its centre of mass at
    `plate_com`. The box that touches the ground has half lengths `box_half` around `box_centre`, and its lower face is
    at `height`.
    """

    sensor_pos: base.Vector3
    plate_kg: base.NotNegative
    plate_com: base.Vector3
    box_centre: base.Vector3
    box_half: tuple[base.Length, base.Length, base.Length]
    height: base.Metres


class LegRow(Section):
    """Geometry of both legs [m], whose hip axes meet in a point, as do their ankle axes; the hip is the left one."""

    hip_pos: base.Vector3
    link_length: base.Real = Field(ge=0.02, le=2)


class PointRow(Section):
    """A named point; the row of one whose name begins with `left_` stands for its mirror image in y too."""

    name: base.PartName
    body: base.BodyName
    pos: base.Vector3 = (0.0, 0.0, 0.0)


class ShapeRow(PointRow):
    """A solid without mass, at a point or along a segment between two ends [m]; mirrored as points are.

    `size` has the radius, radius and half length, or three half lengths [m]; along a segment the radius alone.
    """

    type: Literal["capsule", "cylinder", "box", "ellipsoid", "sphere"]
    size: base.Some[base.Length]
    segment: Segment | None = None
    tone: base.ToneName

    @model_validator(mode="after")
    def _has_its_size(self) -> ShapeRow:
        """Check that there are as many sizes as the solid takes, and one place."""
        if self.segment is not None and (any(self.pos) or SIZES[self.type] != 2):
            raise ValueError(
                f"{self.type} {self.name} with `segment` is not accepted; accepted: capsule, cylinder, no `pos`"
            )
        wanted = SIZES[self.type] if self.segment is None else 1
        if len(self.size) != wanted:
            raise ValueError(f"{self.type} {self.name} with {len(self.size)} sizes is not accepted; accepted: {wanted}")
        return self


class Looks(Section):
    """Shells, hands and head that pictures show in place of a robot's `shapes`; nothing touches or weighs them."""

    tones: dict[base.PartName, Colour] = Field(default_factory=dict)
    shapes: base.Some[ShapeRow]


class ImuRow(Section):
    """Where the inertial sensor is, pos [m]."""

    body: base.BodyName
    pos: base.Vector3


class PostureRow(Section):
    """How a limb is held while nothing moves it: angles, and torques of position and velocity errors, by joint."""

    angle_rad: tuple[base.Radians, ...]
    stiffness_nm_rad: tuple[Annotated[base.NotNegative, Field(le=50_000)], ...]
    damping_nms_rad: tuple[Annotated[base.NotNegative, Field(le=5000)], ...]


class Totals(Section):
    """Published figures of the whole robot, which the rows must add up to; mass [kg]."""

    mass: base.Positive = Field(le=5000)
    bodies: base.Count
    actuated_joints: base.Count
    virtual_joints: base.Index
    dof: base.Count
    height_m: base.Real = Field(ge=0.1, le=5)
