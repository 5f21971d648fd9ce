"""From the error of the DCM to a ground force, a new foothold and a new step duration.

The equations (W2) to (W20) are derived in docs/notes/walking.md. Arguments that recur: `par`, numbers
of the controller; `s`, its state; `pose`, kinematics of the sensed state; `ankle`, the stance ankle (3,) [m]; `dt`, a
tick [s]; `work`, scratch (3,).
"""

import numpy as np

from mobnet.control.footsteps import decay
from mobnet.control.geometry import clip, dead, to_world, to_yaw_frame
from mobnet.control.kinematics import Pose
from mobnet.control.parameters import State, WalkingParameters
from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled

PEAK_SPEED_RATIO = 1.875  # largest slope of the quintic `rise`, (W31)


@compiled
def measure_dcm(par: WalkingParameters, s: State, pose: Pose, gravity_m_s2: float) -> None:
    """Fill omega [1/s] and dcm (2,) [m] from the centre of mass and the angular momentum about it, (W2) to (W4)."""
    height = max(pose.com[2] - s.sole_height, par.com_height_min_m)
    s.omega = np.sqrt(gravity_m_s2 / height)
    mass = pose.weight[0]
    # Angular momentum comes back as linear momentum, so the pendulum's velocity counts it in, (W2).
    raw_x = pose.com_velocity[0] + pose.spin[1] / (mass * height)
    raw_y = pose.com_velocity[1] - pose.spin[0] / (mass * height)
    # Sensed velocities are noisy and the DCM multiplies them by 1 / omega: a first-order low-pass, (W4).
    s.velocity[0] += par.velocity_filter * (raw_x - s.velocity[0])
    s.velocity[1] += par.velocity_filter * (raw_y - s.velocity[1])
    for i in range(2):
        s.dcm[i] = pose.com[i] + s.velocity[i] / s.omega  # (W3)


@compiled
def ground_force(par: WalkingParameters, s: State, pose: Pose, ankle: Array, gravity_m_s2: float, work: Array) -> None:
    """Fill error, zmp (2,) [m], force (3,) [N]: the ZMP that pulls the DCM back, within the support, (W13) to (W15)."""
    for i in range(2):
        s.error[i] = s.dcm[i] - s.dcm_reference[i]
    # The ZMP moves by more than the error (W13); the ground can push only from below a sole, which limits it (W14).
    if s.swinging:
        for i in range(2):
            work[i] = s.zmp_nominal[i] + par.dcm_gain * s.error[i] - ankle[i]
        to_yaw_frame(work, s.stance_yaw, work)
        work[0] = clip(work[0], par.sole_x_m[0], par.sole_x_m[1])
        work[1] = clip(work[1], -par.sole_y_m, par.sole_y_m)
        to_world(work, s.stance_yaw, work)
        for i in range(2):
            s.zmp[i] = ankle[i] + work[i]
    else:
        bound = par.stand_shift_m if s.standing else par.double_support_shift_m
        for i in range(2):
            work[i] = par.dcm_gain * s.error[i]
        to_yaw_frame(work, s.stance_yaw, work)
        for i in range(2):
            work[i] = clip(work[i], -bound[i], bound[i])
        to_world(work, s.stance_yaw, work)
        for i in range(2):
            s.zmp[i] = s.zmp_nominal[i] + work[i]
    # (W15): a force through the centre of mass changes no angular momentum.
    mass = pose.weight[0]
    for i in range(2):
        s.force[i] = mass * s.omega * s.omega * (pose.com[i] - s.zmp[i])
    s.force[2] = mass * (gravity_m_s2 - par.vertical_damping_hz * (pose.com_velocity[2] - s.height_rate))


@compiled
def adapt_foothold(par: WalkingParameters, s: State, ankle: Array, dt: float, work: Array) -> None:
    """Move the swing foot's target (2,) [m] to where the DCM error will need it, at a limited speed, (W16), (W17)."""
    remaining = s.total - s.t
    # The foot may touch the ground already, and a target that moves would drag it; a late foot is free again.
    if 0.0 <= remaining <= par.foothold_freeze_s:
        s.target_velocity[:] = 0.0
        return
    to_yaw_frame(s.error, s.stance_yaw, work)
    growth = 1.0 / decay(s.omega, remaining)  # of the error until the step ends, (W16)
    band = par.foothold_band_m
    most = par.foothold_change_max_m
    change_x = clip(dead(work[0], band[0]) * growth, -most[0], most[0])
    change_y = clip(dead(work[1], band[1]) * growth, -most[1], most[1])
    if s.reacting:
        # The error of a robot that is held back points into what holds it; a foothold follows it the other way only.
        work[0], work[1] = change_x, change_y
        to_world(work, s.stance_yaw, work)
        towards = min(work[0] * s.away[0] + work[1] * s.away[1], 0.0)
        for i in range(2):
            work[i] -= towards * s.away[i]
        to_yaw_frame(work, s.stance_yaw, work)
        change_x, change_y = work[0], work[1]
    for i in range(2):
        work[i] = s.next_ankle[i] - ankle[i]
    to_yaw_frame(work, s.stance_yaw, work)
    # The leg's reach, and feet that must stay apart, (W17).
    work[0] = clip(work[0] + change_x, -par.foothold_x_max_m, par.foothold_x_max_m)
    outward = clip(-s.side * (work[1] + change_y), par.foothold_y_m[0], par.foothold_y_m[1])
    work[1] = -s.side * outward
    to_world(work, s.stance_yaw, work)
    # A swing leg that jumps would disturb the balance that it should restore.
    step = par.foothold_speed_m_s * dt
    for i in range(2):
        move = clip(par.foothold_gain * (ankle[i] + work[i] - s.target[i]), -step, step)
        s.target[i] += move
        s.target_velocity[i] = move / dt


@compiled
def adapt_duration(par: WalkingParameters, s: State, double_support: float, dt: float, work: Array) -> None:
    """Move the step's duration s.total [s] to when the lateral DCM will be where the next foot wants it, (W20)."""
    if s.total - s.t <= par.timing_freeze_s:
        return
    shortest = max(par.step_min_s, s.commanded - par.step_shorter_max_s)
    longest = s.commanded + par.step_longer_max_s
    wanted = clip(_lateral_duration(par, s, double_support, shortest, longest, work), shortest, longest)
    # A step must leave the swing foot time to get to its target, unless it was commanded shorter.
    travel = np.hypot(s.target[0] - s.lift[0], s.target[1] - s.lift[1])
    quickest = double_support + PEAK_SPEED_RATIO * travel / (par.swing_xy_share * par.swing_speed_max_m_s)
    wanted = max(wanted, min(quickest, s.commanded))
    if wanted < s.t + par.timing_soonest_s:
        wanted = min(s.commanded, s.t + par.timing_soonest_s)
    # The swing foot's trajectory depends on s.total: a jump of the duration would be a jump of the foot.
    s.total += clip(wanted - s.total, -par.timing_rate * dt, par.timing_rate * dt)


@compiled
def _lateral_duration(
    par: WalkingParameters, s: State, double_support: float, shortest: float, longest: float, work: Array
) -> float:
    """Return the duration [s] at which the lateral DCM meets its planned end, (W18), or the case of (W19).

    `end` and `now` are the distances [m] of the planned and of the present DCM from the nominal ZMP towards the swing
    foot, `ankle` is the part of the error that a ZMP moved by as much corrects.
    """
    middle = 0.5 * double_support
    for i in range(2):
        work[i] = s.dcm_end[i] - s.plan[0, i]
    to_yaw_frame(work, s.stance_yaw, work)
    end = -s.side * work[1]
    for i in range(2):
        work[i] = s.dcm[i] - s.plan[0, i]
    to_yaw_frame(work, s.stance_yaw, work)
    now = -s.side * work[1]
    error = now - end * decay(s.omega, s.commanded - s.t + middle)
    if end <= par.timing_ankle_m or abs(error) <= par.timing_band_m:
        return s.commanded
    # Ankle and duration share the error: the ankle answers at once, but moves the ZMP by centimetres only.
    ankle = np.sign(error) * min(par.timing_ankle_m, abs(error) - par.timing_band_m)
    if end - ankle > par.timing_dcm_min_m and now - ankle > par.timing_dcm_min_m:
        return s.t - middle + np.log((end - ankle) / (now - ankle)) / s.omega
    # The logarithm of (W18) has no meaning here. Behind its plan, the DCM either still comes over if it is given time,
    # or leaves to the outside of the stance foot, where only the next foot can catch it.
    if error < 0.0:
        return longest if now > par.timing_dcm_lost_m else shortest
    return s.commanded
