"""Random torque exploration (section 4.3): each joint gets steps of random torque, a leg only while it swings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.control.compiled import compiled
from mobnet.core.errors import ConfigError
from mobnet.core.joints import JointLayout

Array = NDArray[np.float64]
LIMBS = dict.fromkeys(("LL", "RL", "W"), "legs_waist_nm") | {"LA": "arms_nm", "RA": "arms_nm", "N": "neck_nm"}


class RandomTorque(NamedTuple):
    """Law and state of the exploration.

    Attributes:
        amplitude: largest torque of each joint (nu,) [N m]; all zero switches it off.
        shortest: shortest period [s].
        longest: longest period [s].
        value: torque of the running period (nu,) [N m].
        left: time left in it (nu,) [s].
        on: 1 while the torque acts (nu,).
    """

    amplitude: Array
    shortest: float
    longest: float
    value: Array
    left: Array
    on: NDArray[np.int64]


def make_random_torque(settings: Mapping[str, Any], layout: JointLayout, present: bool) -> RandomTorque:
    """Build the exploration of section 4.3 from the `random_torque` section.

    Raises:
        ConfigError: a list of amplitudes does not fit its limb.
    """
    amplitude = np.zeros(layout.nu)
    for limb, key in LIMBS.items():
        joints, bound = layout.limb(limb), np.ravel(settings[key])
        if len(bound) not in (1, len(joints)):
            raise ConfigError(f"random_torque.{key}: {len(bound)} values; accepted: 1 or {len(joints)} ({limb})")
        amplitude[layout.columns(joints) - len(layout.virtual)] = bound
    shortest, longest = map(float, settings["period_s"])
    return RandomTorque(
        amplitude * present, shortest, longest, np.zeros(layout.nu), np.zeros(layout.nu), np.zeros(layout.nu, np.int64)
    )


@compiled
def advance_random_torque(law: RandomTorque, rng: np.random.Generator, dt: float) -> None:
    """Advance every joint's on and off periods by dt [s]; a new period draws its length and, if on, its torque."""
    for j in range(len(law.amplitude)):
        law.left[j] -= dt
        if law.left[j] <= 0.0:
            law.on[j] = 1 - law.on[j]
            law.left[j] += rng.uniform(law.shortest, law.longest)
            law.value[j] = law.on[j] * rng.uniform(-1.0, 1.0) * law.amplitude[j]
