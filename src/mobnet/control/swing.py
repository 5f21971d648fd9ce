"""Where the swing foot should be: to its target on a quintic, up and down again, and further down when it is late.

The equations (W31) to (W34) are derived in docs/notes/walking.md.
"""

import numpy as np

from mobnet.control.geometry import rise, rise_slope, wrap, yaw_roll_pitch_matrix
from mobnet.control.parameters import State, WalkingParameters
from mobnet.control.steps import FOOT_HEIGHT
from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled


@compiled
def swing_height(par: WalkingParameters, s: State, ground: float, span: float, u: float) -> tuple[float, float]:
    """Return the ankle's height [m] and rate [m/s] at phase u of a swing of span [s] to height ground [m], (W33)."""
    top = max(s.lift[2], ground) + s.command[FOOT_HEIGHT]
    if u < par.swing_apex:
        x = u / par.swing_apex
        return s.lift[2] + (top - s.lift[2]) * rise(x), (top - s.lift[2]) * rise_slope(x) / (par.swing_apex * span)
    # A cubic that ends with the speed of descent: the foot must meet ground that is a little higher or lower.
    if u < 1.0:
        down = (1.0 - par.swing_apex) * span
        x = (u - par.swing_apex) / (1.0 - par.swing_apex)
        slope = -par.descent_speed_m_s * down
        drop = top - ground
        height = ground + drop * (1.0 + x * x * (2.0 * x - 3.0)) + slope * x * x * (x - 1.0)
        rate = (drop * 6.0 * x * (x - 1.0) + slope * x * (3.0 * x - 2.0)) / down
        return height, rate
    # Ground that is lower than expected is met sooner by an accelerating foot than at the speed of descent.
    late = (u - 1.0) * span
    fall = par.descent_speed_m_s * late + 0.5 * par.descent_acceleration_m_s2 * late * late
    if fall >= par.descent_depth_m:
        return ground - par.descent_depth_m, 0.0
    return ground - fall, -par.descent_speed_m_s - par.descent_acceleration_m_s2 * late


@compiled
def turn_back(par: WalkingParameters, s: State, double_support: float, foot: Array) -> None:
    """Lead the swing foot from its place (3,) [m] straight to the foothold of a reaction, by (W32).

    The start of its way is moved so that the rest of the way begins where the foot is; the way from lift-off would pull
    it on. A foot that is almost at the end of its way is left alone.
    """
    if s.turns_back == 0:
        return
    s.turns_back = 0
    share = rise((s.t - double_support) / (s.total - double_support) / par.swing_xy_share)
    if s.swinging == 0 or share > par.swing_turn_share:
        return
    for i in range(2):
        s.lift[i] = (foot[i] - share * s.next_ankle[i]) / (1.0 - share)
        s.target[i] = s.next_ankle[i]
        s.target_velocity[i] = 0.0


@compiled
def swing_foot(par: WalkingParameters, s: State, double_support: float, ground: float) -> None:
    """Fill foot (3,) [m], foot_velocity (3,) [m/s], foot_rotation (3, 3), foot_yaw_rate [rad/s], (W32) to (W34).

    Double support lasts double_support [s]; the ankle is at height ground [m] when the sole stands under the target.
    """
    span = s.total - double_support
    u = (s.t - double_support) / span
    x = u / par.swing_xy_share  # reaches 1 before the swing ends: ground that is met early is met from above
    share = rise(x)
    slope = rise_slope(x) / (par.swing_xy_share * span)
    for i in range(2):
        s.foot[i] = s.lift[i] + (s.target[i] - s.lift[i]) * share
        s.foot_velocity[i] = (s.target[i] - s.lift[i]) * slope + share * s.target_velocity[i]
    s.foot[2], s.foot_velocity[2] = swing_height(par, s, ground, span, u)
    # (W34): the sole leaves as it stood and lands along the slope.
    x = u / par.swing_level_share
    turn = wrap(s.next_yaw - s.lift_yaw)
    level = 1.0 - rise(x)
    yaw = s.lift_yaw + turn * rise(x)
    c = np.cos(yaw)
    n = np.sin(yaw)
    roll = (s.slope[1] * c - s.slope[0] * n) * rise(x) + s.lift_roll * level
    pitch = -(s.slope[0] * c + s.slope[1] * n) * rise(x) + s.lift_pitch * level
    yaw_roll_pitch_matrix(yaw, roll, pitch, s.foot_rotation)
    s.foot_yaw_rate = turn * rise_slope(x) / (par.swing_level_share * span)
