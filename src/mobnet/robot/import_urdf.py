"""The links and joints of a URDF. Shapes are not read, so that no file of a mesh is needed."""

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np
import pinocchio as pin

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError, not_accepted
from mobnet.robot.import_file import expanding
from mobnet.robot.import_tree import FREE, HINGE, PLANAR, SLIDE, WORLD, Follows, Joint, Link, LinkTree

KINDS = {"revolute": HINGE, "continuous": HINGE, "prismatic": SLIDE, "floating": FREE, "planar": PLANAR, "fixed": None}
MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
UNREAD = ("visual", "collision", "gazebo", "transmission")  # parts that say nothing about the dynamics
MACRO = re.compile(r"\$[{(]")  # how a value of xacro begins
KEYWORDS = {"arg", "call", "element", "if", "include", "insert_block", "macro", "property", "unless"}  # of xacro itself
TURN = 0.01  # length below which an axis or a quaternion has no direction
NO_LIMIT = -1.0  # as SDF writes it; so do 0 and infinity
QUATERNION = 4  # numbers
WITHOUT_QUATERNIONS = ("", "1.0")  # versions of URDF in which an origin has none


def read_urdf(root: ET.Element, path: Path) -> LinkTree:
    """Return the links of a URDF, depth-first in the order of its joints.

    Raises:
        DataError: it is no robot, holds xacro, or its links are no tree.
    """
    notes = list(_check_expanded(root, path))
    _check_version(root)
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
    prefixes = ["xacro"]
    for part in root.iter():
        prefixes += [key.removeprefix("xmlns:") for key, value in part.attrib.items() if _is_xacro(key, value)]
    macros = list[str]()
    words = list[str]()
    for part in root.iter():
        prefix, _, name = part.tag.rpartition(":")
        macros += [name] if prefix in prefixes else []
        words += [repr(value) for value in part.attrib.values() if MACRO.search(value)]
    words += [f"xacro:{name}" for name in macros if name in KEYWORDS]
    if words:
        raise DataError(f"{words[0]} is not accepted; accepted: a URDF, made of xacro by: {expanding(path)}")
    if macros:
        yield f"macros of xacro that are not expanded are left out: {', '.join(dict.fromkeys(macros))}"


def _is_xacro(key: str, value: str) -> bool:
    """Return whether an attribute binds a prefix to xacro."""
    return key.startswith("xmlns:") and "xacro" in value


def _check_version(root: ET.Element) -> None:
    """Raise a DataError for quaternions in a version of URDF whose readers take no notice of them."""
    version = root.get("version", "")
    for part in root.iter("origin"):
        if "quat_xyzw" in part.attrib and version in WITHOUT_QUATERNIONS:
            what = f"quat_xyzw {part.attrib['quat_xyzw']!r} in a URDF of version {version or '1.0'}"
            raise DataError(f'{what} is not accepted; accepted: rpy, or version="1.1" of the robot')


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
    for key, value, unit in (("effort", torque, "N m"), ("velocity", speed, "rad/s")):
        if value < 0.0 and value != NO_LIMIT:
            refused = f"{where}: {key} {value:g} {unit} is not accepted"
            raise DataError(f"{refused}; accepted: above 0; 0, -1 and inf stand for none")
    damping, friction = (number(damped.get(key, "0"), f"{where}: {key}") for key in ("damping", "friction"))
    coupling = row.row.find("mimic")
    follows = None if coupling is None else _coupling(coupling, where, numbers)
    return Joint(
        name=row.name,
        kind=kind,
        axis=axis / (length or 1.0),
        index=row.index,
        torque=max(torque, 0.0),
        speed=max(speed, 0.0),
        damping=damping,
        range=None if row.is_endless or low == high else (low, high),
        friction=friction,
        follows=follows,
    )


def _coupling(row: ET.Element, where: str, numbers: Mapping[str, int]) -> Follows:
    factor = row.get("multiplier", "1")
    offset = row.get("offset", "0")
    name = row.get("joint", "")
    numbers_read = number(factor, f"{where}: multiplier"), number(offset, f"{where}: offset of mimic")
    return Follows(numbers.get(name), *numbers_read, name)


def _origin(row: ET.Element | None, where: str) -> tuple[Array, Array]:
    """Return position (3,) and rotation (3, 3) of an `origin`."""
    element = None if row is None else row.find("origin")
    if element is None:
        return np.zeros(3), np.eye(3)
    pos = _vector(element.get("xyz", "0 0 0"), f"{where}: xyz")
    if "quat_xyzw" not in element.attrib:
        return pos, pin.rpy.rpyToMatrix(_vector(element.get("rpy", "0 0 0"), f"{where}: rpy"))
    if "rpy" in element.attrib:
        raise DataError(f"{where}: an origin with rpy and quat_xyzw is not accepted; accepted: one of them")
    text = element.attrib["quat_xyzw"]
    quaternion = pin.Quaternion(_vector(text, f"{where}: quat_xyzw", QUATERNION))
    if quaternion.norm() < TURN:
        raise DataError(f"{where}: quat_xyzw {text!r} is not accepted; accepted: a direction")
    return pos, quaternion.normalized().toRotationMatrix()


def _vector(text: str, where: str, size: int = 3) -> Array:
    words = text.split()
    if len(words) != size:
        accepted = "three numbers" if size == 3 else f"{size} numbers"
        raise DataError(f"{where} {text!r} is not accepted; accepted: {accepted}")
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
