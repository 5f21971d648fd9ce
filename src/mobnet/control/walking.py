"""One tick of the walking controller: events of the step, plan, balance, references, torques.

Omnidirectional walking by commands (step x, y, turn, duration, foot height), recovered by the ankle, by the foothold
and by the duration of the step. It knows the nominal model and the sensed state only. Its laws are derived in
docs/notes/walking.md.
"""

import numpy as np

from mobnet.control.balance import adapt_duration, adapt_foothold, ground_force, measure_dcm
from mobnet.control.footsteps import plan_steps, reference
from mobnet.control.kinematics import update
from mobnet.control.parameters import State
from mobnet.control.phases import (
    correct_load,
    feel_slope,
    lift_off,
    move_pelvis,
    share_weight,
    stand_reference,
    touch_down,
)
from mobnet.control.swing import swing_foot, turn_back
from mobnet.control.walker import Walker, foot_yaw, move_wrenches
from mobnet.control.whole_body import leg_reference, posture_torque, stance_torque, swing_torque
from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled


@compiled
def walk(walker: Walker, s: State, q: Array, v: Array, wrenches: Array, commands: Array, dt: float, tau: Array) -> None:
    """Advance the controller by dt [s] and write the desired torques tau (nu,) [N m].

    q (nq,) and v (nv,) are the sensed position and velocity, wrenches (2, 6) [N, N m] the measured ones of the ground
    on the left, right foot about its sensor, foot axes; commands (n, 5) hold a row a step, of which the last repeats.
    """
    par = walker.par
    pose = walker.pose
    update(walker.tree, q, v, walker.gravity, pose)
    move_wrenches(walker, wrenches)
    s.t = s.t + dt if s.standing == 0 else 0.0
    touch_down(walker, s, commands)
    stance = 0 if s.side > 0 else 1
    ankle = pose.position[walker.feet[stance]]
    other = pose.position[walker.feet[1 - stance]]
    double_support = par.double_support_share * s.commanded
    share_weight(walker, s, stance, double_support)
    measure_dcm(par, s, pose, walker.gravity)
    if s.standing == 1:
        stand_reference(walker, s, ankle, other, stance)
    else:
        plan_steps(par, s, ankle)
        s.zmp_old[0] = s.old_ankle[0] + np.cos(s.old_yaw) * par.zmp_offset_x_m
        s.zmp_old[1] = s.old_ankle[1] + np.sin(s.old_yaw) * par.zmp_offset_x_m
        lift_off(walker, s, stance, double_support)
        turn_back(par, s, double_support, other)
        reference(s, double_support)
    move_pelvis(walker, s, stance, dt)
    ground_force(par, s, pose, ankle, walker.gravity, walker.work)
    if s.swinging:
        adapt_foothold(par, s, ankle, dt, walker.work)
        adapt_duration(par, s, double_support, dt, walker.work)
        feel_slope(par, s, pose.rotation[walker.feet[stance]], dt)
        # (W30): the ground under the target, on a plane through the stance foot.
        rise = s.slope[0] * (s.target[0] - ankle[0]) + s.slope[1] * (s.target[1] - ankle[1])
        swing_foot(par, s, double_support, ankle[2] + rise)
    correct_load(walker, s)
    _torques(walker, s, stance, q, v, dt, tau)


@compiled
def _torques(walker: Walker, s: State, stance: int, q: Array, v: Array, dt: float, tau: Array) -> None:
    """Write the desired torques tau (nu,) [N m] of legs and upper body; arguments as those of `walk`."""
    par = walker.par
    pose = walker.pose
    for j in range(len(tau)):
        tau[j] = pose.gravity[j]  # (W40)
    for k in range(2):
        foot = walker.feet[k]
        point = walker.work
        swings = s.swinging == 1 and k != stance
        leg_reference(walker, s, k, swings)
        if swings:
            swing_torque(walker, s, k, q, v, tau)
            continue
        for i in range(2):
            point[i] = s.zmp[i]
        # (W22): two feet push at their own nominal points, moved as the common one; their mean is then the wanted ZMP.
        if s.swinging == 0:
            yaw = foot_yaw(pose, foot)
            point[0] += pose.position[foot, 0] + np.cos(yaw) * par.zmp_offset_x_m - s.zmp_nominal[0]
            point[1] += pose.position[foot, 1] + np.sin(yaw) * par.zmp_offset_x_m - s.zmp_nominal[1]
        point[2] = pose.position[foot, 2] + walker.sole[2]
        stance_torque(walker, s, k, q, v, point, dt, tau)
    posture_torque(walker, q, v, tau)
