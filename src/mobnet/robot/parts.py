"""Parts of the robot as values, each read from a row of the table of figures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

MIRROR_Y = np.array([1.0, -1.0, 1.0])
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
class Foot:
    """A foot: `body` is welded to `ankle`, the last link of the leg `limb`."""

    body: str
    ankle: str
    limb: str


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


def with_mirrored(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return rows of the left side, each with its mirror image in y, and other rows as they are."""
    return [image for row in rows for image in ([row, _mirrored(row)] if row["name"].startswith("left_") else [row])]


def _mirrored(row: Mapping[str, Any]) -> dict[str, Any]:
    """Return a row of the left side as the right side has it."""
    image = {**row, "name": row["name"].replace("left_", "right_", 1), "body": row["body"].replace("L_", "R_", 1)}
    for key in ("pos", "segment"):
        if key in row:
            image[key] = (np.reshape(row[key], (-1, len(MIRROR_Y))) * MIRROR_Y).ravel()
    return image


def vector(values: ArrayLike) -> Vector:
    """Return numbers of the table as a float64 vector (n,), in the table's SI units such as [m]."""
    return np.asarray(values, dtype=np.float64)


def read_body(row: Mapping[str, Any]) -> Body:
    """Return a row of `bodies`; its quaternion is brought to unit length."""
    quat = vector(row["quat"])
    return Body(
        row["name"],
        row["parent"],
        vector(row["pos"]),
        quat / np.linalg.norm(quat),
        float(row["mass"]),
        vector(row["com"]),
        vector(row["inertia"]),
    )


def read_joint(row: Mapping[str, Any]) -> Joint:
    """Return a row of `joints`."""
    return Joint(
        row["id"],
        row["body"],
        vector(row["axis"]),
        vector(row["range"]),
        float(row["torque_limit"]),
        float(row["armature"]),
        float(row["velocity_limit"]),
    )


def read_shape(row: Mapping[str, Any], tones: Mapping[str, Any]) -> Shape:
    """Return a row of `shapes`."""
    return Shape(
        row["name"],
        row["body"],
        row["type"],
        vector(row["size"]),
        vector(row.get("pos", np.zeros_like(MIRROR_Y))),
        vector(row["segment"]) if "segment" in row else None,
        vector(tones[row["tone"]]),
    )


def read_point(row: Mapping[str, Any]) -> Point:
    """Return a row of `points`."""
    return Point(row["name"], row["body"], vector(row["pos"]))
