"""The low-pass of (11) in discrete time, with the pole of the observer: exact for what is constant over a sample."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import ConfigError


def exact_pole(gain_hz: float, rate_hz: float) -> float:
    """Return gamma = exp(-K_0 T), the sampled pole of (11).

    Raises:
        ConfigError: a gain or a rate is not positive.
    """
    if gain_hz <= 0 or rate_hz <= 0:
        raise ConfigError(f"observer gain {gain_hz} 1/s at {rate_hz} Hz; accepted: numbers above 0")
    # (O3) of docs/notes/observer.md. Euler's pole, 1 - K_0 T, would make r lag behind a truth that is filtered as (11)
    # says.
    return float(np.exp(-gain_hz / rate_hz))


def low_pass(x: NDArray[Any], gain_hz: float, rate_hz: float, before: Array | None = None) -> Array:
    """Return x (T, ...) behind the low-pass of (11), sampled as the observer is: zero at the first sample, same pole.

    The values of x are means over each sample, the gain is K_0 of (7) [1/s]. Where x goes on from another stretch,
    `before` (...) is what was returned last of that.
    """
    filtered = np.array(x, dtype=np.float64, order="C")
    if before is None:
        # (O6): it starts as the residual does, which cannot know what touched the robot before its first sample.
        filtered[:1] = 0.0
    return filter_in_place(filtered, exact_pole(gain_hz, rate_hz), before)


def filter_in_place(x: Array, pole: float, before: Array | None = None) -> Array:
    """Replace x (T, ...), contiguous, by y_k = pole y_{k-1} + (1 - pole) x_k along time, and return it.

    `before` (...) is y_{-1}, zero where it is not given.
    """
    from mobnet.kernel.first_order import decay  # numba: the workflow imports kinds before it starts

    last = np.zeros(max(x[:1].size, 1)) if before is None else np.reshape(before, -1)
    decay(np.reshape(x, -1, copy=False), last, pole)
    return x
