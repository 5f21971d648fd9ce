"""Reference of the joints above the legs: a posture, or a motion given by knots."""

from typing import NamedTuple

from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled


class UpperBody(NamedTuple):
    """Knots of a motion and the time at which they begin."""

    knots: Array  # joint positions at equal steps of time (k, n) [rad]; a single knot is a posture
    rate_hz: float  # knots in a second [1/s]
    start: Array  # time of the motion when the episode's clock is zero, one entry (1,) [s]


@compiled
def follow(upper: UpperBody, clock: float, q: Array, v: Array) -> None:
    """Write the wanted positions q (n,) [rad] and velocities v (n,) [rad/s] at a clock [s], (W47).

    Before the first and after the last knot the joints rest. Between knots runs a cubic whose slopes at the knots are
    the central differences, so that the velocity is continuous.
    """
    last = len(upper.knots) - 1
    at = (clock + upper.start[0]) * upper.rate_hz
    if last < 1 or at <= 0.0 or at >= last:
        row = 0 if last < 1 or at <= 0.0 else last
        for j in range(len(q)):
            q[j] = upper.knots[row, j]
            v[j] = 0.0
        return
    k = int(at)
    x = at - k
    before = max(k - 1, 0)
    after = min(k + 2, last)
    h1 = x * x * (3.0 - 2.0 * x)
    h2 = x * (x - 1.0) * (x - 1.0)
    h3 = x * x * (x - 1.0)
    d1 = 6.0 * x * (1.0 - x)
    d2 = (x - 1.0) * (3.0 * x - 1.0)
    d3 = x * (3.0 * x - 2.0)
    for j in range(len(q)):
        a = upper.knots[k, j]
        b = upper.knots[k + 1, j]
        slope_a = 0.5 * (b - upper.knots[before, j])
        slope_b = 0.5 * (upper.knots[after, j] - a)
        q[j] = a + (b - a) * h1 + slope_a * h2 + slope_b * h3
        v[j] = ((b - a) * d1 + slope_a * d2 + slope_b * d3) * upper.rate_hz
