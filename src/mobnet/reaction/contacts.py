"""Identification, section 7: which wrenches on hands and feet explain the estimated torques, and what is unexpected.

Intended contacts are those of end-effectors, so that one Jacobian a limb is enough. World axes; a wrench is a force [N]
and a moment [N m] about the origin of its body.
"""

from collections.abc import Collection, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.control.geometry import cross, solve
from mobnet.control.kinematics import KinematicTree, Pose, empty_pose, tree_of, update
from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled, on_stack, vector3
from mobnet.core.joints import N_VIRTUAL
from mobnet.reaction.numbers import WrenchDamping
from mobnet.robot.description import SIDES, RobotDescription

IN_THE_AIR = 0.5  # of a flag
vector6 = on_stack(6)


class Ends(NamedTuple):
    """The end-effectors of a robot's limbs and the wrenches on them."""

    tree: KinematicTree  # bodies of the nominal model
    pose: Pose  # their places; filled for each sample
    body: NDArray[np.int64]  # of each end-effector (k,)
    first: NDArray[np.int64]  # first actuator of its limb (k,)
    joints: NDArray[np.int64]  # number of the limb's joints (k,)
    damping: Array  # (C2) of the six numbers of a wrench [N^2 m^2/N^2], [N^2 m^2/(N m)^2]
    still: Array  # a generalized velocity of zeros (nv,)
    jacobian: Array  # room (6, n), linear above angular rows
    normal: Array  # room (6, 6)
    wrench: Array  # on each end-effector (k, 6) [N, N m]


def end_effectors(robot: RobotDescription) -> dict[str, str]:
    """Return limb -> body of its hand or foot, the left and right foot first."""
    joints = {joint.body: joint.id for joint in robot.joints}
    limbs = robot.layout.limb_of
    hands = {limbs[joints[body]]: body for body in robot.hands.values()}
    return {robot.feet[side].limb: robot.feet[side].body for side in SIDES} | hands


def make_ends(robot: RobotDescription, bodies: Mapping[str, str], numbers: WrenchDamping) -> Ends:
    """Return the end-effectors of limbs, limb -> body."""
    tree = tree_of(robot, 1.0)
    names = [body.name for body in robot.bodies]
    limbs = [robot.layout.limb(limb) for limb in bodies]
    first = [robot.layout.actuated.index(joints[0]) for joints in limbs]
    count = [len(joints) for joints in limbs]
    body = [names.index(name) for name in bodies.values()]
    per_force = numbers.torque_error_nm / numbers.force_n
    per_moment = numbers.torque_error_nm / numbers.moment_nm
    return Ends(
        tree=tree,
        pose=empty_pose(tree),
        body=np.array(body),
        first=np.array(first),
        joints=np.array(count),
        damping=np.repeat([per_force**2, per_moment**2], 3),
        still=np.zeros(robot.layout.nv),
        jacobian=np.zeros((6, max(count))),
        normal=np.zeros((6, 6)),
        wrench=np.zeros((len(body), 6)),
    )


@compiled
def identify(ends: Ends, q: Array, tau: Array) -> None:
    """Fill ends.wrench (k, 6) with what explains the torques tau (nv,) [N, N m] of each limb best at q (nq,).

    (C1) of the joints of a limb tau = J^T F; (C2) the wrench that makes `|J^T F - tau|^2 / s^2 + |F|^2 / F_0^2`
    smallest, with s the error of the torques and F_0 a wrench that is large: F = (J J^T + D)^-1 J tau. The damping D
    decides where the joints say nothing, as of a force along a straight leg (section 8.4).
    """
    update(ends.tree, q, ends.still, 0.0, ends.pose)
    for e in range(len(ends.body)):
        _fill_jacobian(ends, e)
        wrench = ends.wrench[e]
        wrench[:] = 0.0
        for j in range(ends.joints[e]):
            for i in range(6):
                wrench[i] += ends.jacobian[i, j] * tau[N_VIRTUAL + ends.first[e] + j]
        _fill_normal(ends, e)
        solve(ends.normal, wrench)


@compiled
def _fill_jacobian(ends: Ends, e: int) -> None:
    """Fill the first columns of ends.jacobian (6, n) with the contact Jacobian of an end-effector, (C1)."""
    arm = vector3()
    column = vector3()
    end = ends.body[e]
    for j in range(ends.joints[e]):
        joint = ends.first[e] + j
        body = ends.tree.body_of_joint[joint]
        for i in range(3):
            arm[i] = ends.pose.position[end, i] - ends.pose.position[body, i]
        cross(ends.pose.axis[joint], arm, column)
        for i in range(3):
            ends.jacobian[i, j] = column[i]
            ends.jacobian[3 + i, j] = ends.pose.axis[joint, i]


@compiled
def _fill_normal(ends: Ends, e: int) -> None:
    """Fill ends.normal (6, 6) with J J^T + D of (C2), after `_fill_jacobian`."""
    for i in range(6):
        for k in range(6):
            total = ends.damping[i] if i == k else 0.0
            for j in range(ends.joints[e]):
                total += ends.jacobian[i, j] * ends.jacobian[k, j]
            ends.normal[i, k] = total


def unexpected_wrench(ends: Ends, tau: Array, expected: Collection[int]) -> Array:
    """Return the wrench on the base that no expected contact explains, (24), (6,) [N, N m], after `identify`.

    tau (nv,) are the estimated torques, of which the first six are the base's: a force in world axes and a moment in
    base axes; `expected` are end-effectors that the plan has in contact, by their number.
    """
    rotation = ends.pose.rotation[0]
    origin = ends.pose.position[0]
    wrench = np.concatenate([tau[:3], rotation @ tau[3:N_VIRTUAL]])
    for e in expected:
        force, arm = ends.wrench[e, :3], ends.pose.position[ends.body[e]] - origin
        wrench[:3] -= force
        wrench[3:] -= ends.wrench[e, 3:] + np.cross(arm, force)
    return wrench


@compiled
def unexpected_force(
    ends: Ends, q: Array, tau: Array, std: Array, swing: NDArray[Any], height_m: float, force: Array, deviation: Array
) -> None:
    """Fill force (3,) with the force of (24) on the base, in base axes, and deviation (3,) with its standard deviation.

    q (nq,) is the generalized position, tau (nv,) the estimate and std (nv,) its standard deviation [N, N m], errors of
    joints being independent of each other. A foot that the plan has in the air, `swing` (2,), is expected on the ground
    all the same unless it is more than height_m [m] above the other one: it may meet the ground, or be leaving it.
    """
    update(ends.tree, q, ends.still, 0.0, ends.pose)
    rotation = ends.pose.rotation[0]
    weights = vector6()
    for i in range(3):
        force[i] = deviation[i] = 0.0
        for k in range(3):
            force[i] += rotation[k, i] * tau[k]
            deviation[i] += (rotation[k, i] * std[k]) ** 2
    for e in range(2):
        height = ends.pose.position[ends.body[e], 2] - ends.pose.position[ends.body[1 - e], 2]
        if swing[e] > IN_THE_AIR and height > height_m:
            continue
        _fill_jacobian(ends, e)
        for i in range(3):
            # One component of the foot's force is a sum over the leg's torques: a^T F = (J^T (J J^T + D)^-1 a)^T tau.
            for k in range(3):
                weights[k] = rotation[k, i]
                weights[3 + k] = 0.0
            _fill_normal(ends, e)
            solve(ends.normal, weights)
            for j in range(ends.joints[e]):
                share = 0.0
                for k in range(6):
                    share += ends.jacobian[k, j] * weights[k]
                joint = N_VIRTUAL + ends.first[e] + j
                force[i] -= share * tau[joint]
                deviation[i] += (share * std[joint]) ** 2
    for i in range(3):
        deviation[i] = np.sqrt(deviation[i])


@compiled
def unexpected_forces(
    ends: Ends, q: Array, tau: Array, std: Array, swing: NDArray[Any], height_m: float, force: Array, deviation: Array
) -> None:
    """Fill force and deviation (T, 3) of samples (T, ...) as `unexpected_force` does."""
    for row in range(len(q)):
        unexpected_force(ends, q[row], tau[row], std[row], swing[row], height_m, force[row], deviation[row])


@compiled
def tell_feet(ends: Ends, sensor: Array, swing: NDArray[Any], height_m: float, readings: Array) -> None:
    """Write the wrenches of the ground as the feet's sensors would read them into told (2, 6), after `identify`.

    The first two end-effectors are the feet; `sensor` (3,) [m] is the place of the sensor in a foot. A foot that the
    plan has in the air, `swing` (2,), and that is more than height_m [m] above the other one, touches no ground: what
    it feels is something else, which would look like a landing.
    """
    arm = vector3()
    for k in range(len(readings)):
        rotation = ends.pose.rotation[ends.body[k]]
        wrench = ends.wrench[k]
        height = ends.pose.position[ends.body[k], 2] - ends.pose.position[ends.body[1 - k], 2]
        if swing[k] > IN_THE_AIR and height > height_m:
            readings[k] = 0.0
            continue
        for i in range(3):
            readings[k, i] = readings[k, 3 + i] = 0.0
            for j in range(3):
                readings[k, i] += rotation[j, i] * wrench[j]
                readings[k, 3 + i] += rotation[j, i] * wrench[3 + j]
        cross(sensor, readings[k, :3], arm)
        for i in range(3):
            readings[k, 3 + i] -= arm[i]
