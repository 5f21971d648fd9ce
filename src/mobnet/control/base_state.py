"""Base position and velocity from proprioception: IMU acceleration corrected by the feet that carry load."""

from mobnet.control.compiled import compiled, vector3
from mobnet.control.geometry import cross, rotate
from mobnet.control.walker import Walker
from mobnet.core.arrays import Array


@compiled
def update_base(walker: Walker, loads: Array, acc_base_in_base: Array, dt: float, q: Array, v: Array) -> None:
    """Advance the complementary filter (W48) by one tick; q[0:3] [m] and v[0:3] [m/s] are its state, in world axes.

    The acceleration is integrated. The sole of a loaded foot does not move, so the velocity that the kinematics give to
    it is the error of the base's velocity, which decays with a time constant. The velocity is taken at the sole's
    centre: at the ankle, a foot that rolls makes the error three times larger.

    The walker's pose is of the sensed state before this tick of dt [s]; `loads` are the vertical forces on the left,
    right foot (2,) [N], `acc_base_in_base` is the IMU's specific force (3,) [m/s^2].
    """
    pose, time_constant_s = walker.pose, walker.par.base_time_constant_s
    acceleration, arm, swept, slip = vector3(), vector3(), vector3(), vector3()
    rotate(pose.rotation[0], acc_base_in_base, acceleration)
    acceleration[2] -= walker.gravity
    slip[0] = slip[1] = slip[2] = 0.0
    weights = 0.0
    for k in range(2):
        load = max(loads[k], 0.0)  # its square is the weight, so that a foot nearly free counts little
        foot = walker.feet[k]
        rotate(pose.rotation[foot], walker.sole, arm)
        cross(pose.omega[foot], arm, swept)
        for i in range(3):
            slip[i] += load * load * (pose.velocity[foot, i] + swept[i])
        weights += load * load
    for i in range(3):
        v[i] += dt * acceleration[i]
        if weights > 1.0:  # [N^2]; a robot in the air has no foot that rests
            v[i] -= dt / time_constant_s * slip[i] / weights
        q[i] += dt * v[i]
