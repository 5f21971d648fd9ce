"""Base position and velocity from proprioception: IMU acceleration corrected by the sole that does not move.

Encoders and IMU are all that is read: no force of the feet and no plan.
"""

from mobnet.control.geometry import cross, rotate
from mobnet.control.walker import Walker
from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled, vector3


@compiled
def update_base(walker: Walker, acc_base_in_base: Array, dt: float, q: Array, v: Array) -> None:
    """Advance the complementary filter (W48) by one tick; q[0:3] [m] and v[0:3] [m/s] are its state, in world axes.

    The acceleration is integrated. A sole on the ground does not move, so the velocity that the kinematics give to it
    is the error of the base's velocity, which decays with a time constant. A sole is the less trusted the faster it
    moves, so that one that swings counts nothing beside one that rests; one of them always rests in a walk. The
    velocity is taken at the sole's centre: at the ankle, a foot that rolls makes the error three times larger.

    The walker's pose is of the sensed state before this tick of dt [s]; `acc_base_in_base` is the IMU's specific force
    (3,) [m/s^2].
    """
    pose = walker.pose
    par = walker.par
    acceleration = vector3()
    velocity = vector3()
    arm = vector3()
    slip = vector3()
    rotate(pose.rotation[0], acc_base_in_base, acceleration)
    acceleration[2] -= walker.gravity
    slip[0] = slip[1] = slip[2] = 0.0
    weights = 0.0
    for k in range(2):
        foot = walker.feet[k]
        speed2 = 0.0
        rotate(pose.rotation[foot], walker.sole, arm)
        cross(pose.omega[foot], arm, velocity)
        for i in range(3):
            velocity[i] += pose.velocity[foot, i]
            speed2 += velocity[i] * velocity[i]
        weight = 1.0 / (1.0 + speed2 / par.base_still_speed_m_s**2) ** 2
        for i in range(3):
            slip[i] += weight * velocity[i]
        weights += weight
    for i in range(3):
        v[i] += dt * (acceleration[i] - slip[i] / weights / par.base_time_constant_s)
        q[i] += dt * v[i]
