"""First-order recursions, compiled: that of the low-pass, and that of the bend of friction after a reversal."""

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.machine_code import compiled


@compiled
def decay(x: Array, before: Array, pole: float) -> None:
    """Replace samples in x, one after another, by y_k = pole y_{k-1} + (1 - pole) x_k; `before` (width,) is y_{-1}."""
    width = len(before)
    for i in range(min(width, len(x))):
        x[i] = (1.0 - pole) * x[i] + pole * before[i]
    for start in range(width, len(x), width):
        for i in range(start, start + width):
            x[i] = (1.0 - pole) * x[i] + pole * x[i - width]


@compiled
def follow(bend: Array, velocity: Array, angle: Array, dt: float, out: Array) -> None:
    """Advance bends (n,), from -1 to 1, over samples of velocity (T, n) [rad/s], dt [s] apart; write each, (T, n).

    The joints break away over an angle (n,) [rad].
    """
    for k in range(len(velocity)):
        for j in range(len(bend)):
            # (O19), exact for a velocity that is constant over the sample: stable for any angle and any velocity.
            sign = 1.0 if velocity[k, j] > 0.0 else -1.0
            bend[j] = sign + (bend[j] - sign) * np.exp(-abs(velocity[k, j]) * dt / angle[j])
            out[k, j] = bend[j]
