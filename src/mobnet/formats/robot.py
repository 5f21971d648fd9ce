"""A robot's table of figures, `configs/robots/*.yaml` (docs/robots.md)."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterator
from itertools import chain
from typing import Annotated, Literal

from pydantic import Field

from mobnet.core.joints import JointLayout, Limits, with_image
from mobnet.formats.base import BodyName, JointName, LimbName, MotorName, PartName, Section, Some, Text
from mobnet.formats.network import Limb
from mobnet.formats.parts import (
    BodyRow,
    Colour,
    FootRow,
    FrictionRow,
    ImuRow,
    JointRow,
    LegRow,
    Looks,
    PointRow,
    PostureRow,
    ShapeRow,
    Side,
    SoleRow,
    Totals,
)

WORLD = "world"
GroupName = Annotated[str, Field(pattern="^[A-Za-z][A-Za-z0-9]*$", max_length=20)]  # part of file names


class Order(Section):
    """Names of the joints in the order of the generalized velocity; only a floating base has virtual joints."""

    virtual: tuple[PartName, ...] = ()
    actuated: Some[PartName]


class RobotTable(Section):
    """The table of a robot: joints, bodies, limbs, sensors, shapes, and the limbs that have networks.

    Entries that contradict each other are refused by `checks.robot`. `bodies` stand depth-first, parents first, and
    `joints` in the order of the motors; `groups` are limb -> joints, `friction` is that of joints which the observer is
    to know.
    """

    name: Annotated[Text, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9 _.-]*$")]
    base: Literal["fixed", "floating"]
    totals: Totals | None = None
    imu: ImuRow | None = None
    feet: dict[Side, FootRow] = Field(default={})
    sole: SoleRow | None = None
    leg: LegRow | None = None
    hands: dict[Side, BodyName] = Field(default={})
    order: Order
    groups: dict[GroupName, Some[JointName]]
    posture: dict[LimbName, PostureRow] = Field(default_factory=dict)
    networks: dict[GroupName, Limb] = Field(default_factory=dict)
    joints: tuple[JointRow, ...]
    friction: dict[MotorName, FrictionRow] = Field(default_factory=dict)
    bodies: Some[BodyRow]
    tones: dict[PartName, Colour] = Field(default_factory=dict)
    shapes: tuple[ShapeRow, ...] = ()
    points: tuple[PointRow, ...] = ()
    looks: Looks | None = None

    def __repr_args__(self) -> Iterator[tuple[str, str]]:
        """Name the robot and a digest of all figures: the table is a parameter of every rule that takes it.

        Looks are left out, so that no recording is made again because a shell has another form; what draws them takes
        them as a parameter of its own. A table without friction has the digest that it had before there was this key.
        """
        without = {"looks"} if self.friction else {"looks", "friction"}
        yield "name", self.name
        yield "digest", hashlib.sha256(self.model_dump_json(exclude=without).encode()).hexdigest()[:16]

    @property
    def layout(self) -> JointLayout:
        """Joints and limbs."""
        legs = {side: foot.limb for side, foot in self.feet.items()}
        limits = {row.id: Limits(*row.range, row.velocity_limit, row.torque_limit) for row in self.joints}
        return JointLayout(self.order.virtual, self.order.actuated, self.groups, legs, limits)

    @property
    def posture_rad(self) -> dict[str, float]:
        """Joint -> angle [rad] at which it is held where nothing moves it."""
        angles = dict[str, float]()
        for limb, row in self.posture.items():
            angles.update(zip(self.groups[limb], row.angle_rad, strict=True))
        return angles

    @property
    def accepted_names(self) -> dict[str, Collection[str]]:
        """Kind of name -> the names that exist on the robot."""
        order = self.order
        joints = (*order.virtual, *order.actuated)
        legs = [foot.limb for foot in self.feet.values()]
        joints_of_legs = list(chain.from_iterable(self.groups.get(limb, ()) for limb in legs))
        points = list(chain.from_iterable(with_image(point.name) for point in self.points))
        return {
            "joint": joints,
            "motor": order.actuated,
            "limb": self.groups,
            "limb or joint": (*self.groups, *joints),
            "leg": legs,
            "joint of a leg": joints_of_legs,
            "body": [body.name for body in self.bodies],
            "tone": {**self.tones, **(self.looks.tones if self.looks else {})},
            "network of the robot": self.networks,
            "point": [*points, *(f"{side}_sole" for side in self.feet)],
        }
