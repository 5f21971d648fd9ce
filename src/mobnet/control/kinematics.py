"""Forward kinematics and centroidal quantities of the nominal model, compiled; one pass over the body tree."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.control.geometry import axis_angle_to_matrix, cross, multiply, quaternion_to_matrix, rotate
from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled, matrix3, vector3
from mobnet.robot.description import RobotDescription

Indices = NDArray[np.int64]


class KinematicTree(NamedTuple):
    """Bodies, parents first; body 0 is the base."""

    parent: Indices  # index of the parent body (nb,)
    joint: Indices  # index of the actuator that moves the body, -1 for a fixed one (nb,)
    offset: Array  # position in the parent (nb, 3) [m]
    turn: Array  # fixed orientation in the parent (nb, 3, 3)
    axis: Array  # joint axis in the body (nb, 3)
    mass: Array  # nominal mass (nb,) [kg]
    com: Array  # centre of mass in the body (nb, 3) [m]
    inertia: Array  # mean principal moment of inertia (nb,) [kg m^2]; needs no turning into the world, see (W1)
    body_of_joint: Indices  # body moved by each actuator (nu,)


class Pose(NamedTuple):
    """Result of `update`, in world axes; the same arrays are filled again in each tick."""

    rotation: Array  # orientation of bodies (nb, 3, 3)
    position: Array  # origin of bodies (nb, 3) [m]
    velocity: Array  # velocity of the origins (nb, 3) [m/s]
    omega: Array  # angular velocity of bodies (nb, 3) [rad/s]
    axis: Array  # joint axes (nu, 3)
    moment: Array  # mass times centre of mass of each subtree (nb, 3) [kg m]
    weight: Array  # mass of each subtree (nb,) [kg]
    com: Array  # centre of mass of the robot (3,) [m]
    com_velocity: Array  # velocity of the centre of mass (3,) [m/s]
    spin: Array  # angular momentum about the centre of mass (3,) [N m s]
    gravity: Array  # torque that holds each subtree against gravity (nu,) [N m]


def tree_of(robot: RobotDescription, mass_ratio: float) -> KinematicTree:
    """Build the tree of a robot with all masses and inertias times mass_ratio [-]."""
    bodies = robot.bodies
    index = {body.name: i for i, body in enumerate(bodies)}
    moved = np.array([index[joint.body] for joint in robot.joints], dtype=np.int64)
    joint = np.full(len(bodies), -1)
    turn = np.zeros((len(bodies), 3, 3))
    axis = np.zeros((len(bodies), 3))
    joint[moved], axis[moved] = np.arange(len(moved)), [joint.axis for joint in robot.joints]
    for i, body in enumerate(bodies):
        quaternion_to_matrix(np.asarray(body.quat) / np.linalg.norm(body.quat), turn[i])
    return KinematicTree(
        parent=np.array([index.get(body.parent, -1) for body in bodies], dtype=np.int64),
        joint=joint,
        offset=np.array([body.pos for body in bodies], dtype=float),
        turn=turn,
        axis=axis,
        mass=mass_ratio * np.array([body.mass for body in bodies]),
        com=np.array([body.com for body in bodies], dtype=float),
        inertia=mass_ratio * np.array([np.mean(body.inertia[:3]) for body in bodies], dtype=float),
        body_of_joint=moved,
    )


def empty_pose(tree: KinematicTree) -> Pose:
    """Return a pose of zeros for the bodies and joints of a tree."""
    nb = len(tree.parent)
    nu = len(tree.body_of_joint)
    return Pose(
        rotation=np.zeros((nb, 3, 3)),
        position=np.zeros((nb, 3)),
        velocity=np.zeros((nb, 3)),
        omega=np.zeros((nb, 3)),
        axis=np.zeros((nu, 3)),
        moment=np.zeros((nb, 3)),
        weight=np.zeros(nb),
        com=np.zeros(3),
        com_velocity=np.zeros(3),
        spin=np.zeros(3),
        gravity=np.zeros(nu),
    )


@compiled
def update(tree: KinematicTree, q: Array, v: Array, gravity_m_s2: float, pose: Pose) -> None:
    """Fill the pose from a generalized position q (nq,) [m, -, rad] and velocity v (nv,) [m/s, rad/s]."""
    quaternion_to_matrix(q[3:7], pose.rotation[0])
    for i in range(3):
        pose.position[0, i] = q[i]
        pose.velocity[0, i] = v[i]
    rotate(pose.rotation[0], v[3:6], pose.omega[0])
    _chain(tree, q, v, pose)
    _centroid(tree, pose)
    _subtrees(tree, gravity_m_s2, pose)


@compiled
def _chain(tree: KinematicTree, q: Array, v: Array, pose: Pose) -> None:
    """Fill orientation, position and velocity of every body from those of its parent."""
    fixed = matrix3()
    turned = matrix3()
    arm = vector3()
    swept = vector3()
    for b in range(1, len(tree.parent)):
        parent = tree.parent[b]
        joint = int(tree.joint[b])
        rotate(pose.rotation[parent], tree.offset[b], arm)
        cross(pose.omega[parent], arm, swept)
        multiply(pose.rotation[parent], tree.turn[b], fixed)
        for i in range(3):
            pose.position[b, i] = pose.position[parent, i] + arm[i]
            pose.velocity[b, i] = pose.velocity[parent, i] + swept[i]
            pose.omega[b, i] = pose.omega[parent, i]
        if joint < 0:
            for i in range(3):
                for j in range(3):
                    pose.rotation[b, i, j] = fixed[i, j]
            continue
        rotate(fixed, tree.axis[b], pose.axis[joint])
        axis_angle_to_matrix(tree.axis[b], q[7 + joint], turned)
        multiply(fixed, turned, pose.rotation[b])
        for i in range(3):
            pose.omega[b, i] += pose.axis[joint, i] * v[6 + joint]


@compiled
def _centroid(tree: KinematicTree, pose: Pose) -> None:
    """Fill the centre of mass, its velocity and the angular momentum about it, (W1).

    `weight` and `moment` get each body's own mass and first moment, to which `_subtrees` adds those of its children.
    """
    arm = vector3()
    swept = vector3()
    total = 0.0
    pose.com[:] = 0.0
    pose.com_velocity[:] = 0.0
    pose.spin[:] = 0.0
    for b in range(len(tree.parent)):
        m = tree.mass[b]
        total += m
        pose.weight[b] = m
        rotate(pose.rotation[b], tree.com[b], arm)
        cross(pose.omega[b], arm, swept)
        for i in range(3):
            place = pose.position[b, i] + arm[i]
            speed = pose.velocity[b, i] + swept[i]
            arm[i] = place
            swept[i] = speed
            pose.moment[b, i] = m * place
            pose.com[i] += m * place
            pose.com_velocity[i] += m * speed
        for i in range(3):
            j = (i + 1) % 3
            k = (i + 2) % 3
            pose.spin[i] += m * (arm[j] * swept[k] - arm[k] * swept[j]) + tree.inertia[b] * pose.omega[b, i]
    for i in range(3):
        pose.com[i] /= total
        pose.com_velocity[i] /= total
    for i in range(3):  # the sum above is about the world's origin
        j = (i + 1) % 3
        k = (i + 2) % 3
        pose.spin[i] -= total * (pose.com[j] * pose.com_velocity[k] - pose.com[k] * pose.com_velocity[j])


@compiled
def _subtrees(tree: KinematicTree, gravity_m_s2: float, pose: Pose) -> None:
    """Sum masses and first moments of subtrees from the leaves on and fill the gravity torque of every joint, (W40)."""
    for b in range(len(tree.parent) - 1, 0, -1):
        parent = tree.parent[b]
        joint = tree.joint[b]
        pose.weight[parent] += pose.weight[b]
        for i in range(3):
            pose.moment[parent, i] += pose.moment[b, i]
        if joint >= 0:
            mx = pose.moment[b, 0] - pose.weight[b] * pose.position[b, 0]
            my = pose.moment[b, 1] - pose.weight[b] * pose.position[b, 1]
            pose.gravity[joint] = gravity_m_s2 * (pose.axis[joint, 0] * my - pose.axis[joint, 1] * mx)
