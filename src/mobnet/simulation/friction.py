"""Joint friction of the plant, (23) and Table 4: Stribeck, viscous and, in the legs, load-dependent."""

from collections.abc import Collection
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled
from mobnet.settings.plant import Plant
from mobnet.settings.surrogate import FrictionTerm


class PlantFriction(NamedTuple):
    """Numbers of (23)."""

    coulomb: float  # f_c [N m]
    static: float  # f_s [N m]
    stribeck: float  # v_s [rad/s]
    smoothing: float  # width of the sign function [rad/s]
    viscous: Array  # k_v (nu,) [N m s]
    load: Array  # k_lf (nu,) [1/(N m)]


def make_friction(plant: Plant, legs: NDArray[np.bool_], terms: Collection[FrictionTerm]) -> PlantFriction:
    """Build the friction of a plant, (23) and Table 4, whose joints (nu,) in `legs` belong to a leg.

    Of the terms of (23), `stribeck` comes with the viscous one, and `loss` is left to MuJoCo.
    """
    table = plant.friction
    speed = float("stribeck" in terms)
    load = float("load" in terms)
    return PlantFriction(
        coulomb=speed * table.coulomb_nm,
        static=speed * table.static_nm,
        stribeck=table.stribeck_rad_s,
        smoothing=plant.friction_smoothing_rad_s,
        viscous=speed * np.where(legs, table.viscous_legs_nms, table.viscous_others_nms),
        load=load * np.where(legs, table.load_legs_per_nm, 0.0),
    )


@compiled
def friction_torque(friction: PlantFriction, joint: int, rate: float, torque: float) -> float:
    """Return the friction torque [N m] of (23) on an actuator's joint at its true rate [rad/s] and motor torque [N m].

    sgn(rate) is tanh(rate / smoothing): the sign alone chatters at every step of a joint that is stuck.
    """
    fade = np.exp(-abs(rate / friction.stribeck))
    dry = friction.coulomb + (friction.static - friction.coulomb) * fade + friction.load[joint] * torque * torque
    return -np.tanh(rate / friction.smoothing) * dry - friction.viscous[joint] * rate
