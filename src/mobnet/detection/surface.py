"""Where something can touch a limb: points on the solids of its bodies, and what a force there does to a body.

Bodies that no joint moves are carried by the next one above that a joint moves, or by the base.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import ConfigError
from mobnet.detection.solids import Patch, across, depth, patch_of
from mobnet.formats.parts import ShapeRow
from mobnet.robot.description import RobotDescription
from mobnet.robot.wrench import carrier_of

WITHIN = 1e-6  # depth from which a point counts as inside of a solid [m]


class Carrier(NamedTuple):
    """The joint that moves a body, none of the base, and the body's axes (3, 3) and origin (3,) [m] in its link."""

    joint: str | None
    axes: Array
    origin: Array


@dataclass(frozen=True)
class Surface:
    """Points on the solids of some bodies.

    Attributes:
        shapes: the solids.
        carriers: what carries the body of each of them.
        shape: which solid each point lies on (k,).
        patch: points and normals, each in the axes of its solid's body.
        wrenches: force [N] and moment [N m] of 1 N into the surface and along two directions on it, in the axes of the
            link that carries the body and about its origin, (k, 3, 6).
    """

    shapes: tuple[ShapeRow, ...]
    carriers: tuple[Carrier, ...]
    shape: NDArray[np.intp]
    patch: Patch
    wrenches: Array


def surface_of(robot: RobotDescription, limb: str, spacing_m: float) -> Surface:
    """Return points on the solids of all bodies that a limb moves, about so far apart [m].

    Points inside another solid of the same body are left out.

    Raises:
        ConfigError: the limb is unknown, or its bodies have no `shapes` in the table.
    """
    moved = robot.layout.limb(limb)
    carried = {body.name: carried_by(robot, body.name) for body in robot.bodies}
    shapes = tuple(shape for shape in robot.shapes if carried[shape.body].joint in moved)
    if not shapes:
        raise ConfigError(f"robot {robot.name}: no `shapes` of limb {limb} in its table, so that nothing can touch it")
    patches = [_bare(patch_of(shape, spacing_m), shape, shapes) for shape in shapes]
    carriers = tuple(carried[shape.body] for shape in shapes)
    wrenches = [_wrenches(*pair) for pair in zip(patches, carriers, strict=True)]
    number = np.repeat(np.arange(len(shapes)), [len(patch.area) for patch in patches])
    whole = Patch(*(np.concatenate(parts) for parts in zip(*patches, strict=True)))
    return Surface(shapes, carriers, number, whole, np.concatenate(wrenches))


def carried_by(robot: RobotDescription, body: str) -> Carrier:
    """Return what carries a body; a ConfigError names an unknown one."""
    joint, placement = carrier_of(robot, body)
    return Carrier(joint, placement.rotation, placement.translation)


def _bare(patch: Patch, shape: ShapeRow, shapes: Sequence[ShapeRow]) -> Patch:
    """Return the points of a solid that lie inside no other solid of its body."""
    kept = np.ones(len(patch.area), dtype=bool)
    for other in shapes:
        if other is not shape and other.body == shape.body:
            kept &= depth(other, patch.points) < WITHIN
    return patch.only(kept)


def _wrenches(patch: Patch, carrier: Carrier) -> Array:
    """Return the wrenches of 1 N at the points of a solid, as `Surface` has them, (k, 3, 6)."""
    forces = np.stack([-patch.normals, *across(patch.normals)], axis=1) @ carrier.axes.T
    points = carrier.origin + patch.points @ carrier.axes.T
    return np.concatenate([forces, np.cross(points[:, None], forces)], axis=-1)
