"""A robot's table and what follows from it; the plant, the nominal model and the controller are built from both."""

import hashlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import ConfigError
from mobnet.core.joints import LEG_AXES, JointLayout, Limits, right_of, with_image
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
    ShapeRow,
    SoleRow,
)
from mobnet.formats.robot import RobotTable

SIDES = ("left", "right")
LEG_JOINTS = len(LEG_AXES)
MIRROR_Y = np.array([1.0, -1.0, 1.0])
Row = TypeVar("Row", bound=PointRow)
Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Posture:
    """How joints are held while nothing moves them.

    Attributes:
        joints: names, in motor order (n,).
        angle: positions (n,) [rad].
        stiffness: torque of a position error (n,) [N m/rad].
        damping: torque of a velocity error (n,) [N m s/rad].
    """

    joints: tuple[str, ...]
    angle: Vector
    stiffness: Vector
    damping: Vector


@dataclass(frozen=True)
class RobotDescription:
    """All figures of a robot; section 4.1 names TOCABI's 33 joints and six virtual ones.

    Attributes:
        layout: order of the generalized velocity and the limb groups.
        bodies: links, depth-first, parents first, their quaternions of unit length.
        joints: actuated joints in the order of `layout.actuated`.
        feet: side -> foot, all on soles of one shape; empty for a robot without feet.
        hands: side -> body.
        posture: how the joints are held that nothing moves, in motor order; the table may leave joints out.
        shapes: what the robot looks like, both sides, in colours of `tones`.
        points: where forces may be applied, both sides.
        friction: joint -> friction and errors of its drive that the observer knows; empty where it knows none.
        notes: what a robot's file or model does not say and what was taken for it, a line each; none of a table.
    """

    name: str
    layout: JointLayout
    bodies: tuple[BodyRow, ...]
    joints: tuple[JointRow, ...]
    feet: Mapping[str, FootRow]
    sole: SoleRow | None
    hands: Mapping[str, str]
    leg: LegRow | None
    imu: ImuRow | None
    posture: Posture
    tones: Mapping[str, Colour]
    shapes: tuple[ShapeRow, ...]
    points: tuple[PointRow, ...]
    friction: Mapping[str, FrictionRow] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

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

    @property
    def drives(self) -> str | None:
        """Digest of friction and rotors where the table has friction: what was made with others does not fit."""
        if not self.friction:
            return None
        known = [sorted((joint, repr(row)) for joint, row in self.friction.items()), self.armature.tolist()]
        return hashlib.sha256(repr(known).encode()).hexdigest()[:16]

    def joint_of(self, body: str) -> JointRow | None:
        """Return the joint that moves a body, or None where the body is welded or the base."""
        return next((joint for joint in self.joints if joint.body == body), None)


Robot = TypeVar("Robot", bound=RobotDescription)


@dataclass(frozen=True)
class WalkingRobot(RobotDescription):
    """A robot with all that walking takes; `for_walking` makes one."""

    sole: SoleRow
    leg: LegRow
    imu: ImuRow


def describe(table: RobotTable) -> RobotDescription:
    """Return a robot's table with both sides of what is mirrored, and its posture in motor order."""
    # not `table.layout`: the code of settings is in no hash, so a job computes nothing with it
    legs = {side: foot.limb for side, foot in table.feet.items()}
    limits = {row.id: Limits(*row.range, row.velocity_limit, row.torque_limit) for row in table.joints}
    return RobotDescription(
        name=table.name,
        layout=JointLayout(table.order.virtual, table.order.actuated, table.groups, legs, limits),
        bodies=tuple(map(_with_unit_quaternion, table.bodies)),
        joints=table.joints,
        feet={**table.feet},
        sole=table.sole,
        hands={**table.hands},
        leg=table.leg,
        imu=table.imu,
        posture=_posture(table),
        tones=table.tones,
        shapes=with_mirrored(table.shapes),
        points=with_mirrored(table.points),
        friction={**table.friction},
    )


def for_walking(robot: RobotDescription) -> WalkingRobot:
    """Return a robot that walks.

    Raises:
        ConfigError: its table lacks something that walking takes; one line names all of it.
    """
    limbs = [robot.layout.limb(robot.feet[side].limb) for side in SIDES if side in robot.feet]
    legs = sum(limbs, ())
    axes = {_axes(robot, limb) for limb in limbs if len(limb) == LEG_JOINTS}
    needed = {
        "a floating base": robot.floating,
        "feet on both sides": robot.feet.keys() >= set(SIDES),
        f"legs of {LEG_JOINTS} joints": all(len(limb) == LEG_JOINTS for limb in limbs),
        f"legs whose joints have the axes {', '.join(LEG_AXES)} (here {'; '.join(sorted(axes))})": axes
        <= {", ".join(LEG_AXES)},
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


def _axes(robot: RobotDescription, limb: tuple[str, ...]) -> str:
    """Return the axes of a limb's joints in their bodies, such as `y, x`; `-` stands for one along no coordinate."""
    letters = {(1.0, 0.0, 0.0): "x", (0.0, 1.0, 0.0): "y", (0.0, 0.0, 1.0): "z"}
    axes = {joint.id: joint.axis for joint in robot.joints}
    return ", ".join(letters.get(axes[joint], "-") for joint in limb)


def with_mirrored(rows: Iterable[Row]) -> tuple[Row, ...]:
    """Return rows of the left side, each with its mirror image in y, and other rows as they are."""
    both_sides = list[Row]()
    for row in rows:
        both_sides.append(row)
        both_sides += [_mirrored(row, name) for name in with_image(row.name)[1:]]
    return tuple(both_sides)


def _mirrored(row: Row, name: str) -> Row:
    """Return a row of the left side as the right side has it, under its name."""
    update = {"name": name, "body": right_of(row.body), "pos": _in_y(row.pos)}
    if isinstance(row, ShapeRow) and row.segment is not None:
        update["segment"] = _in_y(row.segment)
    return row.model_copy(update=update)


def _in_y(points: tuple[float, ...]) -> tuple[float, ...]:
    """Return points, three coordinates each, mirrored in y."""
    return tuple((np.reshape(points, (-1, len(MIRROR_Y))) * MIRROR_Y).ravel().tolist())


def _with_unit_quaternion(row: BodyRow) -> BodyRow:
    """Return a body whose quaternion, published with six digits, is of unit length."""
    return row.model_copy(update={"quat": tuple(np.divide(row.quat, np.linalg.norm(row.quat)).tolist())})


def _posture(table: RobotTable) -> Posture:
    rows = dict[str, tuple[float, float, float]]()
    for limb, row in table.posture.items():
        springs = zip(row.angle_rad, row.stiffness_nm_rad, row.damping_nms_rad, strict=True)
        rows.update(zip(table.groups[limb], springs, strict=True))
    joints = tuple(joint for joint in table.order.actuated if joint in rows)
    numbers = np.array([rows[joint] for joint in joints], dtype=np.float64).reshape(-1, 3)
    return Posture(joints, *np.ascontiguousarray(numbers.T))


def dressed(robot: Robot, looks: Looks | None) -> Robot:
    """Return a robot whose solids are those of its looks, both sides; as it is where its table has none.

    The solids of a description that is not dressed are those that touch obstacles and the robot itself.
    """
    if looks is None:
        return robot
    return replace(robot, shapes=with_mirrored(looks.shapes), tones={**robot.tones, **looks.tones})
