"""Joint friction of the plant, (23) and Table 4: Stribeck, viscous and, in the legs, load-dependent."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.control.compiled import compiled

Array = NDArray[np.float64]


class Friction(NamedTuple):
    """Numbers of (23).

    Attributes:
        coulomb: f_c [N m].
        static: f_s [N m].
        stribeck: v_s [rad/s].
        smoothing: width of the sign function [rad/s].
        viscous: k_v (nu,) [N m s].
        load: k_lf (nu,) [1/(N m)].
    """

    coulomb: float
    static: float
    stribeck: float
    smoothing: float
    viscous: Array
    load: Array


def make_friction(plant: Mapping[str, Any], legs: NDArray[np.bool_], terms: Collection[str]) -> Friction:
    """Build the friction of a plant.

    Args:
        plant: the configuration's `plant`.
        legs: which joints are a leg's (nu,).
        terms: those of (23) that are there: `stribeck`, viscous friction with it, and `load`; others play no part here.
    """
    figures, speed, load = plant["friction"], float("stribeck" in terms), float("load" in terms)
    return Friction(
        coulomb=speed * figures["coulomb_nm"],
        static=speed * figures["static_nm"],
        stribeck=figures["stribeck_rad_s"],
        smoothing=plant["friction_smoothing_rad_s"],
        viscous=speed * np.where(legs, figures["viscous_legs_nms"], figures["viscous_others_nms"]),
        load=load * np.where(legs, figures["load_legs_per_nm"], 0.0),
    )


@compiled
def friction_torque(friction: Friction, joint: int, rate: float, torque: float) -> float:
    """Return the friction torque [N m] of (23) on one joint.

    sgn(rate) is tanh(rate / smoothing): the sign alone chatters at every step of a joint that is stuck.

    Args:
        friction: numbers of (23).
        joint: actuator.
        rate: true joint velocity [rad/s].
        torque: motor torque [N m].
    """
    fade = np.exp(-abs(rate / friction.stribeck))
    dry = friction.coulomb + (friction.static - friction.coulomb) * fade + friction.load[joint] * torque * torque
    return -np.tanh(rate / friction.smoothing) * dry - friction.viscous[joint] * rate
