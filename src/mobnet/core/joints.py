"""Joint names, limb groups and where they stand in the generalized velocity (Figure 4, section 4.1)."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import ConfigError, not_accepted

N_VIRTUAL = 6  # degrees of freedom of a floating base
NQ_BASE = 7  # position (3) and unit quaternion (4) of a floating base
LEG_AXES = ("z", "x", "y", "y", "y", "x")  # of a leg that walks: hip yaw, roll, pitch, knee, ankle pitch, roll
VIRTUAL_UNITS = ("N", "N", "N", "N m", "N m", "N m")


class Limits(NamedTuple):
    """What a joint can do: range [rad], largest speed [rad/s] and torque of its motor [N m]."""

    low: float
    high: float
    speed: float
    torque: float


@dataclass(frozen=True)
class JointLayout:
    """Order of the generalized velocity: virtual joints V1..V6 of a floating base, then the actuated joints.

    Attributes:
        virtual: names of the six virtual joints; 1..3 linear [m/s, N] in world axes, 4..6 angular [rad/s, N m] in
            base axes; empty for a fixed base.
        actuated: names of the actuated joints, in motor order, (nu,).
        groups: limb name -> joint names; section 4.1 uses V, LL, RL, W, LA, RA.
        legs: `left`, `right` -> limb that stands on the foot of that side; empty for a robot without feet.
        limits: actuated joint -> what it can do, to which recordings are compared.
    """

    virtual: tuple[str, ...]
    actuated: tuple[str, ...]
    groups: Mapping[str, tuple[str, ...]]
    legs: Mapping[str, str] = field(default_factory=dict)
    limits: Mapping[str, Limits] = field(default_factory=dict)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all generalized velocities, (nv,)."""
        return self.virtual + self.actuated

    @property
    def nv(self) -> int:
        """Number of generalized velocities."""
        return len(self.virtual) + len(self.actuated)

    @property
    def nu(self) -> int:
        """Number of actuators."""
        return len(self.actuated)

    @property
    def nq(self) -> int:
        """Number of generalized positions, the orientation of a floating base being a quaternion."""
        return (NQ_BASE if self.virtual else 0) + self.nu

    @property
    def above_legs(self) -> tuple[str, ...]:
        """Names of the actuated joints that belong to no leg, in motor order."""
        legs = set(chain.from_iterable(self.groups[limb] for limb in self.legs.values()))
        return tuple(joint for joint in self.actuated if joint not in legs)

    @property
    def limb_of(self) -> dict[str, str]:
        """The limb of each joint."""
        limbs: dict[str, str] = {}
        for limb, joints in self.groups.items():
            limbs |= dict.fromkeys(joints, limb)
        return limbs

    def limb(self, name: str) -> tuple[str, ...]:
        """Return the joint names of a limb; a ConfigError names an unknown one."""
        if name not in self.groups:
            raise ConfigError(not_accepted("limb", name, self.groups))
        return self.groups[name]

    def limbs(self, names: Iterable[str]) -> tuple[str, ...]:
        """Return the joint names of several limbs, limb by limb."""
        return tuple(chain.from_iterable(self.limb(name) for name in names))

    def columns(self, names: Sequence[str]) -> NDArray[np.intp]:
        """Return the columns of joints in a generalized velocity or torque, (len(names),).

        Raises:
            ConfigError: a joint is unknown.
        """
        where = {name: i for i, name in enumerate(self.names)}
        unknown = [name for name in names if name not in where]
        if unknown:
            raise ConfigError(not_accepted("joint", unknown[0], where))
        return np.array([where[name] for name in names], dtype=np.intp)

    def unit(self, name: str) -> str:
        """Return the unit of a joint's torque: N for V1..V3, N m otherwise."""
        return VIRTUAL_UNITS[self.virtual.index(name)] if name in self.virtual else "N m"


def right_of(body: str) -> str:
    """Return the name of the body that is the mirror image of another; a middle body is its own."""
    left, right = ("L_", "R_") if "L_" in body else ("left_", "right_")
    return body.replace(left, right, 1)


def with_image(part: str) -> tuple[str, ...]:
    """Return the name of a shape or a point, and that of its mirror image if it has one."""
    return (part, part.replace("left_", "right_", 1)) if part.startswith("left_") else (part,)
