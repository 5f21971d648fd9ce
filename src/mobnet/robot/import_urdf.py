"""The links and joints of a URDF. Shapes are not read, so that no file of a mesh is needed."""

import math
import re
import shlex
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import pinocchio as pin

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError, not_accepted
from mobnet.robot.import_tree import FREE, HINGE, PLANAR, SLIDE, WORLD, Follows, Joint, Link, LinkTree

KINDS = {"revolute": HINGE, "continuous": HINGE, "prismatic": SLIDE, "floating": FREE, "planar": PLANAR, "fixed": None}
MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
UNREAD = ("visual", "collision", "gazebo", "transmission")  # parts that say nothing about the dynamics
MACRO = re.compile(r"\$[{(]")  # how a value of xacro begins
KEYWORDS = {"arg", "call", "element", "if", "include", "insert_block", "macro", "property", "unless"}  # of xacro itself
TURN = 0.01  # length below which an axis has no direction


def read_urdf(root: ET.Element, path: Path) -> LinkTree:
    """Return the links of a URDF, depth-first in the order of its joints.

    Raises:
        DataError: it is no robot, holds xacro, or its links are no tree.
    """
    notes = list(_check_expanded(root, path))
    links = {_named(link): link for link in _once("link", root.findall("link"))}
    rows = _once("joint", root.findall("joint"))
    if not links:
        raise DataError(f"no link is not accepted; accepted: a URDF with links; of xacro, made by: {expanding(path)}")
    joints = [_Row(row, index, links) for index, row in enumerate(rows)]
    numbers = {row.name: row.index for row in joints}
    read = [_link(links[name], row, numbers) for name, row in _depth_first(links, joints)]
    places = {link.name: k for k, link in enumerate(read)}
    parents = {row.child: row.parent for row in joints}
    for link in read:
        link.parent = places.get(parents.get(link.name, ""), WORLD)
    return LinkTree(root.get("name", ""), read, notes=notes)


class _Row:
    """A joint of the file: the links that it ties, and how."""

    def __init__(self, row: ET.Element, index: int, links: Iterable[str]) -> None:
        self.name = _named(row)
        self.row = row
        self.index = index
        kind = row.get("type", "")
        if kind not in KINDS:
            raise DataError(not_accepted(f"joint {self.name}: type", kind, KINDS))
        self.kind = KINDS[kind]
        self.is_endless = kind == "continuous"
        self.parent, self.child = (_tied(self, end, links) for end in ("parent", "child"))


def _tied(joint: _Row, end: str, links: Iterable[str]) -> str:
    """Return the link at an end of a joint."""
    element = joint.row.find(end)
    link = "" if element is None else element.get("link", "")
    if link not in links:
        raise DataError(not_accepted(f"joint {joint.name}: {end}", link, links))
    return link


def _check_expanded(root: ET.Element, path: Path) -> Iterator[str]:
    """Check that a file is no xacro; yield macros that xacro itself has left in it, since it did not know them."""
    for parent in list(root.iter()):
        for kind in UNREAD:
            for part in parent.findall(kind):
                parent.remove(part)
    macros = [part.tag.rpartition("}")[2] for part in root.iter() if "xacro" in part.tag]
    words = list[str]()
    for part in root.iter():
        words += [repr(value) for value in part.attrib.values() if MACRO.search(value)]
    words += [f"xacro:{name}" for name in macros if name in KEYWORDS]
    if words:
        raise DataError(f"{words[0]} is not accepted; accepted: a URDF, made of xacro by: {expanding(path)}")
    if macros:
        yield f"macros of xacro that are not expanded are left out: {', '.join(dict.fromkeys(macros))}"


def expanding(path: Path) -> str:
    """Return the command that makes a URDF from xacro."""
    plain = path.name.removesuffix(".xacro").removesuffix(".urdf")
    made = plain if path.suffix == ".xacro" else f"{plain}_expanded"
    return f"xacro {shlex.quote(str(path))} > {shlex.quote(made)}.urdf"


def _named(row: ET.Element) -> str:
    name = row.get("name", "")
    if not name:
        raise DataError(f"a {row.tag} without a name is not accepted; accepted: a name for each link and each joint")
    return name


def _once(kind: str, rows: Sequence[ET.Element]) -> Sequence[ET.Element]:
    """Return rows if each has a name of its own."""
    seen: set[str] = set()
    for row in rows:
        name = _named(row)
        if name in seen:
            raise DataError(f"two {kind}s named {name!r} are not accepted; accepted: each name once")
        seen.add(name)
    return rows


def _depth_first(links: Iterable[str], joints: Sequence[_Row]) -> Iterator[tuple[str, _Row | None]]:
    """Yield the names of links with the joints that move them, from the root on."""
    above: dict[str, str] = {}
    below: dict[str, list[_Row]] = {}
    for joint in joints:
        if joint.child in above:
            both = f"{above[joint.child]} and {joint.name}"
            raise DataError(f"link {joint.child} below two joints, {both}, is not accepted; accepted: a tree")
        above[joint.child] = joint.name
        below.setdefault(joint.parent, []).append(joint)
    roots = [name for name in links if name not in above]
    if len(roots) != 1:
        roots_named = f"{len(roots)} roots ({', '.join(roots[:5])})" if roots else "no root (a loop of links)"
        raise DataError(f"{roots_named} is not accepted; accepted: one link on which all others hang")
    waiting: list[tuple[str, _Row | None]] = [(roots[0], None)]
    seen = 0
    while waiting:
        name, joint = waiting.pop()
        seen += 1
        yield name, joint
        waiting += [(child.child, child) for child in reversed(below.get(name, []))]
    if seen != len(list(links)):
        raise DataError("links in a loop are not accepted; accepted: one link on which all others hang")


def _link(row: ET.Element, joint: _Row | None, numbers: Mapping[str, int]) -> Link:
    """Return a link with its joint; joints have numbers by their names."""
    name = _named(row)
    pos, turn = _origin(None if joint is None else joint.row, f"joint {'' if joint is None else joint.name}")
    moved = [] if joint is None or joint.kind is None else [_joint(joint, joint.kind, numbers)]
    return Link(name, WORLD, pos, turn, moved, *_mass(row, f"link {name}"))


def _mass(row: ET.Element, where: str) -> tuple[float, Array, Array]:
    """Return mass, centre of mass (3,) and the inertia about it (3, 3) of a link."""
    inertial = row.find("inertial")
    if inertial is None:
        return 0.0, np.zeros(3), np.zeros((3, 3))
    weight = inertial.find("mass")
    moments = inertial.find("inertia")
    mass = 0.0 if weight is None else number(weight.get("value", "0"), f"{where}: mass")
    if mass < 0.0:
        raise DataError(f"{where}: mass {mass:g} kg is not accepted; accepted: 0 or more")
    numbers = {} if moments is None else moments.attrib
    xx, xy, xz, yy, yz, zz = (number(numbers.get(key, "0"), f"{where}: {key}") for key in MOMENTS)
    com, turn = _origin(inertial, where)
    return mass, com, turn @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ turn.T


def _joint(row: _Row, kind: str, numbers: Mapping[str, int]) -> Joint:
    """Return a joint with its limits."""
    where = f"joint {row.name}"
    element = row.row.find("axis")
    axis = np.array([1.0, 0.0, 0.0]) if element is None else _vector(element.get("xyz", "1 0 0"), f"{where}: axis")
    length = float(np.linalg.norm(axis))
    if length < TURN and kind in (HINGE, SLIDE):
        raise DataError(f"{where}: axis {axis.tolist()} is not accepted; accepted: a direction")
    limits, damped = (
        element.attrib if (element := row.row.find(tag)) is not None else {} for tag in ("limit", "dynamics")
    )
    low, high, torque, speed = (
        number(limits.get(key, "0"), f"{where}: {key}", finite=False)
        for key in ("lower", "upper", "effort", "velocity")
    )
    if high < low:
        raise DataError(f"{where}: range {low:g} to {high:g} is not accepted; accepted: the lower end first")
    for key, value, unit in (("effort", torque, "N m"), ("velocity", speed, "rad/s")):
        if value < 0.0:
            raise DataError(f"{where}: {key} {value:g} {unit} is not accepted; accepted: above 0; 0 stands for none")
    damping, friction = (number(damped.get(key, "0"), f"{where}: {key}") for key in ("damping", "friction"))
    coupling = row.row.find("mimic")
    follows = None if coupling is None else _coupling(coupling, where, numbers)
    return Joint(
        name=row.name,
        kind=kind,
        axis=axis / (length or 1.0),
        index=row.index,
        torque=torque,
        speed=speed,
        damping=damping,
        range=None if row.is_endless or not low < high else (low, high),
        friction=friction,
        follows=follows,
    )


def _coupling(row: ET.Element, where: str, numbers: Mapping[str, int]) -> Follows:
    factor = row.get("multiplier", "1")
    offset = row.get("offset", "0")
    leader = numbers.get(row.get("joint", ""))
    return Follows(leader, number(factor, f"{where}: multiplier"), number(offset, f"{where}: offset of mimic"))


def _origin(row: ET.Element | None, where: str) -> tuple[Array, Array]:
    """Return position (3,) and rotation (3, 3) of an `origin`."""
    element = None if row is None else row.find("origin")
    if element is None:
        return np.zeros(3), np.eye(3)
    angles = _vector(element.get("rpy", "0 0 0"), f"{where}: rpy")
    return _vector(element.get("xyz", "0 0 0"), f"{where}: xyz"), pin.rpy.rpyToMatrix(angles)


def _vector(text: str, where: str) -> Array:
    words = text.split()
    if len(words) != 3:
        raise DataError(f"{where} {text!r} is not accepted; accepted: three numbers")
    return np.array([number(word, where) for word in words])


def number(text: str, where: str, *, finite: bool = True) -> float:
    """Return a number of a file; where it need not be finite, nan stands for infinity.

    Raises:
        DataError: it is none.
    """
    try:
        value = float(text)
    except ValueError:
        raise DataError(f"{where} {text!r} is not accepted; accepted: a number") from None
    if math.isfinite(value):
        return value
    if finite:
        raise DataError(f"{where} {text!r} is not accepted; accepted: a finite number")
    return math.inf if math.isnan(value) else value
