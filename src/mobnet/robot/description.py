"""The robot's table of figures as values: bodies, joints, feet, shapes. Both models are built from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mobnet.core.config import read_yaml
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.joints import JointLayout, layout_of
from mobnet.robot.parts import (
    Body,
    Foot,
    Joint,
    Point,
    Shape,
    Vector,
    read_body,
    read_joint,
    read_point,
    read_shape,
    vector,
    with_mirrored,
)

SIDES = ("left", "right")
WORLD = "world"


@dataclass(frozen=True)
class RobotDescription:
    """All figures of the robot; section 4.1 names its 33 joints and six virtual ones.

    Attributes:
        name: the robot's name.
        layout: order of the generalized velocity and the limb groups.
        bodies: links, parents first.
        joints: actuated joints in the order of `layout.actuated`.
        feet: `left` and `right`.
        hands: `left` and `right` -> body.
        sensor_pos: force/torque sensor in the foot's frame (3,) [m].
        sole_centre: centre of the sole's box in the foot's frame (3,) [m].
        sole_half: its half lengths (3,) [m].
        sole_height: the sole's lower face in the foot's frame [m].
        hip_pos: left hip in the base (3,) [m].
        link_length: length of thigh and of shank [m].
        imu_pos: inertial sensor in the base (3,) [m].
        shapes: what the robot looks like.
        points: where forces may be applied.
    """

    name: str
    layout: JointLayout
    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    feet: Mapping[str, Foot]
    hands: Mapping[str, str]
    sensor_pos: Vector
    sole_centre: Vector
    sole_half: Vector
    sole_height: float
    hip_pos: Vector
    link_length: float
    imu_pos: Vector
    shapes: tuple[Shape, ...]
    points: tuple[Point, ...]

    @property
    def base(self) -> str:
        """Name of the floating base."""
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
            ConfigError: the side is not `left` or `right`.
        """
        if side not in self.feet:
            raise ConfigError(not_accepted("foot", side, self.feet))
        return self.feet[side]


def load_robot(path: Path) -> RobotDescription:
    """Read a robot's table of figures (configs/robots/*.yaml).

    Raises:
        ConfigError: the table does not fit itself; the message names the value.
    """
    table = read_yaml(path)
    layout = layout_of(table["order"], table["groups"])
    feet, leg = table["feet"], table["leg"]
    robot = RobotDescription(
        name=table["name"],
        layout=layout,
        bodies=tuple(read_body(row) for row in table["bodies"]),
        joints=tuple(read_joint(row) for row in table["joints"]),
        feet={side: Foot(**feet[side]) for side in SIDES},
        hands=table["hands"],
        sensor_pos=vector(feet["sensor_pos"]),
        sole_centre=vector(feet["sole_box_centre"]),
        sole_half=vector(feet["sole_box_half"]),
        sole_height=float(feet["sole_height"]),
        hip_pos=vector(leg["hip_pos"]),
        link_length=float(leg["link_length"]),
        imu_pos=vector(table["imu"]["pos"]),
        shapes=tuple(read_shape(row, table["tones"]) for row in with_mirrored(table.get("shapes", []))),
        points=tuple(read_point(row) for row in with_mirrored(table.get("points", []))),
    )
    for problem in (_tree_problem(robot), _name_problem(robot), _order_problem(robot)):
        if problem is not None:
            raise ConfigError(f"{path}: {problem}")
    return robot


def _tree_problem(robot: RobotDescription) -> str | None:
    """Return what is wrong where a body hangs on none that stands before it."""
    known = [WORLD]
    for body in robot.bodies:
        if body.parent not in known:
            return not_accepted(f"parent of {body.name}", body.parent, known)
        known = [name for name in known if name != WORLD] + [body.name]
    return None


def _name_problem(robot: RobotDescription) -> str | None:
    """Return what is wrong where a joint, foot, hand, shape or point stands on a body that is not there."""
    known = [body.name for body in robot.bodies]
    users = [(f"body of {part.name}", part.body) for part in (*robot.shapes, *robot.points)]
    users += [(f"body of {joint.id}", joint.body) for joint in robot.joints]
    users += [(f"{side} foot", foot.body) for side, foot in robot.feet.items()]
    users += [(f"{side} hand", hand) for side, hand in robot.hands.items()]
    return next((not_accepted(what, name, known) for what, name in users if name not in known), None)


def _order_problem(robot: RobotDescription) -> str | None:
    """Return what is wrong where joints, or the bodies that they move, do not stand in motor order."""
    accepted = robot.layout.actuated
    listed = tuple(joint.id for joint in robot.joints)
    moved = {joint.body: joint.id for joint in robot.joints}
    depth_first = tuple(moved[body.name] for body in robot.bodies if body.name in moved)
    wrong = next((order for order in (listed, depth_first) if order != accepted), None)
    return None if wrong is None else f"joints stand in the order {wrong}; accepted: {accepted}"
