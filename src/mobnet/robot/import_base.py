"""Which links of a file are the robot, which of them is its base, and which joints are welded."""

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from mobnet.core.errors import DataError, not_accepted
from mobnet.robot.import_tree import BALL, FREE, HINGE, PLANAR, SLIDE, WORLD, Follows, Joint, Link, LinkTree

WELDED = {SLIDE: "slides", BALL: "is a ball", PLANAR: "moves in a plane", FREE: "moves freely"}
UNITS = {HINGE: "rad", SLIDE: "m"}


@dataclass
class RobotSelection:
    """What of a file becomes a table.

    Attributes:
        base: the link that floats; `WORLD` where the base stands still.
        kept: whether each link is a part of the robot.
        held: index of a joint -> angle [rad] or position [m] at which it is welded.
        idle: names of links that a hinge moves without any mass.
    """

    base: int
    kept: list[bool]
    held: dict[int, float] = field(default_factory=dict)
    idle: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    @property
    def floating(self) -> bool:
        """Whether the base floats."""
        return self.base != WORLD


def robot_of(tree: LinkTree, floating: bool | None, locked: Sequence[str]) -> RobotSelection:
    """Return the robot of a file.

    Args:
        tree: all of its links.
        floating: whether the base floats; None where the file says it.
        locked: JOINT=ANGLE, joints that are welded.

    Raises:
        DataError: there are several robots that float, or none, or a locked joint is none of the file.
    """
    hinges = tree.hinges_below()
    free = [k for k, link in enumerate(tree.links) if _is_free(link)]
    robots = [k for k in free if hinges[k]]
    others = sum(count for count, link in zip(hinges, tree.links, strict=True) if link.parent == WORLD)
    others -= sum(hinges[k] for k in robots)
    if floating or (floating is None and robots and max(hinges[k] for k in robots) >= others):
        base = _base(tree, robots, hinges)
        moved = [_shown(joint) for joint in tree.links[base].joints if joint.kind != FREE]
        if moved:
            raise DataError(f"joints that move the base, {', '.join(moved)}, are not accepted; accepted: --base fixed")
        kept = tree.below(base)
    else:
        base = WORLD
        objects = [tree.below(k) for k in free if others or not hinges[k]]
        kept = [not any(column) for column in zip(*objects, strict=True)] if objects else [True] * len(tree.links)
    robot = RobotSelection(base, kept)
    gone = [link.name or "a body without a name" for link, stays in zip(tree.links, kept, strict=True) if not stays]
    if gone:
        robot.notes.append(f"left out, as no part of the robot: {', '.join(gone)}")
    robot.notes += _weld(tree, robot, locked)
    return robot


def _base(tree: LinkTree, robots: Sequence[int], hinges: Sequence[int]) -> int:
    """Return the link that floats: the one that does in the file, or else the one root with hinges."""
    roots = [k for k, link in enumerate(tree.links) if link.parent == WORLD and hinges[k]]
    candidates = list(robots) or roots
    if len(candidates) > 1:
        names = " and ".join(tree.links[k].name for k in candidates[:5])
        raise DataError(
            f"{len(candidates)} bases that float ({names}) are not accepted; accepted: one, or --base fixed"
        )
    if not candidates:
        raise DataError("no hinge; accepted: a robot whose joints turn")
    return candidates[0]


def _is_free(link: Link) -> bool:
    """Return whether a link has a joint that lets it move freely."""
    return any(joint.kind == FREE for joint in link.joints)


def _weld(tree: LinkTree, robot: RobotSelection, locked: Sequence[str]) -> Iterator[str]:
    """Note which joints do not turn, and yield why."""
    joints = list[Joint]()
    for link, is_kept in zip(tree.links, robot.kept, strict=True):
        joints += link.joints if is_kept else []
    places = {joint.index: joint for joint in joints}
    asked = _asked(joints, locked)
    robot.held |= asked
    for joint in joints:
        if joint.index in asked:
            yield f"{joint.name}: welded at {asked[joint.index]:g} {UNITS[joint.kind]}, as --lock asks for"
        elif joint.kind in WELDED and not (joint.kind == FREE and _moves_base(tree, robot, joint)):
            at = joint.at if joint.kind == SLIDE else 0.0
            robot.held[joint.index] = at
            where = f"at {at:g} m" if at else "at zero"
            yield f"{_shown(joint)}: {WELDED[joint.kind]}; it is welded {where}, as a table holds hinges alone"
        elif joint.follows is not None:
            robot.held[joint.index] = _coupled(joint, places, asked)
            leader = places.get(-1 if joint.follows.leader is None else joint.follows.leader)
            what = _coupling_text(joint, joint.follows, leader)
            where = f"{robot.held[joint.index]:g} {UNITS[joint.kind]}"
            yield f"{_shown(joint)}: {what}; it is welded at {where}, as a motor of its own moves each joint of a table"
    yield from _weld_idle(tree, robot)


def _moves_base(tree: LinkTree, robot: RobotSelection, joint: Joint) -> bool:
    return robot.floating and joint in tree.links[robot.base].joints


def _shown(joint: Joint) -> str:
    return joint.name or f"joint {joint.index}"


def _coupling_text(joint: Joint, follows: Follows, leader: Joint | None) -> str:
    """Return what a joint does that its leader, if it has one, moves."""
    if leader is joint:
        return "follows itself"
    if leader is not None:
        return f"follows {_shown(leader)}"
    return f"follows {follows.name}, which is not in the file" if follows.name else "is held"


def _coupled(joint: Joint, joints: Mapping[int, Joint], asked: Mapping[int, float]) -> float:
    """Return the coordinate of a joint whose leader, or the leader of that one, is locked or else at zero."""
    value = 0.0
    factor = 1.0
    seen = set[int]()
    follows = joint.follows
    index = joint.index
    while follows is not None and index not in seen:
        seen.add(index)
        value = value + factor * follows.offset
        factor = factor * follows.factor
        if follows.leader is None or follows.leader not in joints:
            return value
        index = follows.leader
        follows = None if index in asked else joints[index].follows
    return value + factor * asked.get(index, 0.0)


def _asked(joints: Iterable[Joint], locked: Sequence[str]) -> dict[int, float]:
    """Return index -> coordinate of the joints that a user locks.

    Raises:
        DataError: a word is no JOINT=ANGLE, or names no hinge or slide of the robot.
    """
    names = {joint.name: joint.index for joint in joints if joint.kind in UNITS and joint.name}
    angles = {}
    for word in locked:
        name, _, angle = (word, "", "0") if word in names else word.rpartition("=")
        if name not in names:
            raise DataError(not_accepted("--lock", name or word, names))
        try:
            angles[names[name]] = float(angle)
        except ValueError:
            raise DataError(not_accepted("--lock", word, [f"{name}=ANGLE in rad"])) from None
        if not math.isfinite(angles[names[name]]):
            raise DataError(not_accepted("--lock", word, [f"{name}=ANGLE in rad"]))
    return angles


def _weld_idle(tree: LinkTree, robot: RobotSelection) -> Iterator[str]:
    """Weld hinges that move nothing with a mass, and yield them."""
    heavy = [bool(link.mass or link.inertia.any()) for link in tree.links]
    for k in reversed(range(len(tree.links))):
        parent = tree.links[k].parent
        if parent != WORLD and heavy[k]:
            heavy[parent] = True
    idle = list[Joint]()
    for link, is_kept, has_mass in zip(tree.links, robot.kept, heavy, strict=True):
        if is_kept and not has_mass:
            hinges = [joint for joint in link.joints if joint.kind == HINGE and joint.index not in robot.held]
            idle += hinges
            robot.idle += [link.name] if hinges else []
    robot.held |= {joint.index: joint.at for joint in idle}
    if idle:
        yield f"welded, as they move no mass: {', '.join(map(_shown, idle))}"
