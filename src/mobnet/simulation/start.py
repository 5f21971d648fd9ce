"""Start of an episode, standing or in the middle of a step: from rest, friction spoils the first shift of weight.

The start is on ground at height zero, facing along x; `turn` and `raise_start` move it elsewhere.
"""

import numpy as np

from mobnet.control.geometry import solve
from mobnet.control.kinematics import update
from mobnet.control.leg_ik import leg_ik
from mobnet.control.parameters import State
from mobnet.control.steps import DURATION, SIDES
from mobnet.control.walker import Walker
from mobnet.control.whole_body import leg_jacobian
from mobnet.core.arrays import Array
from mobnet.robot.description import WalkingRobot

CLEARANCE_M = 0.001  # soles over the ground at the start
ITERATIONS = 20  # of the feet's place under the centre of mass; converges by a factor 4 each


def place(walker: Walker, robot: WalkingRobot) -> tuple[Array, Array]:
    """Return q (nq,) and the ankles (2, 3) [m] of standing in the walker's posture: level, weight over the ZMP."""
    par = walker.par
    q = np.zeros(robot.layout.nq)
    v = np.zeros(robot.layout.nv)
    q[2] = CLEARANCE_M + par.pelvis_height_m
    q[3] = 1.0
    q[7 + walker.upper :] = walker.posture
    ankles = np.zeros((2, 3))
    ankles[:, 2] = CLEARANCE_M - robot.sole.height
    ankles[:, 1] = np.array(SIDES) * par.foot_spacing_m / 2
    for _ in range(ITERATIONS):
        for k, side in enumerate(SIDES):
            first = 7 + walker.first[k]
            leg_ik(walker.leg, side, np.eye(3), q[:3], np.eye(3), ankles[k], q[first : first + 6])
        update(walker.tree, q, v, walker.gravity, walker.pose)
        ankles[:, 0] = walker.pose.com[0] - par.zmp_offset_x_m
    return q, ankles


def start_walking(walker: Walker, robot: WalkingRobot, s: State, command: Array) -> tuple[Array, Array]:
    """Return q (nq,) and v (nv,) amid double support of a first command (5,), swaying to the left; s is overwritten.

    The pelvis has the lateral speed of a linear inverted pendulum that steps in place, (W49).
    """
    par = walker.par
    q, ankles = place(walker, robot)
    omega = np.sqrt(walker.gravity / (walker.pose.com[2] - ankles[0, 2] - robot.sole.height))
    sway = omega * par.foot_spacing_m / 2 * np.tanh(omega * command[DURATION] / 2)
    v = np.zeros(robot.layout.nv)
    v[6 + walker.upper :] = walker.posture_rate
    v[1] = sway
    for k in range(2):
        jacobian = np.zeros((6, 6))
        rates = np.zeros(6)
        leg_jacobian(walker, k, jacobian)
        rates[1] = -sway
        solve(jacobian, rates)
        v[6 + walker.first[k] : 12 + walker.first[k]] = rates
    _set_state(walker, s, command, q, ankles)
    s.t = par.double_support_share * command[DURATION] / 2
    s.velocity[1] = sway
    return q, v


def start_standing(walker: Walker, robot: WalkingRobot, s: State, command: Array) -> tuple[Array, Array]:
    """Return q (nq,) and v (nv,) of a still stance and set the controller to stand; arguments as `start_walking`'s."""
    q, ankles = place(walker, robot)
    _set_state(walker, s, command, q, ankles)
    s.standing = 1
    v = np.zeros(robot.layout.nv)
    v[6 + walker.upper :] = walker.posture_rate
    return q, v


def turn(s: State, q: Array, v: Array, yaw: float, place: Array) -> None:
    """Turn a start about the origin by yaw [rad] and move it to place (2,) [m]; q (nq,), v (nv,) and s are changed."""
    c = np.cos(yaw)
    n = np.sin(yaw)
    rotation = np.array([[c, -n], [n, c]])
    for vector in (q[:2], v[:2], s.old_ankle[:2], s.velocity):
        vector[:] = rotation @ vector
    q[:2] += place
    s.old_ankle[:2] += place
    q[3:7] = [np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)]
    s.yaw = s.yaw_start = s.old_yaw = s.stance_yaw = yaw


def raise_start(s: State, q: Array, height_m: float) -> None:
    """Put a start on ground at a height [m]; q (nq,) and s are changed."""
    q[2] += height_m
    s.old_ankle[2] += height_m
    s.height += height_m


def _set_state(walker: Walker, s: State, command: Array, q: Array, ankles: Array) -> None:
    """Set the controller's state to both feet on the ground, the left one about to carry the robot."""
    for name in s.dtype.names or ():
        s[name] = 0
    s.side = SIDES[0]
    s.command = command
    s.total = s.commanded = command[DURATION]
    s.old_ankle = ankles[1]
    s.height = q[2]
    s.load = 0.5
    s.omega = np.sqrt(walker.gravity / walker.par.pelvis_height_m)
