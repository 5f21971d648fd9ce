"""From the ground's force and the feet's targets to joint torques.

Stance legs transmit the force to the ground, the swing leg and the upper body follow their references. The equations
(W39) to (W46) are derived in docs/notes/walking.md. Arguments that recur: `s`, the controller's state;
`k`, a leg (0 left, 1 right); `q` (nq,) and `v` (nv,), sensed position and velocity; `dt`, a tick [s].
"""

import numpy as np

from mobnet.control.geometry import clip, cross, dead, solve, triple, yaw_roll_pitch_matrix
from mobnet.control.leg_ik import leg_ik
from mobnet.control.parameters import State
from mobnet.control.steps import SIDES
from mobnet.control.walker import Walker
from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled, matrix3, vector3
from mobnet.robot.description import LEG_JOINTS

LEFT_SIDE, RIGHT_SIDE = SIDES
KNEE, ANKLE_PITCH, ANKLE_ROLL = 3, 4, 5  # joints of a leg


@compiled
def leg_jacobian(walker: Walker, k: int, out: Array) -> None:
    """Write the Jacobian (6, 6) of the ankle against the base: linear above angular rows, world axes, (W39)."""
    pose = walker.pose
    first = walker.first[k]
    foot = walker.feet[k]
    arm = vector3()
    column = vector3()
    for j in range(LEG_JOINTS):
        body = walker.tree.body_of_joint[first + j]
        for i in range(3):
            arm[i] = pose.position[foot, i] - pose.position[body, i]
        cross(pose.axis[first + j], arm, column)
        for i in range(3):
            out[i, j] = column[i]
            out[3 + i, j] = pose.axis[first + j, i]


@compiled
def leg_reference(walker: Walker, s: State, k: int, swings: bool) -> None:
    """Fill q_reference[k] [rad] and v_reference[k] [rad/s] of leg k (0 left, 1 right), (W39).

    A swing leg brings its foot to the target, seen from the measured pelvis. A stance leg brings the pelvis to its
    level orientation, height and yaw over the measured foot; the pelvis' place in x and y is left to the pendulum.
    """
    leg = walker.leg
    pose = walker.pose
    foot = walker.feet[k]
    side = LEFT_SIDE if k == 0 else RIGHT_SIDE
    rates = s.v_reference[k]
    arm = vector3()
    swept = vector3()
    if swings:
        leg_ik(leg, side, pose.rotation[0], pose.position[0], s.foot_rotation, s.foot, s.q_reference[k])
        for i in range(3):
            arm[i] = pose.position[foot, i] - pose.position[0, i]
        cross(pose.omega[0], arm, swept)
        for i in range(3):
            rates[i] = s.foot_velocity[i] - pose.velocity[0, i] - swept[i]
            rates[3 + i] = -pose.omega[0, i]
        rates[5] += s.foot_yaw_rate
    else:
        level = matrix3()
        base = vector3()
        yaw_roll_pitch_matrix(s.yaw, 0.0, 0.0, level)
        base[0], base[1], base[2] = pose.position[0, 0], pose.position[0, 1], s.height
        leg_ik(leg, side, level, base, pose.rotation[foot], pose.position[foot], s.q_reference[k])
        rates[0], rates[1], rates[2] = -pose.velocity[0, 0], -pose.velocity[0, 1], -s.height_rate
        rates[3:] = 0.0
    leg_jacobian(walker, k, s.jacobian)
    if not solve(s.jacobian, rates):  # a straight leg has no inverse
        rates[:] = 0.0
    fastest = walker.par.joint_speed_max_rad_s
    for j in range(LEG_JOINTS):
        rates[j] = clip(rates[j], -fastest, fastest)


@compiled
def stance_torque(walker: Walker, s: State, k: int, q: Array, v: Array, point: Array, dt: float, tau: Array) -> None:
    """Add the torques of a stance leg that the ground pushes at point (3,) [m] to tau (nu,) [N m], (W41) and (W42)."""
    par = walker.par
    pose = walker.pose
    first = walker.first[k]
    load = s.load[k]
    arm = vector3()
    force = vector3()
    for i in range(3):
        force[i] = load * s.force[i]
    force[2] += par.load_gain * s.load_error[k]  # (W23)
    for j in range(LEG_JOINTS):
        joint = first + j
        body = walker.tree.body_of_joint[joint]
        for i in range(3):
            arm[i] = point[i] - pose.position[body, i]
        push = triple(pose.axis[joint], arm, force)
        error = s.q_reference[k, j] - q[7 + joint]
        rate = s.v_reference[k, j] - v[6 + joint]
        # (W41): hip and knee keep the pelvis level; a leg without load is soft, or it would push when it lands early.
        # (W42): the ankle has no stiffness, so that the sole takes the ground's orientation.
        if j < ANKLE_PITCH:
            pull = par.leg_stiffness_nm_rad[j] * error + par.leg_damping_nms_rad[j] * rate
            tau[joint] += (par.unloaded_stiffness + (1.0 - par.unloaded_stiffness) * load) * pull - push
            if j == KNEE:  # (W50): beyond the maximum of its friction law, more torque of a motor moves less
                tau[joint] = clip(tau[joint], -par.knee_torque_max_nm, par.knee_torque_max_nm)
        else:
            tau[joint] += par.ankle_damping_nms * rate - push
            tau[joint] += _ankle_correction(walker, s, k, j - ANKLE_PITCH, push, dt)


@compiled
def _ankle_correction(walker: Walker, s: State, k: int, which: int, push: float, dt: float) -> float:
    """Return the torque [N m] that corrects the ankle's moment, (W43), and keeps the foot from tipping, (W44).

    The ankle's axis is pitch where `which` is 0, else roll; `push` is the wanted moment of the ground about it [N m].
    """
    par = walker.par
    pose = walker.pose
    foot = walker.feet[k]
    rotation = pose.rotation[foot]
    sin_roll = rotation[2, 1]
    sin_pitch = -rotation[2, 0]
    column = 1 if which == 0 else 0
    omega = 0.0
    for i in range(3):
        omega += rotation[i, column] * pose.omega[foot, i]
    yaw = np.arctan2(rotation[1, 0], rotation[0, 0])
    c = np.cos(yaw)
    n = np.sin(yaw)
    # (W44): the tilt against the felt slope, on which a sole may lie flat.
    x = s.slope[0]
    y = s.slope[1]
    tilt = sin_pitch + x * c + y * n if which == 0 else sin_roll - (y * c - x * n)
    measured = walker.wrench[k, 4] if which == 0 else walker.wrench[k, 3]
    # (W43): the integral makes up for friction. On a tilted foot, which stands on an edge, the moment no longer follows
    # the ankle, and the integral would run away.
    leak = par.ankle_leak_hz
    if abs(sin_roll) + abs(sin_pitch) > par.ankle_tilt:
        rate = -(leak + par.ankle_tilt_leak_hz) * s.integral[k, which]
    else:
        rate = -par.ankle_integral_hz * s.load[k] * (push - measured) - leak * s.integral[k, which]
    bound = par.ankle_integral_max_nm
    s.integral[k, which] = clip(s.integral[k, which] + dt * rate, -bound, bound)
    guard = (
        par.guard_stiffness_nm * tilt
        + par.guard_edge_nm * dead(tilt, par.guard_band[1 - which])
        + par.guard_damping_nms * omega
    )
    return s.load[k] * s.integral[k, which] - guard


@compiled
def swing_torque(walker: Walker, s: State, k: int, q: Array, v: Array, tau: Array) -> None:
    """Add the torques with which swing leg k follows its reference to tau (nu,) [N m], (W45); forget its integrals."""
    par = walker.par
    for j in range(LEG_JOINTS):
        joint = walker.first[k] + j
        tau[joint] += par.leg_stiffness_nm_rad[j] * (s.q_reference[k, j] - q[7 + joint])
        tau[joint] += par.leg_damping_nms_rad[j] * (s.v_reference[k, j] - v[6 + joint])
    s.integral[k, 0] = 0.0
    s.integral[k, 1] = 0.0


@compiled
def posture_torque(walker: Walker, q: Array, v: Array, tau: Array) -> None:
    """Add the torques of the joints above the legs, which follow the walker's posture, to tau (nu,) [N m], (W46)."""
    for j in range(len(walker.posture)):
        joint = walker.upper + j
        tau[joint] += walker.posture_stiffness[j] * (walker.posture[j] - q[7 + joint])
        tau[joint] += walker.posture_damping[j] * (walker.posture_rate[j] - v[6 + joint])
