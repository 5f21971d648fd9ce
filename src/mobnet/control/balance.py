"""From the error of the DCM to a ground force, a new foothold and a new step duration."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mobnet.control.compiled import compiled
from mobnet.control.footsteps import decay
from mobnet.control.geometry import clip, dead, to_world, to_yaw_frame
from mobnet.control.kinematics import Pose
from mobnet.control.parameters import State, WalkingParameters

Array = NDArray[np.float64]

PEAK_SPEED_RATIO = 1.875  # largest slope of the quintic `rise`


@compiled
def measure_dcm(par: WalkingParameters, s: State, pose: Pose, gravity_m_s2: float) -> None:
    """Fill omega and dcm from the centre of mass and the angular momentum about it."""
    height = max(pose.com[2] - s.sole_height, par.com_height_min_m)
    s.omega = np.sqrt(gravity_m_s2 / height)
    mass = pose.weight[0]
    raw_x = pose.com_velocity[0] + pose.spin[1] / (mass * height)
    raw_y = pose.com_velocity[1] - pose.spin[0] / (mass * height)
    s.velocity[0] += par.velocity_filter * (raw_x - s.velocity[0])
    s.velocity[1] += par.velocity_filter * (raw_y - s.velocity[1])
    for i in range(2):
        s.dcm[i] = pose.com[i] + s.velocity[i] / s.omega


@compiled
def ground_force(par: WalkingParameters, s: State, pose: Pose, ankle: Array, gravity_m_s2: float, work: Array) -> None:
    """Fill error, zmp [m] and force [N]: the ZMP that pulls the DCM back, kept inside the support, and its force."""
    for i in range(2):
        s.error[i] = s.dcm[i] - s.dcm_reference[i]
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
    mass = pose.weight[0]
    for i in range(2):
        s.force[i] = mass * s.omega * s.omega * (pose.com[i] - s.zmp[i])
    s.force[2] = mass * (gravity_m_s2 - par.vertical_damping_hz * (pose.com_velocity[2] - s.height_rate))


@compiled
def adapt_foothold(par: WalkingParameters, s: State, ankle: Array, dt: float, work: Array) -> None:
    """Move the swing foot's target (2,) [m] to where the DCM error will need it, at a limited speed [m/s]."""
    remaining = s.total - s.t
    if 0.0 <= remaining <= par.foothold_freeze_s:
        s.target_velocity[:] = 0.0
        return
    to_yaw_frame(s.error, s.stance_yaw, work)
    growth = 1.0 / decay(s.omega, remaining)
    band, most = par.foothold_band_m, par.foothold_change_max_m
    change_x = clip(dead(work[0], band[0]) * growth, -most[0], most[0])
    change_y = clip(dead(work[1], band[1]) * growth, -most[1], most[1])
    for i in range(2):
        work[i] = s.next_ankle[i] - ankle[i]
    to_yaw_frame(work, s.stance_yaw, work)
    work[0] = clip(work[0] + change_x, -par.foothold_x_max_m, par.foothold_x_max_m)
    outward = clip(-s.side * (work[1] + change_y), par.foothold_y_m[0], par.foothold_y_m[1])
    work[1] = -s.side * outward
    to_world(work, s.stance_yaw, work)
    step = par.foothold_speed_m_s * dt
    for i in range(2):
        move = clip(par.foothold_gain * (ankle[i] + work[i] - s.target[i]), -step, step)
        s.target[i] += move
        s.target_velocity[i] = move / dt


@compiled
def adapt_duration(par: WalkingParameters, s: State, double_support: float, dt: float, work: Array) -> None:
    """Move the step's duration s.total [s] to when the lateral DCM will be where the next foot wants it."""
    if s.total - s.t <= par.timing_freeze_s:
        return
    shortest = max(par.step_min_s, s.commanded - par.step_shorter_max_s)
    longest = s.commanded + par.step_longer_max_s
    wanted = clip(_lateral_duration(par, s, double_support, shortest, longest, work), shortest, longest)
    travel = np.hypot(s.target[0] - s.lift[0], s.target[1] - s.lift[1])
    quickest = double_support + PEAK_SPEED_RATIO * travel / (par.swing_xy_share * par.swing_speed_max_m_s)
    wanted = max(wanted, min(quickest, s.commanded))
    if wanted < s.t + par.timing_soonest_s:
        wanted = min(s.commanded, s.t + par.timing_soonest_s)
    s.total += clip(wanted - s.total, -par.timing_rate * dt, par.timing_rate * dt)


@compiled
def _lateral_duration(
    par: WalkingParameters, s: State, double_support: float, shortest: float, longest: float, work: Array
) -> float:
    """Return the duration [s] at which the lateral DCM meets its planned end, sways within the band left alone."""
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
    ankle = np.sign(error) * min(par.timing_ankle_m, abs(error) - par.timing_band_m)
    if end - ankle > par.timing_dcm_min_m and now - ankle > par.timing_dcm_min_m:
        return s.t - middle + np.log((end - ankle) / (now - ankle)) / s.omega
    if error < 0.0:
        return longest if now > par.timing_dcm_lost_m else shortest
    return s.commanded
