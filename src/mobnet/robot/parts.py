"""Parts of a robot as numpy values."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Body:
    """A link, without its rotor.

    Attributes:
        name: name in the table.
        parent: name of the body it hangs on, `world` for the base.
        pos: origin in the parent's frame (3,) [m].
        quat: orientation in the parent's frame, unit, w x y z (4,).
        mass: link mass [kg].
        com: centre of mass in body axes (3,) [m].
        inertia: about the centre of mass, body axes: xx yy zz xy xz yz (6,) [kg m^2].
    """

    name: str
    parent: str
    pos: Vector
    quat: Vector
    mass: float
    com: Vector
    inertia: Vector


@dataclass(frozen=True)
class Joint:
    """An actuated hinge at its body's origin.

    Attributes:
        id: name used in this project, LL1 and so on (Figure 4).
        body: name of the body it moves.
        axis: unit axis in body axes (3,).
        range: lower and upper limit (2,) [rad].
        torque_limit: largest motor torque [N m].
        armature: reflected rotor inertia [kg m^2].
        velocity_limit: largest speed [rad/s].
    """

    id: str
    body: str
    axis: Vector
    range: Vector
    torque_limit: float
    armature: float
    velocity_limit: float


@dataclass(frozen=True)
class Sole:
    """What a foot stands on, in the foot's frame.

    Attributes:
        sensor_pos: force/torque sensor (3,) [m].
        centre: centre of the box that touches the ground (3,) [m].
        half: its half lengths (3,) [m].
        height: height of its lower face [m].
    """

    sensor_pos: Vector
    centre: Vector
    half: Vector
    height: float


@dataclass(frozen=True)
class Foot:
    """A foot: `body` is the last one of the leg `limb`."""

    body: str
    limb: str
    sole: Sole


@dataclass(frozen=True)
class Leg:
    """Geometry of both legs.

    Attributes:
        hip_pos: left hip in the base (3,) [m].
        link_length: length of the thigh, and of the shank [m].
    """

    hip_pos: Vector
    link_length: float


@dataclass(frozen=True)
class Posture:
    """How joints are held while nothing moves them.

    Attributes:
        joints: names, in motor order (n,).
        angle: positions (n,) [rad].
        stiffness: torque of a position error (n,) [N m/rad].
        damping: torque of a velocity error (n,) [N m s/rad].
    """

    joints: tuple[str, ...]
    angle: Vector
    stiffness: Vector
    damping: Vector


@dataclass(frozen=True)
class Shape:
    """A solid to look at, without mass; either `pos` (3,) [m] or `segment` (6,) [m] places it in its body's frame.

    Attributes:
        name: name of the solid.
        body: body that carries it.
        type: capsule, cylinder, box, ellipsoid or sphere.
        size: radius or half lengths [m].
        pos: centre (3,) [m].
        segment: both ends (6,) [m], or None.
        rgba: colour (4,), 0..1.
    """

    name: str
    body: str
    type: str
    size: Vector
    pos: Vector
    segment: Vector | None
    rgba: Vector


@dataclass(frozen=True)
class Point:
    """A named point of a body, pos (3,) [m] in body axes."""

    name: str
    body: str
    pos: Vector
