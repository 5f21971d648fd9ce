"""Footsteps ahead and the divergent component of motion (DCM) that goes with them.

The DCM xi = c + cdot / w obeys xidot = w (xi - z), with z the zero moment point (ZMP). Errors of xi grow forwards in
time and decay backwards, so the DCM at the end of a step follows from the coming footholds, step by step backwards.
World axes, metres. The equations (W5) to (W12) are derived in docs/notes/walking.md.
"""

import numpy as np

from mobnet.control.geometry import clip
from mobnet.control.parameters import State, WalkingParameters
from mobnet.control.steps import STEP_X, STEP_Y, TURN
from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled


@compiled
def decay(omega: float, time: float) -> float:
    """Return E(time) = exp(-omega max(time, 0)) of (W7), with omega [1/s] and time [s]."""
    return np.exp(-omega * max(time, 0.0))


@compiled
def plan_steps(par: WalkingParameters, s: State, ankle: Array) -> None:
    """Fill next_ankle, next_yaw, plan and dcm_end for the footholds after the stance ankle (3,) [m], (W5) to (W8)."""
    x = ankle[0]
    y = ankle[1]
    yaw = s.stance_yaw
    side = s.side
    for k in range(5):
        c = np.cos(yaw)
        n = np.sin(yaw)
        # (W6): the middle of the sole lies before the ankle.
        s.plan[k, 0] = x + c * par.zmp_offset_x_m
        s.plan[k, 1] = y + n * par.zmp_offset_x_m
        # (W5): only the outer foot steps sideways, so that the feet never cross.
        sideways = s.command[STEP_Y] if s.command[STEP_Y] * side < 0.0 else 0.0
        forward, left = s.command[STEP_X], -side * par.foot_spacing_m + sideways
        turn = s.command[TURN]
        if turn * side > 0.0:  # the swing foot turns inwards
            turn = clip(turn, -par.toe_in_max_rad, par.toe_in_max_rad)
        x = x + c * forward - n * left
        y = y + n * forward + c * left
        yaw += turn
        side = -side
        if k == 0:
            s.next_ankle[0] = x
            s.next_ankle[1] = y
            s.next_yaw = yaw
    # (W8): the guess that ends the plan is forgotten within three steps.
    factor = decay(s.omega, s.commanded)
    for i in range(2):
        dcm = 0.5 * (s.plan[4, i] + s.plan[3, i])
        for k in range(3, 0, -1):
            dcm = s.plan[k, i] + (dcm - s.plan[k, i]) * factor
        s.dcm_end[i] = dcm


@compiled
def reference(s: State, double_support: float) -> None:
    """Fill zmp_nominal and dcm_reference (2,) [m] at time s.t, (W9) to (W12).

    In double support, which lasts double_support [s], the ZMP goes from the old to the new foot on a straight line. The
    DCM reaches dcm_end in the middle of the next double support, at total + double_support / 2.
    """
    middle = 0.5 * double_support
    share = clip(s.t / double_support, 0.0, 1.0)
    after = decay(s.omega, s.total - max(s.t, double_support) + middle)
    waited = decay(s.omega, -s.t)
    remaining = decay(s.omega, double_support - max(s.t, 0.0))
    for i in range(2):
        first = s.plan[0, i]
        old = s.zmp_old[i]
        s.zmp_nominal[i] = old + share * (first - old)  # (W9)
        offset = (s.dcm_end[i] - first) * after
        if s.t >= double_support:
            s.dcm_reference[i] = first + offset  # (W10)
            continue
        # (W11): over a ZMP on a ramp the DCM runs ahead of it by a constant, to which the growing part is added. Before
        # t = 0, after an early touch-down, the ZMP still rests under the old foot, (W12).
        ramp = (first - old) / (s.omega * double_support)
        dcm = s.zmp_nominal[i] + ramp + (offset - ramp) * remaining
        s.dcm_reference[i] = dcm if s.t >= 0.0 else old + (dcm - old) * waited
