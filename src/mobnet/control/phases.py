"""Phases of a step: lift-off, touch-down and what changes with them.

Load of the feet, height and yaw of the pelvis, the ground's slope, and the reference of a robot that stands. The
equations (W21) to (W29) are derived in docs/notes/walking.md.
"""

import numpy as np

from mobnet.control.footsteps import decay
from mobnet.control.geometry import clip, smoothstep, wrap
from mobnet.control.parameters import State, WalkingParameters
from mobnet.control.steps import DURATION
from mobnet.control.walker import Walker, foot_yaw, is_ground, vertical_force
from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled


@compiled
def touch_down(walker: Walker, s: State, commands: Array) -> None:
    """End the step when the swing foot carries load or is too late: swap feet and take the next command (5,)."""
    par = walker.par
    if s.swinging == 0:
        return
    swing = 1 if s.side > 0 else 0
    double_support = par.double_support_share * s.commanded
    # Contact in the first half of a swing is a foot that drags; a foot that finds no ground would tip the robot.
    due = s.t > double_support + 0.5 * (s.total - double_support)
    landed = due and is_ground(walker, swing)
    if not landed and s.t <= s.total + par.late_max_s:
        return
    old = walker.feet[1 - swing]
    for i in range(3):
        s.old_ankle[i] = walker.pose.position[old, i]
    s.old_yaw = foot_yaw(walker.pose, old)
    s.side = -s.side
    s.swinging = 0
    s.steps += 1
    # (W25): an early foot waits without load for the time of the plan; a late one has nothing to wait for.
    s.t = clip(s.t - s.total, -par.early_max_s, 0.0)
    s.yaw_start = s.yaw
    row = min(s.steps, len(commands) - 1)
    # (W26): after a large error a commanded step would leave no reach to correct with, and knees at their torque limits
    # lift a sunk pelvis only in place.
    sunk = s.height - walker.pose.position[0, 2]
    stumbles = np.hypot(s.error[0], s.error[1]) > par.stumble_m or sunk > par.stumble_sunk_m
    for i in range(5):
        s.command[i] = 0.0 if stumbles and i < DURATION else commands[row, i]
    s.commanded = s.command[DURATION]
    s.total = s.commanded


@compiled
def lift_off(walker: Walker, s: State, stance: int, double_support: float) -> None:
    """Start the swing at the end of double support [s]; keep the pose of the foot that leaves, for (W32) to (W34)."""
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
def share_weight(walker: Walker, s: State, stance: int, double_support: float) -> None:
    """Fill the shares of the load, (W21), the stance foot's yaw [rad] and the height of the soles [m]."""
    pose = walker.pose
    share = clip(s.t / double_support, 0.0, 1.0)
    if s.standing == 1:
        share = s.load[stance]
    s.load[stance] = share
    s.load[1 - stance] = 1.0 - share
    s.stance_yaw = foot_yaw(pose, walker.feet[stance])
    s.sole_height = walker.sole[2]
    for k in range(2):
        s.sole_height += s.load[k] * pose.position[walker.feet[k], 2]


@compiled
def correct_load(walker: Walker, s: State) -> None:
    """Fill load_error (2,) [N]: what each foot lacks of its share of the vertical force while both carry, (W23)."""
    for k in range(2):
        error = 0.0 if s.swinging == 1 else s.load[k] * s.force[2] - vertical_force(walker, k)
        s.load_error[k] += walker.par.load_filter * (error - s.load_error[k])


@compiled
def reached_height(walker: Walker, s: State, stance: int) -> float:
    """Return the greatest height of the pelvis [m] at which legs on the ground and the landing one still bend, (W51).

    A leg reaches `leg_reach_m` from hip to ankle. That of the swing foot must do so when the step ends; the hip is then
    where the pendulum (W2) over the nominal ZMP brings it.
    """
    pose = walker.pose
    par = walker.par
    most = par.pelvis_height_m + s.sole_height
    least = most - par.pelvis_sink_max_m
    left = max(s.total - s.t, 0.0)
    grown = 1.0 / decay(s.omega, left)
    for k in range(2):
        hip = pose.position[walker.tree.body_of_joint[walker.first[k]]]
        ankle = pose.position[walker.feet[k]]
        away2 = 0.0
        height = ankle[2]
        if s.swinging == 1 and k != stance:
            height = pose.position[walker.feet[stance], 2]
            for i in range(2):
                height += s.slope[i] * (s.target[i] - pose.position[walker.feet[stance], i])  # (W30)
                start = pose.com[i] - s.zmp_nominal[i]
                speed = s.velocity[i] / s.omega
                moved = 0.5 * ((start + speed) * grown + (start - speed) / grown) - start
                away2 += (hip[i] + moved - s.target[i]) ** 2
        else:
            away2 = (hip[0] - ankle[0]) ** 2 + (hip[1] - ankle[1]) ** 2
        most = min(most, height - walker.leg.hip[2] + np.sqrt(max(par.leg_reach_m**2 - away2, 0.0)))
    return max(most, least)


@compiled
def move_pelvis(walker: Walker, s: State, stance: int, dt: float) -> None:
    """Move the wanted height [m], (W27), and yaw [rad], (W28), of the pelvis over the soles and between the feet."""
    par = walker.par
    error = reached_height(walker, s, stance) - s.height
    bound = par.pelvis_height_speed_m_s
    s.height_rate = clip(par.pelvis_height_rate_hz * error, -bound, bound)
    s.height += dt * s.height_rate
    if s.standing == 0:
        end = s.stance_yaw + 0.5 * wrap(s.next_yaw - s.stance_yaw)
        s.yaw = s.yaw_start + wrap(end - s.yaw_start) * smoothstep(s.t / s.total)


@compiled
def feel_slope(par: WalkingParameters, s: State, foot: Array, dt: float) -> None:
    """Move the ground's slope along world x and y towards that of a foot (3, 3) that carries the robot, (W29)."""
    for i in range(2):
        slope = s.slope[i] + par.slope_rate_hz * dt * (-foot[i, 2] / foot[2, 2] - s.slope[i])
        s.slope[i] = clip(slope, -par.slope_max, par.slope_max)


@compiled
def stand_reference(walker: Walker, s: State, ankle: Array, other: Array, stance: int) -> None:
    """Fill the reference of a robot that stands on its ankles (3,) [m]: DCM over the middle of the feet, (W24)."""
    par = walker.par
    offset_x = np.cos(s.stance_yaw) * par.zmp_offset_x_m
    offset_y = np.sin(s.stance_yaw) * par.zmp_offset_x_m
    s.dcm_reference[0] = 0.5 * (ankle[0] + other[0]) + offset_x
    s.dcm_reference[1] = 0.5 * (ankle[1] + other[1]) + offset_y
    along = 0.0
    span = 0.0
    for i in range(2):
        apart = ankle[i] - other[i]
        along += par.dcm_gain * (s.dcm[i] - s.dcm_reference[i]) * apart
        span += apart * apart
    share = clip(0.5 + along / span, par.stand_load_min, 1.0 - par.stand_load_min)
    s.load[stance] = share
    s.load[1 - stance] = 1.0 - share
    for i in range(2):
        s.zmp_nominal[i] = s.dcm_reference[i] + (share - 0.5) * (ankle[i] - other[i])
