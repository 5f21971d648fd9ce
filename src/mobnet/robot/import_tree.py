"""A robot's file as links and joints, and the bodies of a table that follow from it: one for each hinge that turns.

Lengths in [m], angles in [rad], masses in [kg], inertias in [kg m^2]; a rotation turns a frame's axes to its parent's.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain

import numpy as np
import pinocchio as pin

from mobnet.core.arrays import Array

WORLD = -1  # parent of a link that stands in the world
HINGE = "hinge"
SLIDE = "slide"
BALL = "ball"
FREE = "free"
PLANAR = "planar"


@dataclass(frozen=True)
class Follows:
    """What a coupled joint does: factor times the coordinate of a leader, by its index, and an offset.

    Without a leader the name is that of one which the file does not have, or empty.
    """

    leader: int | None
    factor: float
    offset: float
    name: str = ""


@dataclass
class Joint:
    """How a link moves against its parent.

    Attributes:
        name: as the file has it; empty if it has none.
        kind: HINGE, SLIDE, BALL, FREE or PLANAR.
        axis: unit vector in the link's axes (3,).
        pos: a point of the axis in the link's frame (3,).
        at: its coordinate where the link stands as the file places it.
        range: lower and upper end as the file has them; None where it has none.
        torque: the largest one [N m]; None where the file has none.
        speed: the largest one [rad/s]; None where the file has none.
        follows: the joint that it is coupled to.
        index: its number in the file, by which another reading finds it.
    """

    name: str
    kind: str
    axis: Array
    index: int
    pos: Array = field(default_factory=lambda: np.zeros(3))
    at: float = 0.0
    range: tuple[float, float] | None = None
    torque: float | None = None
    speed: float | None = None
    armature: float = 0.0
    damping: float = 0.0
    friction: float = 0.0
    stiffness: float = 0.0
    has_motor: bool = True
    follows: Follows | None = None


@dataclass
class Link:
    """A link: its place in its parent, the joints that move it in their order, and its mass."""

    name: str
    parent: int
    pos: Array
    turn: Array
    joints: list[Joint]
    mass: float
    com: Array
    inertia: Array  # about the centre of mass, in the link's axes (3, 3)


@dataclass
class Site:
    """A named place on a link; whether an inertial sensor measures there."""

    name: str
    link: int
    pos: Array
    turn: Array
    is_sensor: bool


@dataclass
class LinkTree:
    """Links of a file, parents first, and what else a table needs of it."""

    name: str
    links: list[Link]
    sites: list[Site] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    chains: int = 0  # couplings that close a chain

    def joints(self) -> list[Joint]:
        """Return all joints, those of parents first."""
        return list(chain.from_iterable(link.joints for link in self.links))

    def below(self, link: int) -> list[bool]:
        """Return for each link whether it is another one or hangs on it."""
        is_below: list[bool] = []
        for k, own in enumerate(self.links):
            is_below.append(k == link or (own.parent != WORLD and is_below[own.parent]))
        return is_below

    def hinges_below(self) -> list[int]:
        """Return the number of hinges that move each link or what hangs on it."""
        count = list[int]()
        for link in self.links:
            count.append(sum(joint.kind == HINGE for joint in link.joints))
        for k in reversed(range(len(self.links))):
            if self.links[k].parent != WORLD:
                count[self.links[k].parent] += count[k]
        return count


@dataclass
class Part:
    """A link in the frame of the body that it is a part of."""

    link: int
    mass: float
    com: Array
    inertia: Array
    pos: Array
    turn: Array


@dataclass
class RigidBody:
    """Links that move as one, with the joint that moves them; its axis goes through the origin.

    `place` is that of the frame in the parent's, with the joint at zero.
    """

    name: str
    parent: int
    pos: Array
    turn: Array
    joint: Joint | None = None
    parts: list[Part] = field(default_factory=list)


def bodies_of(tree: LinkTree, base: int, kept: Sequence[bool], locked: Mapping[int, float]) -> list[RigidBody]:
    """Return the bodies of a robot, the base first and parents before children.

    Args:
        tree: all links of the file.
        base: the link that floats; `WORLD` where the base stands still.
        kept: whether each link is a part of the robot.
        locked: index of a joint -> angle [rad] or position [m] at which it is welded. Other hinges turn.
    """
    first = "" if base == WORLD else tree.links[base].name
    bodies = [RigidBody(first, WORLD, np.zeros(3), np.eye(3))]
    places: dict[int, tuple[int, Array, Array]] = {WORLD: (0, np.zeros(3), np.eye(3))} if base == WORLD else {}
    for k, link in enumerate(tree.links):
        if k == base:
            places[k] = 0, np.zeros(3), np.eye(3)
        elif kept[k] and link.parent in places:
            places[k] = _hung(bodies, link, places[link.parent], locked)
        else:
            continue
        body, pos, turn = places[k]
        part = Part(k, link.mass, pos + turn @ link.com, turn @ link.inertia @ turn.T, pos, turn)
        bodies[body].parts.append(part)
    return bodies


def _hung(
    bodies: list[RigidBody], link: Link, place: tuple[int, Array, Array], locked: Mapping[int, float]
) -> tuple[int, Array, Array]:
    """Return body and place of a link whose parent has a place; each hinge that turns adds a body."""
    body, pos, turn = place
    pos = pos + turn @ link.pos
    turn = turn @ link.turn
    turning = [joint for joint in link.joints if joint.kind == HINGE and joint.index not in locked]
    for joint in link.joints:
        if joint.kind == HINGE:
            angle = locked.get(joint.index, 0.0) - joint.at
            anchor = pos + turn @ joint.pos
            turn = turn @ pin.exp3(angle * joint.axis)
            if joint.index not in locked:
                name = link.name if joint is turning[-1] else f"{link.name}_{joint.name}"
                bodies.append(RigidBody(name, body, anchor, turn, joint))
                body = len(bodies) - 1
                anchor = np.zeros(3)
                turn = np.eye(3)
            pos = anchor - turn @ joint.pos
        elif joint.kind == SLIDE:
            pos = pos + (locked.get(joint.index, joint.at) - joint.at) * turn @ joint.axis
    return body, pos, turn


def heights_of(bodies: Sequence[RigidBody], turn: Array) -> list[float]:
    """Return the heights of the bodies' origins above the base [m], whose axes `turn` has, with joints at zero."""
    places: list[tuple[Array, Array]] = [(np.zeros(3), turn)]
    for body in bodies[1:]:
        pos, axes = places[body.parent]
        places.append((pos + axes @ body.pos, axes @ body.turn))
    return [float(pos[2]) for pos, _ in places]
