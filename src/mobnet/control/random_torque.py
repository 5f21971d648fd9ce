"""Random torque exploration (section 4.3): each joint gets steps of random torque, a leg only while it swings."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled
from mobnet.core.errors import ConfigError
from mobnet.core.joints import JointLayout
from mobnet.settings.data import RandomTorque


class Exploration(NamedTuple):
    """Law and state of the exploration."""

    amplitude: Array  # largest torque of each joint (nu,) [N m]; all zero switches it off
    shortest: float  # shortest period [s]
    longest: float  # longest period [s]
    value: Array  # torque of the running period (nu,) [N m]
    left: Array  # time left in it (nu,) [s]
    on: NDArray[np.int64]  # 1 while the torque acts (nu,)


def make_exploration(settings: RandomTorque, layout: JointLayout, present: bool) -> Exploration:
    """Build the exploration of section 4.3; all amplitudes are zero where it is not present.

    Raises:
        ConfigError: the amplitudes of an arm are not as many as its joints.
    """
    legs_waist = settings.legs_waist_nm
    arms = settings.arms_nm
    neck = settings.neck_nm
    amplitude = np.zeros(layout.nu)
    for limb, bound in {"LL": legs_waist, "RL": legs_waist, "W": legs_waist, "LA": arms, "RA": arms, "N": neck}.items():
        joints = layout.limb(limb)
        if isinstance(bound, tuple) and len(bound) != len(joints):
            raise ConfigError(f"random_torque.arms_nm: {len(bound)} values; accepted: {len(joints)} ({limb})")
        amplitude[layout.columns(joints) - len(layout.virtual)] = bound
    nu = layout.nu
    return Exploration(amplitude * present, *settings.period_s, np.zeros(nu), np.zeros(nu), np.zeros(nu, np.int64))


@compiled
def advance_random_torque(law: Exploration, rng: np.random.Generator, dt: float) -> None:
    """Advance every joint's on and off periods by dt [s]; a new period draws its length and, if on, its torque."""
    for j in range(len(law.amplitude)):
        law.left[j] -= dt
        if law.left[j] <= 0.0:
            law.on[j] = 1 - law.on[j]
            law.left[j] += rng.uniform(law.shortest, law.longest)
            law.value[j] = law.on[j] * rng.uniform(-1.0, 1.0) * law.amplitude[j]
