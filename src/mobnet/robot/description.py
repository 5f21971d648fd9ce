"""A robot's table of figures as numpy values; the plant, the nominal model and the controller are built from it."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.robot.parts import Body, Foot, Joint, Leg, Point, Posture, Shape, Sole, Vector
from mobnet.robot.rows import (
    read_body,
    read_feet,
    read_joint,
    read_point,
    read_posture,
    read_shape,
    vector,
    with_mirrored,
)
from mobnet.settings.robot import RobotTable

SIDES = ("left", "right")
LEG_JOINTS = 6  # of a leg that walks


@dataclass(frozen=True)
class RobotDescription:
    """All figures of a robot; section 4.1 names TOCABI's 33 joints and six virtual ones.

    Attributes:
        name: the robot's name.
        layout: order of the generalized velocity and the limb groups.
        bodies: links, depth-first, parents first.
        joints: actuated joints in the order of `layout.actuated`.
        feet: side -> foot; empty for a robot without feet.
        hands: side -> body.
        leg: geometry of the legs, if the table has it.
        imu: inertial sensor, if there is one.
        posture: how the joints are held that nothing moves, in motor order; the table may leave joints out.
        shapes: what the robot looks like.
        points: where forces may be applied.
    """

    name: str
    layout: JointLayout
    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    feet: Mapping[str, Foot]
    hands: Mapping[str, str]
    leg: Leg | None
    imu: Point | None
    posture: Posture
    shapes: tuple[Shape, ...]
    points: tuple[Point, ...]

    @property
    def floating(self) -> bool:
        """Whether the base is free to move."""
        return bool(self.layout.virtual)

    @property
    def base(self) -> str:
        """Name of the first body, which floats or is fixed to the world."""
        return self.bodies[0].name

    @property
    def mass(self) -> float:
        """Total mass [kg]."""
        return sum(body.mass for body in self.bodies)

    @property
    def torque_limits(self) -> Vector:
        """Motor limits (nu,) [N m], in the order of `layout.actuated`."""
        return np.array([joint.torque_limit for joint in self.joints])

    @property
    def armature(self) -> Vector:
        """Reflected rotor inertia (nu,) [kg m^2]."""
        return np.array([joint.armature for joint in self.joints])

    def joint_of(self, body: str) -> Joint | None:
        """Return the joint that moves a body, or None where the body is welded or the base."""
        return next((joint for joint in self.joints if joint.body == body), None)

    def foot(self, side: str) -> Foot:
        """Return the foot of a side.

        Raises:
            ConfigError: the robot has none there.
        """
        if side not in self.feet:
            raise ConfigError(not_accepted("foot", side, self.feet))
        return self.feet[side]


@dataclass(frozen=True)
class WalkingRobot(RobotDescription):
    """A robot with all that walking takes; `for_walking` makes one.

    Attributes:
        leg: geometry of the legs.
        imu: inertial sensor.
    """

    leg: Leg
    imu: Point

    @property
    def sole(self) -> Sole:
        """Sole of either foot."""
        return self.feet["left"].sole


def describe(table: RobotTable) -> RobotDescription:
    """Return a robot's table as numpy values."""
    return RobotDescription(
        name=table.name,
        layout=table.layout,
        bodies=tuple(map(read_body, table.bodies)),
        joints=tuple(map(read_joint, table.joints)),
        feet=read_feet(table),
        hands={**table.hands},
        leg=None if table.leg is None else Leg(vector(table.leg.hip_pos), table.leg.link_length),
        imu=None if table.imu is None else Point("imu", table.imu.body, vector(table.imu.pos)),
        posture=read_posture(table),
        shapes=tuple(read_shape(row, table.tones) for row in with_mirrored(table.shapes)),
        points=tuple(map(read_point, with_mirrored(table.points))),
    )


def for_walking(robot: RobotDescription) -> WalkingRobot:
    """Return a robot that walks.

    Raises:
        ConfigError: its table lacks something that walking takes; one line names all of it.
    """
    limbs = [robot.layout.limb(robot.feet[side].limb) for side in SIDES if side in robot.feet]
    legs = sum(limbs, ())
    needed = {
        "a floating base": robot.floating,
        "feet on both sides": robot.feet.keys() >= set(SIDES),
        f"legs of {LEG_JOINTS} joints": all(len(limb) == LEG_JOINTS for limb in limbs),
        "legs that come first in `order`, the left one before the right": robot.layout.actuated[: len(legs)] == legs,
        "leg geometry (`leg`)": robot.leg,
        "hands on both sides": robot.hands.keys() >= set(SIDES),
        "an inertial sensor (`imu`)": robot.imu,
        "a posture of all joints above the legs": robot.posture.joints == robot.layout.actuated[len(legs) :],
    }
    missing = [what for what, there in needed.items() if not there]
    if missing:
        raise ConfigError(f"robot {robot.name} cannot walk; its table lacks: {', '.join(missing)}")
    return WalkingRobot(**vars(robot))
