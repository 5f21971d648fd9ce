"""Small compiled functions of the controller: limits, smooth rises, vectors, rotations, linear equations."""

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled


@compiled
def clip(x: float, low: float, high: float) -> float:
    """Return x limited to [low, high]."""
    return min(max(x, low), high)


@compiled
def dead(x: float, band: float) -> float:
    """Return x moved towards zero by `band`, and zero within +-band."""
    if x > band:
        return x - band
    if x < -band:
        return x + band
    return 0.0


@compiled
def rise(x: float) -> float:
    """Return the quintic from 0 to 1 on [0, 1] with zero slope and curvature at both ends, (W31)."""
    x = min(max(x, 0.0), 1.0)
    return x * x * x * (10.0 + x * (6.0 * x - 15.0))


@compiled
def rise_slope(x: float) -> float:
    """Return the slope of `rise`, which is zero outside [0, 1], (W31)."""
    if x <= 0.0 or x >= 1.0:
        return 0.0
    return 30.0 * x * x * (1.0 - x) * (1.0 - x)


@compiled
def smoothstep(x: float) -> float:
    """Return the cubic from 0 to 1 on [0, 1] with zero slope at both ends."""
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


@compiled
def wrap(angle: float) -> float:
    """Return the angle [rad] in [-pi, pi) that differs from `angle` by full turns."""
    return angle - 2.0 * np.pi * np.floor((angle + np.pi) / (2.0 * np.pi))


@compiled
def to_yaw_frame(vector: Array, yaw: float, out: Array) -> None:
    """Turn the xy part of a world vector (2+,) into the frame turned by yaw [rad]; out (2,)."""
    c = np.cos(yaw)
    s = np.sin(yaw)
    x = vector[0]
    y = vector[1]
    out[0] = c * x + s * y
    out[1] = -s * x + c * y


@compiled
def to_world(vector: Array, yaw: float, out: Array) -> None:
    """Turn an xy vector (2,) of the frame turned by yaw [rad] into the world; out (2,)."""
    c = np.cos(yaw)
    s = np.sin(yaw)
    x = vector[0]
    y = vector[1]
    out[0] = c * x - s * y
    out[1] = s * x + c * y


@compiled
def cross(a: Array, b: Array, out: Array) -> None:
    """Write a x b (3,) into out, which must be neither of the two."""
    out[0] = a[1] * b[2] - a[2] * b[1]
    out[1] = a[2] * b[0] - a[0] * b[2]
    out[2] = a[0] * b[1] - a[1] * b[0]


@compiled
def triple(axis: Array, arm: Array, force: Array) -> float:
    """Return axis . (arm x force), the moment of a force about an axis through the arm's start [N m]."""
    return (
        axis[0] * (arm[1] * force[2] - arm[2] * force[1])
        + axis[1] * (arm[2] * force[0] - arm[0] * force[2])
        + axis[2] * (arm[0] * force[1] - arm[1] * force[0])
    )


@compiled
def rotate(rotation: Array, vector: Array, out: Array) -> None:
    """Write the product of a rotation matrix (3, 3) and a vector (3,) into out (3,), which must not be the vector."""
    for i in range(3):
        out[i] = rotation[i, 0] * vector[0] + rotation[i, 1] * vector[1] + rotation[i, 2] * vector[2]


@compiled
def multiply(a: Array, b: Array, out: Array) -> None:
    """Write the product of two (3, 3) matrices into out, which must be neither of the two."""
    for i in range(3):
        for j in range(3):
            out[i, j] = a[i, 0] * b[0, j] + a[i, 1] * b[1, j] + a[i, 2] * b[2, j]


@compiled
def quaternion_to_matrix(quaternion: Array, out: Array) -> None:
    """Write the rotation matrix (3, 3) of a unit quaternion w x y z into out."""
    w = quaternion[0]
    x = quaternion[1]
    y = quaternion[2]
    z = quaternion[3]
    out[0, 0] = 1 - 2 * (y * y + z * z)
    out[0, 1] = 2 * (x * y - w * z)
    out[0, 2] = 2 * (x * z + w * y)
    out[1, 0] = 2 * (x * y + w * z)
    out[1, 1] = 1 - 2 * (x * x + z * z)
    out[1, 2] = 2 * (y * z - w * x)
    out[2, 0] = 2 * (x * z - w * y)
    out[2, 1] = 2 * (y * z + w * x)
    out[2, 2] = 1 - 2 * (x * x + y * y)


@compiled
def axis_angle_to_matrix(axis: Array, angle: float, out: Array) -> None:
    """Write the rotation matrix (3, 3) about a unit axis (3,) by an angle [rad] into out (Rodrigues)."""
    c = np.cos(angle)
    s = np.sin(angle)
    x = axis[0]
    y = axis[1]
    z = axis[2]
    k = 1.0 - c
    out[0, 0] = c + x * x * k
    out[0, 1] = x * y * k - z * s
    out[0, 2] = x * z * k + y * s
    out[1, 0] = y * x * k + z * s
    out[1, 1] = c + y * y * k
    out[1, 2] = y * z * k - x * s
    out[2, 0] = z * x * k - y * s
    out[2, 1] = z * y * k + x * s
    out[2, 2] = c + z * z * k


@compiled
def yaw_roll_pitch_matrix(yaw: float, roll: float, pitch: float, out: Array) -> None:
    """Write Rz(yaw) Ry(pitch) Rx(roll) (3, 3), angles [rad], into out."""
    cy = np.cos(yaw)
    sy = np.sin(yaw)
    cr = np.cos(roll)
    sr = np.sin(roll)
    cp = np.cos(pitch)
    sp = np.sin(pitch)
    out[0, 0] = cy * cp
    out[0, 1] = cy * sp * sr - sy * cr
    out[0, 2] = cy * sp * cr + sy * sr
    out[1, 0] = sy * cp
    out[1, 1] = sy * sp * sr + cy * cr
    out[1, 2] = sy * sp * cr - cy * sr
    out[2, 0] = -sp
    out[2, 1] = cp * sr
    out[2, 2] = cp * cr


@compiled
def solve(matrix: Array, right: Array) -> bool:
    """Solve matrix (n, n) x = right (n,) by elimination with pivoting; matrix is overwritten and right becomes x.

    Return False if a pivot vanishes; right then has no meaning.
    """
    n = len(right)
    for i in range(n):
        pivot = i
        for j in range(i + 1, n):
            if abs(matrix[j, i]) > abs(matrix[pivot, i]):
                pivot = j
        if abs(matrix[pivot, i]) < 1e-9:
            return False
        if pivot != i:
            for k in range(i, n):
                matrix[i, k], matrix[pivot, k] = matrix[pivot, k], matrix[i, k]
            right[i], right[pivot] = right[pivot], right[i]
        for j in range(i + 1, n):
            factor = matrix[j, i] / matrix[i, i]
            for k in range(i + 1, n):
                matrix[j, k] -= factor * matrix[i, k]
            right[j] -= factor * right[i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            right[i] -= matrix[i, k] * right[k]
        right[i] /= matrix[i, i]
    return True
