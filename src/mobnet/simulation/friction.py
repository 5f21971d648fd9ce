"""Joint friction of the plant, (23) and Table 4: Stribeck, viscous and, in the legs, load-dependent."""

from collections.abc import Collection
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.control.compiled import compiled
from mobnet.settings.plant import FrictionTerm, Plant

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


def make_friction(plant: Plant, legs: NDArray[np.bool_], terms: Collection[FrictionTerm]) -> Friction:
    """Build the friction of a plant, (23) and Table 4.

    Args:
        plant: numbers of Table 4.
        legs: which joints belong to a leg (nu,).
        terms: terms of (23) that are there: `stribeck` with the viscous one, `load`; `loss` is left to MuJoCo.
    """
    table, speed, load = plant.friction, float("stribeck" in terms), float("load" in terms)
    return Friction(
        coulomb=speed * table.coulomb_nm,
        static=speed * table.static_nm,
        stribeck=table.stribeck_rad_s,
        smoothing=plant.friction_smoothing_rad_s,
        viscous=speed * np.where(legs, table.viscous_legs_nms, table.viscous_others_nms),
        load=load * np.where(legs, table.load_legs_per_nm, 0.0),
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
