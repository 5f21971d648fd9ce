"""Base position and velocity from proprioception: IMU acceleration corrected by the feet that carry load."""

import numpy as np
from numpy.typing import NDArray

from mobnet.control.compiled import compiled
from mobnet.control.geometry import cross, rotate
from mobnet.control.kinematics import Pose
from mobnet.control.stack import vector3

Array = NDArray[np.float64]


@compiled
def update_base(
    pose: Pose,
    feet: NDArray[np.int64],
    sole: Array,
    loads: Array,
    acc_base_in_base: Array,
    gravity_m_s2: float,
    time_constant_s: float,
    dt: float,
    q: Array,
    v: Array,
) -> None:
    """Advance the complementary filter (W48) by one tick; q[0:3] [m] and v[0:3] [m/s] are its state, in world axes.

    The acceleration is integrated. The sole of a loaded foot does not move, so the velocity that the kinematics give to
    it is the error of the base's velocity, which decays with `time_constant_s`. The velocity is taken at the sole's
    centre: at the ankle, a foot that rolls makes the error three times larger.

    Args:
        pose: kinematics of the sensed state before this tick.
        feet: bodies of the left, right foot (2,).
        sole: sole centre in the foot (3,) [m].
        loads: vertical force on the left, right foot (2,) [N].
        acc_base_in_base: specific force of the IMU (3,) [m/s^2].
        gravity_m_s2: gravity [m/s^2].
        time_constant_s: of the correction [s].
        dt: tick [s].
        q: generalized position, updated in place (nq,).
        v: generalized velocity, updated in place (nv,).
    """
    acceleration, arm, swept, slip = vector3(), vector3(), vector3(), vector3()
    rotate(pose.rotation[0], acc_base_in_base, acceleration)
    acceleration[2] -= gravity_m_s2
    slip[0] = slip[1] = slip[2] = 0.0
    weights = 0.0
    for k in range(2):
        load = max(loads[k], 0.0)  # its square is the weight, so that a foot nearly free counts little
        foot = feet[k]
        rotate(pose.rotation[foot], sole, arm)
        cross(pose.omega[foot], arm, swept)
        for i in range(3):
            slip[i] += load * load * (pose.velocity[foot, i] + swept[i])
        weights += load * load
    for i in range(3):
        v[i] += dt * acceleration[i]
        if weights > 1.0:  # [N^2]; a robot in the air has no foot that rests
            v[i] -= dt / time_constant_s * slip[i] / weights
        q[i] += dt * v[i]
