"""What the walking controller knows of the robot, and how its feet stand."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.control.kinematics import KinematicTree, Pose, empty_pose, tree_of
from mobnet.control.leg_ik import LegGeometry
from mobnet.control.parameters import WalkingParameters, walking_parameters
from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled
from mobnet.robot.description import SIDES, WalkingRobot
from mobnet.settings.walking import Walking


class Walker(NamedTuple):
    """What the controller knows of the robot."""

    par: WalkingParameters  # numbers of the controller
    tree: KinematicTree  # bodies of the nominal model
    pose: Pose  # kinematics of the nominal model in the sensed state; filled by each tick
    leg: LegGeometry  # sizes of the left leg
    feet: NDArray[np.int64]  # bodies of the left, right foot (2,)
    first: NDArray[np.int64]  # first actuator of the left, right leg (2,)
    upper: int  # first actuator above the legs
    sensor: Array  # position of the force sensor in the foot (3,) [m]
    sole: Array  # centre of the sole in the foot (3,) [m]
    gravity: float  # gravity [m/s^2]
    wrench: Array  # measured wrenches of the ground about the ankles, foot axes (2, 6) [N, N m]; filled by each tick
    posture_stiffness: Array  # of the joints above the legs (nu - upper,) [N m/rad]
    posture_damping: Array  # of these joints (nu - upper,) [N m s/rad]
    posture: Array  # wanted positions of the joints above the legs (nu - upper,) [rad], written by what moves them
    posture_rate: Array  # wanted velocities of these joints (nu - upper,) [rad/s]
    work: Array  # scratch (3,)


def make_walker(robot: WalkingRobot, walking: Walking, mass_ratio: float, gravity_m_s2: float) -> Walker:
    """Build what the controller knows of a robot, with masses mass_ratio [-] times those of its table."""
    tree = tree_of(robot, mass_ratio)
    index = {body.name: i for i, body in enumerate(robot.bodies)}
    actuator = {name: i for i, name in enumerate(robot.layout.actuated)}
    limbs = [robot.layout.limb(robot.feet[side].limb) for side in SIDES]
    return Walker(
        par=walking_parameters(walking),
        tree=tree,
        pose=empty_pose(tree),
        leg=LegGeometry(np.array(robot.leg.hip_pos, dtype=float), float(robot.leg.link_length)),
        feet=np.array([index[robot.feet[side].body] for side in SIDES], dtype=np.int64),
        first=np.array([actuator[limb[0]] for limb in limbs], dtype=np.int64),
        upper=sum(map(len, limbs)),
        sensor=np.array(robot.sole.sensor_pos, dtype=float),
        sole=np.array([*robot.sole.box_centre[:2], robot.sole.height]),
        gravity=float(gravity_m_s2),
        wrench=np.zeros((2, 6)),
        posture_stiffness=robot.posture.stiffness,
        posture_damping=robot.posture.damping,
        posture=robot.posture.angle.copy(),
        posture_rate=np.zeros(len(robot.posture.angle)),
        work=np.zeros(3),
    )


@compiled
def foot_yaw(pose: Pose, foot: int) -> float:
    """Return the yaw of a body [rad]."""
    return np.arctan2(pose.rotation[foot, 1, 0], pose.rotation[foot, 0, 0])


@compiled
def vertical_force(walker: Walker, k: int) -> float:
    """Return the ground's vertical force on foot k (0 left, 1 right) [N], world axes."""
    up = walker.pose.rotation[walker.feet[k], 2]
    force = walker.wrench[k]
    return up[0] * force[0] + up[1] * force[1] + up[2] * force[2]


@compiled
def is_ground(walker: Walker, k: int) -> bool:
    """Return whether the ground can push foot k (0 left, 1 right) as measured: hard enough, inside its friction cone.

    An obstacle that stops the foot pushes it back harder than up.
    """
    pose = walker.pose.rotation[walker.feet[k]]
    force = walker.wrench[k]
    sideways2 = 0.0
    up = vertical_force(walker, k)
    for i in range(2):
        sideways2 += (pose[i, 0] * force[0] + pose[i, 1] * force[1] + pose[i, 2] * force[2]) ** 2
    return up > walker.par.touch_force_n and sideways2 < (walker.par.touch_friction * up) ** 2


@compiled
def move_wrenches(walker: Walker, wrenches: Array) -> None:
    """Fill walker.wrench from measured wrenches (2, 6) [N, N m], moved from the sensors to the ankles."""
    r = walker.sensor
    for k in range(2):
        for i in range(3):
            j = (i + 1) % 3
            n = (i + 2) % 3
            walker.wrench[k, i] = wrenches[k, i]
            walker.wrench[k, 3 + i] = wrenches[k, 3 + i] + r[j] * wrenches[k, n] - r[n] * wrenches[k, j]
