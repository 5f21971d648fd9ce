"""Friction of a robot's drives, and errors of what its motors report, as its table has them: what the observer knows.

The law of a joint, of its velocity v and its motor's reported torque tau, is

    tau_f = (coulomb + load abs(tau)) s + viscous v + offset,        and the joint gets        scale tau - tau_f.

Coulomb and viscous friction and an offset are the model that is identified of robots since Swevers et al., "Dynamic
model identification for industrial robots", IEEE Control Systems 27(5), 2007; a load term is that of harmonic drives.
s is a smooth sign of the velocity, tanh(v / width): a sign would switch with the noise of a joint at rest, where
friction takes any value. Where the table has an angle of breakaway, s is the bend of Dahl's law, (O19) of
docs/notes/observer.md, which does not switch with noise either, because it follows the angle.
"""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import ConfigError, not_accepted

TorqueKind = Literal["mean", "sample"]  # of a motor: over the interval that ends at the tick, or at the tick
SMOOTHING_RAD_S = 0.01  # width of the smooth sign where none is given
NUMBERS = ("coulomb", "viscous", "load", "offset", "scale", "smoothing", "breakaway")  # in the order of the C library


@dataclass(frozen=True)
class DriveParameters:
    """Numbers of all actuated joints, (nu,) each; joints without a row have no friction.

    Attributes:
        coulomb: dry friction [N m].
        viscous: [N m s/rad].
        load: dry friction for each torque of the motor [-].
        offset: by how much a motor reports too much [N m].
        scale: true torque over the reported one [-].
        smoothing: width of the smooth sign [rad/s].
        breakaway: angle of Dahl's law [rad]; zero for a joint with the smooth sign.
    """

    coulomb: Array
    viscous: Array
    load: Array
    offset: Array
    scale: Array
    smoothing: Array
    breakaway: Array

    @classmethod
    def of(cls, count: int, **numbers: ArrayLike) -> "DriveParameters":
        """Return the drives of so many joints by numbers of some names, one for all joints or one for each.

        What is not given is 0, but for the scale, which is 1, and the width of the smooth sign, 0.01 rad/s.

        Raises:
            ConfigError: a name is not known, or numbers are not as many as there are joints.
        """
        given = {"scale": 1.0, "smoothing": SMOOTHING_RAD_S, **numbers}
        if unknown := [name for name in given if name not in NUMBERS]:
            raise ConfigError(not_accepted("number of a drive", unknown[0], NUMBERS))
        arrays = {name: np.asarray(given.get(name, 0.0), dtype=np.float64) for name in NUMBERS}
        for name, array in arrays.items():
            if array.shape not in ((), (count,)):
                raise ConfigError(not_accepted(f"{name}: shape", array.shape, [(count,)]))
        return cls(**{name: np.array(np.broadcast_to(array, count)) for name, array in arrays.items()})

    def init(self) -> Array:
        """Return the bends before the first sample, (nu,): none."""
        return np.zeros(len(self.breakaway))

    def run(self, bend: Array, velocity: NDArray[Any], torque: NDArray[Any], rate_hz: float) -> tuple[Array, Array]:
        """Return the bends after samples of joint velocity [rad/s] and motor torque [N m], and tau_f [N m], (T, nu)."""
        bend = bend.copy()
        sign = np.tanh(velocity / self.smoothing)
        if (dahl := np.flatnonzero(self.breakaway)).size:
            dahl_bend = bend[dahl]
            sign[:, dahl] = bent(dahl_bend, velocity[:, dahl], self.breakaway[dahl], rate_hz)
            bend[dahl] = dahl_bend
        dry = self.coulomb + self.load * np.abs(torque)
        return bend, dry * sign + self.viscous * velocity + self.offset


def bent(bend: Array, velocity: NDArray[Any], breakaway: Array, rate_hz: float) -> Array:
    """Advance bends (n,) over samples of velocity (T, n) [rad/s]; return them after each, (T, n)."""
    from mobnet.kernel.first_order import follow  # numba: the workflow imports kinds before it starts

    out = np.empty(velocity.shape)
    follow(bend, np.ascontiguousarray(velocity, dtype=np.float64), breakaway, 1.0 / rate_hz, out)
    return out
