"""A payload on a body: its mass and the centre of it, of a log in which the table does not have it.

A payload is taken for a ball of a density, about its own centre: what it resists to turning is small beside its mass
times the square of its distance from the joints, and a log tells little of it. So it is a body that can exist, whatever
the numbers are (Traversaro et al., IROS 2016). Its ten parameters follow from mass and first moment, and but for the
inertia in proportion to them; they are fitted by Gauss-Newton beside all other numbers.
"""

import math
from dataclasses import dataclass

import numpy as np

from mobnet.core.arrays import Array
from mobnet.robotlog.identifying.regressors import RegressorWindows

NUMBERS = 4  # mass [kg] and first moment [kg m] in the axes of the body, about its origin
LEAST_KG = 1e-3
STEP = 1e-6  # of differences
START = np.array([1.0, 0.0, 0.0, 0.0])


@dataclass(frozen=True)
class Payload:
    """Mass [kg] and centre (3,) [m] in the axes of the body, half the widths of their intervals, and inertia [kg m^2].

    `inertia` is about its own centre, the same about each axis.
    """

    mass: float
    com: tuple[float, float, float]
    mass_half: float
    com_half: tuple[float, float, float]
    inertia: float


def parameters(numbers: Array, density: float) -> Array:
    """Return the ten parameters of a payload in Pinocchio's order, of its mass and first moment (4,), and a density."""
    mass = max(float(numbers[0]), LEAST_KG)
    moment = numbers[1:]
    about = np.eye(3) * own_inertia(mass, density) + (moment @ moment * np.eye(3) - np.outer(moment, moment)) / mass
    return np.array([mass, *moment, about[0, 0], about[0, 1], about[1, 1], about[0, 2], about[1, 2], about[2, 2]])


def own_inertia(mass: float, density: float) -> float:
    """Return the inertia of a ball of a mass [kg] and a density [kg/m^3] about its centre [kg m^2]."""
    return 0.4 * mass * (3.0 * mass / (4.0 * math.pi * density)) ** (2.0 / 3.0)


def linearised(windows: RegressorWindows, numbers: Array, density: float) -> RegressorWindows:
    """Return windows whose last columns of the links are those of mass and first moment near some numbers (4,)."""
    at = parameters(numbers, density)
    slopes = np.column_stack([(parameters(numbers + STEP * e, density) - at) / STEP for e in np.eye(NUMBERS)])
    joints = windows.joints.copy()
    joints[..., -1] -= windows.payload @ (at - slopes @ numbers)
    return RegressorWindows(joints, np.concatenate([windows.links, windows.payload @ slopes], axis=-1), windows.payload)


def payload_of(numbers: Array, half: Array, density: float) -> Payload:
    """Return a payload by its mass and first moment (4,) with half the widths of their intervals (4,)."""
    mass = max(float(numbers[0]), LEAST_KG)
    x, y, z = (numbers[1:] / mass).tolist()
    wide, high, deep = (half[1:] / mass).tolist()
    return Payload(mass, (x, y, z), float(half[0]), (wide, high, deep), own_inertia(mass, density))
