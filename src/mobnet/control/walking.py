"""One tick of the walking controller: events of the step, plan, balance, references, torques.

Omnidirectional walking by commands (step x, y, turn, duration, foot height), recovered by the ankle, by the foothold
and by the duration of the step. It knows the nominal model and the sensed state only.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.control.balance import adapt_duration, adapt_foothold, ground_force, measure_dcm
from mobnet.control.compiled import compiled
from mobnet.control.footsteps import plan_steps, reference
from mobnet.control.geometry import clip, smoothstep, wrap
from mobnet.control.kinematics import Pose, Tree, empty_pose, tree_of, update
from mobnet.control.leg_ik import LegGeometry
from mobnet.control.parameters import DURATION, State, WalkingParameters
from mobnet.control.swing import swing_foot
from mobnet.control.whole_body import leg_reference, posture_torque, stance_torque, swing_torque
from mobnet.robot.description import SIDES, RobotDescription

Array = NDArray[np.float64]


class Walker(NamedTuple):
    """What the controller knows of the robot.

    Attributes:
        par: numbers of the controller.
        tree: bodies of the nominal model.
        pose: buffers of its kinematics.
        leg: sizes of the left leg.
        feet: bodies of the left, right foot (2,).
        first: first actuator of the left, right leg (2,).
        upper: first actuator above the legs.
        sensor: position of the force sensor in the foot (3,) [m].
        sole: centre of the sole in the foot (3,) [m].
        gravity: [m/s^2].
        wrench: ground's wrenches about the ankles, foot axes (2, 6) [N, N m]; buffer.
        posture: where the joints above the legs should be (nu - upper,) [rad]; whoever moves them writes it.
        posture_rate: their wanted velocity (nu - upper,) [rad/s].
        work: scratch (3,).
    """

    par: WalkingParameters
    tree: Tree
    pose: Pose
    leg: LegGeometry
    feet: NDArray[np.int64]
    first: NDArray[np.int64]
    upper: int
    sensor: Array
    sole: Array
    gravity: float
    wrench: Array
    posture: Array
    posture_rate: Array
    work: Array


def make_walker(robot: RobotDescription, par: WalkingParameters, mass_ratio: float, gravity_m_s2: float) -> Walker:
    """Build the controller's knowledge of a robot whose nominal masses are mass_ratio [-] times the table's."""
    tree = tree_of(robot, mass_ratio)
    index = {body.name: i for i, body in enumerate(robot.bodies)}
    actuator = {name: i for i, name in enumerate(robot.layout.actuated)}
    limbs = [robot.layout.limb(robot.feet[side].limb) for side in SIDES]
    return Walker(
        par=par,
        tree=tree,
        pose=empty_pose(tree),
        leg=LegGeometry(np.array(robot.hip_pos, dtype=float), float(robot.link_length)),
        feet=np.array([index[robot.feet[side].body] for side in SIDES], dtype=np.int64),
        first=np.array([actuator[limb[0]] for limb in limbs], dtype=np.int64),
        upper=sum(map(len, limbs)),
        sensor=np.array(robot.sensor_pos, dtype=float),
        sole=np.array([*robot.sole_centre[:2], robot.sole_height]),
        gravity=float(gravity_m_s2),
        wrench=np.zeros((2, 6)),
        posture=par.posture_rad.copy(),
        posture_rate=np.zeros(len(par.posture_rad)),
        work=np.zeros(3),
    )


@compiled
def walk(walker: Walker, s: State, q: Array, v: Array, wrenches: Array, commands: Array, dt: float, tau: Array) -> None:
    """Advance the controller by dt [s] and write the desired torques tau (nu,) [N m].

    Args:
        walker: knowledge of the robot.
        s: state record, `mobnet.control.parameters.STATE`.
        q: sensed generalized position (nq,).
        v: sensed generalized velocity (nv,).
        wrenches: ground's wrench on the left, right foot about its sensor, foot axes (2, 6) [N, N m].
        commands: one row a step (n, 5); the last row is repeated.
        dt: tick [s].
        tau: result (nu,).
    """
    par, pose = walker.par, walker.pose
    update(walker.tree, q, v, walker.gravity, pose)
    _move_wrenches(walker, wrenches)
    s.t = s.t + dt if s.standing == 0 else 0.0
    _touch_down(walker, s, commands)
    stance = 0 if s.side > 0 else 1
    ankle, other = pose.position[walker.feet[stance]], pose.position[walker.feet[1 - stance]]
    double_support = par.double_support_share * s.commanded
    _feet(walker, s, stance, double_support)
    measure_dcm(par, s, pose, walker.gravity)
    if s.standing == 1:
        _stand_reference(walker, s, ankle, other, stance)
    else:
        plan_steps(par, s, ankle)
        s.zmp_old[0] = s.old_ankle[0] + np.cos(s.old_yaw) * par.zmp_offset_x_m
        s.zmp_old[1] = s.old_ankle[1] + np.sin(s.old_yaw) * par.zmp_offset_x_m
        _lift_off(walker, s, stance, double_support)
        reference(s, double_support)
    _pelvis(par, s, dt)
    ground_force(par, s, pose, ankle, walker.gravity, walker.work)
    if s.swinging:
        adapt_foothold(par, s, ankle, dt, walker.work)
        adapt_duration(par, s, double_support, dt, walker.work)
        _feel_slope(par, s, pose.rotation[walker.feet[stance]], dt)
        rise = s.slope[0] * (s.target[0] - ankle[0]) + s.slope[1] * (s.target[1] - ankle[1])
        swing_foot(par, s, double_support, ankle[2] + rise)
    _share_load(walker, s)
    _torques(walker, s, stance, q, v, dt, tau)


@compiled
def _move_wrenches(walker: Walker, wrenches: Array) -> None:
    """Move the sensed wrenches (2, 6) from the sensor to the ankle."""
    r = walker.sensor
    for k in range(2):
        for i in range(3):
            j, n = (i + 1) % 3, (i + 2) % 3
            walker.wrench[k, i] = wrenches[k, i]
            walker.wrench[k, 3 + i] = wrenches[k, 3 + i] + r[j] * wrenches[k, n] - r[n] * wrenches[k, j]


@compiled
def vertical_force(walker: Walker, k: int) -> float:
    """Return the ground's vertical force on foot k (0 left, 1 right) [N], world axes."""
    up, force = walker.pose.rotation[walker.feet[k], 2], walker.wrench[k]
    return up[0] * force[0] + up[1] * force[1] + up[2] * force[2]


@compiled
def foot_yaw(pose: Pose, foot: int) -> float:
    """Return the yaw of a body [rad]."""
    return np.arctan2(pose.rotation[foot, 1, 0], pose.rotation[foot, 0, 0])


@compiled
def _touch_down(walker: Walker, s: State, commands: Array) -> None:
    """End the step when the swing foot carries load, or is too late: swap feet and take the next command."""
    par = walker.par
    if s.swinging == 0:
        return
    swing = 1 if s.side > 0 else 0
    double_support = par.double_support_share * s.commanded
    due = s.t > double_support + 0.5 * (s.total - double_support)
    landed = due and vertical_force(walker, swing) > par.touch_force_n
    if not landed and s.t <= s.total + par.late_max_s:
        return
    old = walker.feet[1 - swing]
    for i in range(3):
        s.old_ankle[i] = walker.pose.position[old, i]
    s.old_yaw = foot_yaw(walker.pose, old)
    s.side = -s.side
    s.swinging = 0
    s.steps += 1
    s.t = clip(s.t - s.total, -par.early_max_s, 0.0)
    s.yaw_start = s.yaw
    row = min(s.steps, len(commands) - 1)
    sunk = s.height - walker.pose.position[0, 2]
    stumbles = np.hypot(s.error[0], s.error[1]) > par.stumble_m or sunk > par.stumble_sunk_m
    for i in range(5):
        s.command[i] = 0.0 if stumbles and i < DURATION else commands[row, i]
    s.commanded = s.command[DURATION]
    s.total = s.commanded


@compiled
def _feet(walker: Walker, s: State, stance: int, double_support: float) -> None:
    """Fill the shares of load, the stance foot's yaw and the height of the soles [m]."""
    pose = walker.pose
    share = clip(s.t / double_support, 0.0, 1.0)
    if s.standing == 1:
        share = s.load[stance]
    s.load[stance], s.load[1 - stance] = share, 1.0 - share
    s.stance_yaw = foot_yaw(pose, walker.feet[stance])
    s.sole_height = walker.sole[2]
    for k in range(2):
        s.sole_height += s.load[k] * pose.position[walker.feet[k], 2]


@compiled
def _feel_slope(par: WalkingParameters, s: State, foot: Array, dt: float) -> None:
    """Move the ground's slope along world x and y [-] towards that of a foot (3, 3) that carries the robot."""
    for i in range(2):
        slope = s.slope[i] + par.slope_rate_hz * dt * (-foot[i, 2] / foot[2, 2] - s.slope[i])
        s.slope[i] = clip(slope, -par.slope_max, par.slope_max)


@compiled
def _lift_off(walker: Walker, s: State, stance: int, double_support: float) -> None:
    """Start the swing at the end of double support: note where the foot leaves."""
    if s.swinging == 1 or s.t <= double_support:
        return
    foot = walker.feet[1 - stance]
    rotation = walker.pose.rotation[foot]
    s.swinging = 1
    for i in range(3):
        s.lift[i] = walker.pose.position[foot, i]
        s.foot[i] = s.lift[i]
    s.lift_yaw = foot_yaw(walker.pose, foot)
    s.lift_roll = np.arctan2(rotation[2, 1], rotation[2, 2])
    s.lift_pitch = np.arcsin(clip(-rotation[2, 0], -1.0, 1.0))
    for i in range(2):
        s.target[i] = s.next_ankle[i]
        s.target_velocity[i] = 0.0


@compiled
def _share_load(walker: Walker, s: State) -> None:
    """Filter how much less than its share of the vertical force each foot carries while both should, load_error [N]."""
    for k in range(2):
        error = 0.0 if s.swinging == 1 else s.load[k] * s.force[2] - vertical_force(walker, k)
        s.load_error[k] += walker.par.load_filter * (error - s.load_error[k])


@compiled
def _pelvis(par: WalkingParameters, s: State, dt: float) -> None:
    """Move the pelvis' wanted height [m] and yaw [rad]: over the soles, between the feet."""
    error = s.sole_height + par.pelvis_height_m - s.height
    bound = par.pelvis_height_speed_m_s
    s.height_rate = clip(par.pelvis_height_rate_hz * error, -bound, bound)
    s.height += dt * s.height_rate
    if s.standing == 0:
        end = s.stance_yaw + 0.5 * wrap(s.next_yaw - s.stance_yaw)
        s.yaw = s.yaw_start + wrap(end - s.yaw_start) * smoothstep(s.t / s.total)


@compiled
def _stand_reference(walker: Walker, s: State, ankle: Array, other: Array, stance: int) -> None:
    """Fill the reference of standing: the DCM above the middle of the feet, the load by where the ZMP is wanted."""
    par = walker.par
    offset_x, offset_y = np.cos(s.stance_yaw) * par.zmp_offset_x_m, np.sin(s.stance_yaw) * par.zmp_offset_x_m
    s.dcm_reference[0] = 0.5 * (ankle[0] + other[0]) + offset_x
    s.dcm_reference[1] = 0.5 * (ankle[1] + other[1]) + offset_y
    along, span = 0.0, 0.0
    for i in range(2):
        apart = ankle[i] - other[i]
        along += par.dcm_gain * (s.dcm[i] - s.dcm_reference[i]) * apart
        span += apart * apart
    share = clip(0.5 + along / span, par.stand_load_min, 1.0 - par.stand_load_min)
    s.load[stance], s.load[1 - stance] = share, 1.0 - share
    for i in range(2):
        s.zmp_nominal[i] = s.dcm_reference[i] + (share - 0.5) * (ankle[i] - other[i])


@compiled
def _torques(walker: Walker, s: State, stance: int, q: Array, v: Array, dt: float, tau: Array) -> None:
    """Write all desired torques (nu,) [N m]."""
    par, pose = walker.par, walker.pose
    for j in range(len(tau)):
        tau[j] = pose.gravity[j]
    for k in range(2):
        foot, first = walker.feet[k], walker.first[k]
        swings = s.swinging == 1 and k != stance
        leg_reference(par, walker.leg, walker.tree, pose, s, k, first, foot, swings)
        if swings:
            swing_torque(par, s, k, first, q, v, tau)
            continue
        point = walker.work
        for i in range(2):
            point[i] = s.zmp[i]
        if s.swinging == 0:  # each foot pushes at its own nominal point, moved as the common one
            yaw = foot_yaw(pose, foot)
            point[0] += pose.position[foot, 0] + np.cos(yaw) * par.zmp_offset_x_m - s.zmp_nominal[0]
            point[1] += pose.position[foot, 1] + np.sin(yaw) * par.zmp_offset_x_m - s.zmp_nominal[1]
        point[2] = pose.position[foot, 2] + walker.sole[2]
        stance_torque(par, walker.tree, pose, s, k, first, foot, q, v, walker.wrench[k], point, dt, tau)
    posture_torque(par, walker.upper, q, v, walker.posture, walker.posture_rate, tau)
