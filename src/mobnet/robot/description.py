"""The robot's table of figures as values: bodies, joints, feet, shapes. Both models are built from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mobnet.core.config import read_yaml
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.joints import JointLayout, layout_of

SIDES = ("left", "right")
WORLD = "world"
MIRROR_Y = np.array([1.0, -1.0, 1.0])
Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Body:
    """A link, without its rotor.

    Attributes:
        name: name in the table.
        parent: name of the body it hangs on, `world` for the base.
        pos: origin in the parent's frame (3,) [m].
        quat: orientation in the parent's frame, unit, w x y z (4,).
        mass: link mass [kg].
        com: centre of mass in body axes (3,) [m].
        inertia: about the centre of mass, body axes: xx yy zz xy xz yz (6,) [kg m^2].
    """

    name: str
    parent: str
    pos: Vector
    quat: Vector
    mass: float
    com: Vector
    inertia: Vector


@dataclass(frozen=True)
class Joint:
    """An actuated hinge at its body's origin.

    Attributes:
        id: name used in this project, LL1 and so on (Figure 4).
        body: name of the body it moves.
        axis: unit axis in body axes (3,).
        range: lower and upper limit (2,) [rad].
        torque_limit: largest motor torque [N m].
        armature: reflected rotor inertia [kg m^2].
        velocity_limit: largest speed [rad/s].
    """

    id: str
    body: str
    axis: Vector
    range: Vector
    torque_limit: float
    armature: float
    velocity_limit: float


@dataclass(frozen=True)
class Foot:
    """A foot: `body` is welded to `ankle`, the last link of the leg `limb`."""

    body: str
    ankle: str
    limb: str


@dataclass(frozen=True)
class Shape:
    """A solid to look at, without mass; either `pos` (3,) [m] or `segment` (6,) [m] places it in its body's frame.

    Attributes:
        name: name of the solid.
        body: body that carries it.
        type: capsule, cylinder, box, ellipsoid or sphere.
        size: radius or half lengths [m].
        pos: centre (3,) [m].
        segment: both ends (6,) [m], or None.
        rgba: colour (4,), 0..1.
    """

    name: str
    body: str
    type: str
    size: Vector
    pos: Vector
    segment: Vector | None
    rgba: Vector


@dataclass(frozen=True)
class Point:
    """A named point of a body, pos (3,) [m] in body axes."""

    name: str
    body: str
    pos: Vector


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
        bodies=tuple(_body(row) for row in table["bodies"]),
        joints=tuple(_joint(row) for row in table["joints"]),
        feet={side: Foot(**feet[side]) for side in SIDES},
        hands=table["hands"],
        sensor_pos=_vector(feet["sensor_pos"]),
        sole_centre=_vector(feet["sole_box_centre"]),
        sole_half=_vector(feet["sole_box_half"]),
        sole_height=float(feet["sole_height"]),
        hip_pos=_vector(leg["hip_pos"]),
        link_length=float(leg["link_length"]),
        imu_pos=_vector(table["imu"]["pos"]),
        shapes=tuple(_shape(row, table["tones"]) for row in with_mirrored(table.get("shapes", []))),
        points=tuple(
            Point(row["name"], row["body"], _vector(row["pos"])) for row in with_mirrored(table.get("points", []))
        ),
    )
    _check(robot, path)
    return robot


def with_mirrored(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return rows of the left side together with their mirror images in y; other rows stay alone."""
    return [image for row in rows for image in ([row, _mirrored(row)] if row["name"].startswith("left_") else [row])]


def _mirrored(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return a row of the left side as the right side has it."""
    image = {**row, "name": row["name"].replace("left_", "right_", 1), "body": row["body"].replace("L_", "R_", 1)}
    for key in ("pos", "segment"):
        if key in row:
            image[key] = (np.reshape(row[key], (-1, len(MIRROR_Y))) * MIRROR_Y).ravel()
    return image


def _vector(values: ArrayLike) -> Vector:
    """Return numbers of the table as a float64 vector."""
    return np.asarray(values, dtype=np.float64)


def _body(row: Mapping[str, Any]) -> Body:
    """Return a row of `bodies`; its quaternion is brought to unit length."""
    quat = _vector(row["quat"])
    return Body(
        row["name"],
        row["parent"],
        _vector(row["pos"]),
        quat / np.linalg.norm(quat),
        float(row["mass"]),
        _vector(row["com"]),
        _vector(row["inertia"]),
    )


def _joint(row: Mapping[str, Any]) -> Joint:
    """Return a row of `joints`."""
    return Joint(
        row["id"],
        row["body"],
        _vector(row["axis"]),
        _vector(row["range"]),
        float(row["torque_limit"]),
        float(row["armature"]),
        float(row["velocity_limit"]),
    )


def _shape(row: Mapping[str, Any], tones: Mapping[str, Any]) -> Shape:
    """Return a row of `shapes`."""
    return Shape(
        row["name"],
        row["body"],
        row["type"],
        _vector(row["size"]),
        _vector(row.get("pos", np.zeros_like(MIRROR_Y))),
        _vector(row["segment"]) if "segment" in row else None,
        _vector(tones[row["tone"]]),
    )


def _check(robot: RobotDescription, path: Path) -> None:
    """Raise a ConfigError where bodies, joints, feet or shapes name what is not there or stand in another order."""
    known = [body.name for body in robot.bodies]
    for i, body in enumerate(robot.bodies):
        if body.parent not in (known[:i] or [WORLD]):
            raise ConfigError(f"{path}: " + not_accepted(f"parent of {body.name}", body.parent, known[:i] or [WORLD]))
    names = [(f"body of {part.name}", part.body) for part in (*robot.shapes, *robot.points)]
    names += [(f"body of {joint.id}", joint.body) for joint in robot.joints]
    names += [(f"{side} foot", foot.body) for side, foot in robot.feet.items()]
    for what, name in names + [("hand", hand) for hand in robot.hands.values()]:
        if name not in known:
            raise ConfigError(f"{path}: " + not_accepted(what, name, known))
    order = tuple(joint.id for joint in robot.joints)
    if order != robot.layout.actuated:
        raise ConfigError(f"{path}: joints stand as {order}; accepted: {robot.layout.actuated}")
    moved = {joint.body: joint.id for joint in robot.joints}
    depth_first = tuple(moved[name] for name in known if name in moved)
    if depth_first != order:
        raise ConfigError(f"{path}: bodies move joints in the order {depth_first}; accepted: {order}")
