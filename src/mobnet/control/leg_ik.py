"""Inverse kinematics of a leg in closed form, (W35) to (W38) of docs/notes/walking.md.

It asks for axes of hip yaw, roll and pitch that meet in one point, a knee pitch, axes of ankle pitch and roll that meet
in one point, and a thigh as long as the shank.
"""

from typing import NamedTuple

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled, matrix3, vector3


class LegGeometry(NamedTuple):
    """Sizes of a leg."""

    hip: Array  # position of the left hip in the base (3,) [m]
    length: float  # length of the thigh and of the shank [m]


@compiled
def leg_ik(
    leg: LegGeometry, side: float, r_base: Array, p_base: Array, r_foot: Array, p_ankle: Array, q: Array
) -> None:
    """Write the six joint angles [rad] that put the ankle at a pose into q (6,).

    With R_foot = R_base Rz(q1) Rx(q2) Ry(q3 + q4 + q5) Rx(q6), (W35), and r = (x, y, z) the hip seen from the ankle in
    foot axes: the knee follows from |r|, (W36), ankle roll and pitch from the direction of r, (W37), and the hip from
    the rotation that remains, (W38). A pose out of reach is met with the leg 4 degrees short of straight.

    Poses are orientations (3, 3) and positions (3,) [m] in the world; side is +1 for the left leg, -1 for the right.
    """
    b = leg.length
    hip = vector3()
    for i in range(3):
        hip[i] = (
            p_base[i]
            + r_base[i, 0] * leg.hip[0]
            + r_base[i, 1] * side * leg.hip[1]
            + r_base[i, 2] * leg.hip[2]
            - p_ankle[i]
        )
    x = r_foot[0, 0] * hip[0] + r_foot[1, 0] * hip[1] + r_foot[2, 0] * hip[2]
    y = r_foot[0, 1] * hip[0] + r_foot[1, 1] * hip[1] + r_foot[2, 1] * hip[2]
    z = r_foot[0, 2] * hip[0] + r_foot[1, 2] * hip[1] + r_foot[2, 2] * hip[2]
    cosine = (x * x + y * y + z * z - 2.0 * b * b) / (2.0 * b * b)
    # Short of straight, because the Jacobian of a straight leg is singular.
    knee = np.arccos(min(max(cosine, -0.5), 0.9975))
    ankle_roll = np.arctan2(y, z)
    ankle_pitch = np.arctan2(-b * np.sin(knee), b + b * np.cos(knee)) - np.arctan2(x, np.hypot(y, z))
    q[3] = knee
    q[4] = ankle_pitch
    q[5] = ankle_roll
    _hip_angles(r_base, r_foot, knee + ankle_pitch, ankle_roll, q)


@compiled
def _hip_angles(r_base: Array, r_foot: Array, pitch: float, roll: float, q: Array) -> None:
    """Write hip yaw, roll and pitch [rad] into q[0:3] from C = R_base^T R_foot Rx(-roll) Ry(-pitch), (W38)."""
    cr = np.cos(roll)
    sr = np.sin(roll)
    cp = np.cos(pitch)
    sp = np.sin(pitch)
    c = matrix3()
    for i in range(3):
        a0 = r_base[0, i] * r_foot[0, 0] + r_base[1, i] * r_foot[1, 0] + r_base[2, i] * r_foot[2, 0]
        a1 = r_base[0, i] * r_foot[0, 1] + r_base[1, i] * r_foot[1, 1] + r_base[2, i] * r_foot[2, 1]
        a2 = r_base[0, i] * r_foot[0, 2] + r_base[1, i] * r_foot[1, 2] + r_base[2, i] * r_foot[2, 2]
        b1 = cr * a1 - sr * a2
        b2 = sr * a1 + cr * a2
        c[i, 0] = cp * a0 + sp * b2
        c[i, 1] = b1
        c[i, 2] = -sp * a0 + cp * b2
    q[0] = np.arctan2(-c[0, 1], c[1, 1])
    q[1] = np.arcsin(min(max(c[2, 1], -1.0), 1.0))
    q[2] = np.arctan2(-c[2, 0], c[2, 2])
