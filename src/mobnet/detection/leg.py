"""A leg as its joints feel it: the force on its foot, and what a force at a point of it does to its joints."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.control.geometry import cross, solve
from mobnet.control.kinematics import KinematicTree, Pose, empty_pose, tree_of, update
from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.robot.description import LEG_JOINTS, RobotDescription

FORWARD, LEFT = 0, 1  # axes of a body


class Leg(NamedTuple):
    """A leg of the nominal model, and room for its kinematics."""

    tree: KinematicTree  # bodies
    pose: Pose  # their places; filled for each sample
    first: int  # first actuator of the leg
    foot: int  # body of the foot
    other: int  # body of the other foot
    corners: Array  # of the sole, foot axes (4, 3) [m]
    still: Array  # a generalized velocity of zeros (nv,)
    jacobian: Array  # room (6, 6): transposed Jacobian of the foot
    load: Array  # force [N] and moment [N m] on the foot, world axes, about its origin (6,)


def make_leg(robot: RobotDescription, limb: str) -> Leg:
    """Return a leg of a robot.

    Raises:
        ConfigError: the limb is no leg of six joints, or the robot has no second foot or no soles.
    """
    sides = {foot.limb: side for side, foot in robot.feet.items()}
    joints = robot.layout.groups.get(limb, ())
    if limb not in sides or len(joints) != LEG_JOINTS:
        legs = [name for name in sides if len(robot.layout.limb(name)) == LEG_JOINTS]
        raise ConfigError(not_accepted(f"leg of {LEG_JOINTS} joints", limb, legs))
    tree = tree_of(robot, 1.0)
    others = [foot.body for side, foot in robot.feet.items() if side != sides[limb]]
    if not others or robot.sole is None:
        raise ConfigError(f"robot {robot.name}: a leg that is watched takes two feet (`feet`) and their `sole`")
    names = [body.name for body in robot.bodies]
    foot = names.index(robot.feet[sides[limb]].body)
    other = names.index(others[0])
    first = robot.layout.actuated.index(joints[0])
    centre = robot.sole.box_centre
    half = robot.sole.box_half
    corners = [(centre[0] + x * half[0], centre[1] + y * half[1], robot.sole.height) for x in (-1, 1) for y in (-1, 1)]
    return Leg(
        tree=tree,
        pose=empty_pose(tree),
        first=first,
        foot=foot,
        other=other,
        corners=np.array(corners),
        still=np.zeros(robot.layout.nv),
        jacobian=np.zeros((6, 6)),
        load=np.zeros(6),
    )


@compiled
def foot_load(leg: Leg, q: Array, tau: Array) -> bool:
    """Write into leg.load which wrench on the foot explains the torques of the leg's joints; return whether one does.

    tau = J^T F with the six rows of the leg, at a generalized position q (nq,) [m, -, rad] and torques tau (6,) [N m].
    """
    # (D5): six joints and six numbers of a wrench, so that one pose gives one wrench. Ground, a hit on another link and
    # the error of the estimate all go into it, see docs/notes/detection.md.
    update(leg.tree, q, leg.still, 0.0, leg.pose)
    arm = leg.load[:3]  # room
    for j in range(LEG_JOINTS):
        body = leg.tree.body_of_joint[leg.first + j]
        axis = leg.pose.axis[leg.first + j]
        for i in range(3):
            arm[i] = leg.pose.position[leg.foot, i] - leg.pose.position[body, i]
        cross(axis, arm, leg.jacobian[j, :3])
        for i in range(3):
            leg.jacobian[j, 3 + i] = axis[i]
    for j in range(LEG_JOINTS):
        leg.load[j] = tau[j]
    return solve(leg.jacobian, leg.load)


@compiled
def sole_height(leg: Leg) -> float:
    """Return how high the lowest corner of the sole is above that of the other foot [m], in the pose of `foot_load`."""
    return _lowest(leg, leg.foot) - _lowest(leg, leg.other)


@compiled
def _lowest(leg: Leg, foot: int) -> float:
    """Return the height of the lowest corner of a foot's sole [m]."""
    lowest = np.inf
    for k in range(len(leg.corners)):
        height = leg.pose.position[foot, 2]
        for i in range(3):
            height += leg.pose.rotation[foot, 2, i] * leg.corners[k, i]
        lowest = min(lowest, height)
    return lowest


def unit_torques(robot: RobotDescription, leg: Leg, q: NDArray[Any], points: Sequence[str], inward: float) -> Array:
    """Return what a force of 1 N at points of a leg does to its joints (n, 6) [N m/N], at a position q (nq,).

    A point whose name ends in `front` is pushed against the x axis of its body, any other towards the other leg, along
    the y axis times `inward`: -1 for a left leg, 1 for a right one. Points above a joint do not load it.

    Raises:
        ConfigError: the robot has no such point.
    """
    update(leg.tree, np.asarray(q, dtype=np.float64), leg.still, 0.0, leg.pose)
    rows = {row.name: row for row in robot.points}
    names = [body.name for body in robot.bodies]
    torques = np.zeros((len(points), LEG_JOINTS))
    for k, name in enumerate(points):
        if name not in rows:
            raise ConfigError(not_accepted("point of the robot", name, rows))
        body = names.index(rows[name].body)
        # [5.3] hits legs from the front and from the side, which is the outside: the other leg is in the way inside.
        axes = leg.pose.rotation[body]
        force = -axes[:, FORWARD] if name.endswith("front") else inward * axes[:, LEFT]
        place = leg.pose.position[body] + axes @ np.asarray(rows[name].pos)
        # (D9): a joint below the point carries nothing of it, which is what tells links apart.
        above = ancestors(leg.tree, body)
        for j in range(LEG_JOINTS):
            moved = int(leg.tree.body_of_joint[leg.first + j])
            if moved in above:
                arm = place - leg.pose.position[moved]
                torques[k, j] = leg.pose.axis[leg.first + j] @ np.cross(arm, force)
    return torques


def ancestors(tree: KinematicTree, body: int) -> set[int]:
    """Return a body and all above it."""
    bodies: set[int] = set()
    while body >= 0:
        bodies.add(body)
        body = int(tree.parent[body])
    return bodies
