"""A sample of the observer in one compiled call, for models of hinges whose drives have no friction.

The numbers are those of `Recursion.step`, to the bit. There, of seven joints, each call of NumPy works on less than it
costs to make, and all of them together take ten times as long.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mobnet.core.arrays import Array
from mobnet.core.machine_code import compiled, hold
from mobnet.kernel.linkage import Linkage
from mobnet.kernel.momentum import sweep


class StepNumbers(NamedTuple):
    """What does not change from sample to sample.

    Attributes:
        linkage: links and gravity, on a fixed base.
        motors: columns of the velocities that have a motor (nu,).
        pole: gamma = exp(-K_0 T) [-].
        rate_hz: samples per second [Hz].
        is_mean: whether torques are means over the interval that ends at the tick.
    """

    linkage: Linkage
    motors: NDArray[np.intp]
    pole: float
    rate_hz: float
    is_mean: bool


class CompiledStep:
    """Steps through samples; its state is p, beta and r, then the motors' torque, (3 nv + nu,), or empty at first."""

    def __init__(self, numbers: StepNumbers) -> None:
        """Take the numbers."""
        self._held = hold(numbers)
        nv = len(numbers.linkage.links) - 1
        nu = len(numbers.motors)
        self._shapes = ((nv,), (nv,), (nu,))
        self._size = 3 * nv + nu
        self._residual = slice(2 * nv, 3 * nv)

    def init(self) -> Array:
        """Return the state before the first sample."""
        return np.empty(0)

    def step(self, state: Array, q: ArrayLike, v: ArrayLike, tau: ArrayLike) -> tuple[Array, Array] | None:
        """Return the state after a sample and the residual (nv,) [N m]; None where shapes or numbers are wrong."""
        position = np.asarray(q, dtype=np.float64)
        velocity = np.asarray(v, dtype=np.float64)
        torque = np.asarray(tau, dtype=np.float64)
        if (position.shape, velocity.shape, torque.shape) != self._shapes:
            return None
        if not (position.flags.carray and velocity.flags.carray and torque.flags.carray):
            # Columns of a table or arrays that are locked would have the function compiled once more, for seconds.
            position, velocity, torque = position.copy(), velocity.copy(), torque.copy()
        after = np.empty(self._size)
        if not advance(self._held, position, velocity, torque, state, after):
            return None
        return after, after[self._residual]


@compiled(allocating=True)
def advance(holder: Any, q: Array, v: Array, tau: Array, before: Array, after: Array) -> bool:
    """Write the state after a sample; return whether the numbers of the sample are finite."""
    numbers = holder.value
    nv = len(v)
    for sample in (q, v, tau):
        for number in sample:
            if not np.isfinite(number):
                return False
    p, beta, residual, torque = after[:nv], after[nv : 2 * nv], after[2 * nv : 3 * nv], after[3 * nv :]
    sweep(numbers.linkage, q.reshape(1, nv), v.reshape(1, nv), p.reshape(1, nv), beta.reshape(1, nv))
    torque[:] = tau
    residual[:] = 0.0
    if len(before) == 0:  # (O5): before the first sample there is no momentum to take a difference from
        return True
    for k, column in enumerate(numbers.motors):
        # (O2): a value at the tick taken for the mean would be half a sample late.
        residual[column] = torque[k] if numbers.is_mean else (torque[k] + before[3 * nv + k]) / 2
    for i in range(nv):
        # (O1): beta is known at both ends of the sample; (O4): r has the low-pass of the truth.
        raw = (p[i] - before[i]) * numbers.rate_hz - residual[i] - (beta[i] + before[nv + i]) / 2
        residual[i] = numbers.pole * before[2 * nv + i] + (1 - numbers.pole) * raw
    return True
