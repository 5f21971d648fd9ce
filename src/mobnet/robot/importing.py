"""A robot's table from a URDF or a MJCF file.

Links that no joint moves are one body with the link that carries them. What the file does not say, what a table cannot
hold and what is changed is told line by line.
"""

import xml.etree.ElementTree as ET
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.files import check_regular
from mobnet.core.joints import N_VIRTUAL
from mobnet.robot.import_base import Robot, robot_of
from mobnet.robot.import_inertia import TOKEN_MASS, Mass, mass_of, six
from mobnet.robot.import_mjcf import read_mjcf
from mobnet.robot.import_names import limbs, renamed, title_of, words_of
from mobnet.robot.import_sensors import feet_of, sensors_of
from mobnet.robot.import_tree import Body, Joint, Tree, bodies_of
from mobnet.robot.import_urdf import expanding, read_urdf
from mobnet.settings.base import MOST_M, MOST_RAD
from mobnet.settings.parts import SPEED_RAD_S, TORQUE_NM

VIRTUAL = [f"V{k + 1}" for k in range(N_VIRTUAL)]
BASE_LIMB = "V"
MOST_BYTES = 64 * 2**20  # of a file; the largest of public robots has 1 MB
MOST_LEVELS = 500  # of elements in elements; MJCF nests bodies
MOST_LINKS = 2000  # of a file
MOST_JOINTS = 250  # of a table; the library for robots takes 255
# A base that stands still has no momentum: its mass only has to be some mass
STANDING = Mass(1.0, np.zeros(3), 0.01 * np.eye(3))
KINDS = {"robot": "URDF", "mujoco": "MJCF"}  # first element of a file


@dataclass
class Imported:
    """Rows of a table, and what could not be read or is not taken over.

    Attributes:
        notes: lines for the user.
        tree: the file, of the kind `kind`.
        robot: its links that the table holds.
        masses: those of each body, the base first.
        hinges: the joints of the table in their order.
    """

    name: str
    bodies: list[dict[str, Any]]
    joints: list[dict[str, Any]]
    groups: dict[str, list[str]]
    floating: bool
    kind: str
    tree: Tree
    robot: Robot
    parts: list[Body]
    masses: list[Mass]
    notes: list[str] = field(default_factory=list)
    imu: dict[str, Any] | None = None

    @property
    def hinges(self) -> list[Joint]:
        """Joints in the order of the table."""
        return [body.joint for body in self.parts if body.joint is not None]


def import_robot(
    path: Path, floating: bool | None, torque_limit: float, speed_limit: float, armature: float = 0.0,
    locked: Sequence[str] = (),
) -> Imported:  # fmt: skip
    """Read a robot from a URDF or a MJCF file.

    Whether the base floats follows from the file if it is not said. Limits [N m], [rad/s] and rotor inertia [kg m^2]
    are used for joints of which the file says none; `locked` joints, JOINT=ANGLE [rad], are welded.

    Raises:
        DataError: the file is no robot, or no joint of it turns.
    """
    root = read_root(path)
    try:
        tree = read_urdf(root, path) if KINDS[root.tag] == "URDF" else read_mjcf(path)
        if len(tree.links) > MOST_LINKS:
            raise DataError(f"{len(tree.links)} links are not accepted; accepted: at most {MOST_LINKS}")
        found = _imported(tree, robot_of(tree, floating, locked), KINDS[root.tag], path, armature)
        found.joints += _joints(found, torque_limit, speed_limit)
        found.groups |= limbs(found.bodies, found.joints)
        found.notes += _further(found, floating)
    except DataError as error:
        raise DataError(f"{path}: {error}") from None
    return found


def read_root(path: Path) -> ET.Element:
    """Return the first element of a robot's file, in the encoding that it declares.

    Raises:
        DataError: it is missing, cannot be read, is no XML, or no robot.
    """
    check_regular(path)
    try:
        with path.open("rb") as file:
            content = file.read(MOST_BYTES + 1)
    except OSError as error:
        raise DataError(f"{path}: cannot be read: {error.strerror}; accepted: a URDF or MJCF file") from None
    if len(content) > MOST_BYTES:
        raise DataError(f"{path}: more than {MOST_BYTES // 2**20} MiB are not accepted; accepted: a URDF or MJCF file")
    try:
        root = _parsed(content)
    except (ValueError, LookupError, ET.ParseError) as error:
        made = f"a URDF, made by: {expanding(path)}" if b"<xacro:" in content else "a URDF or MJCF file"
        raise DataError(f"{path}: {error}; accepted: {made}") from None
    if root.tag not in KINDS:
        accepted = [f"{kind} ({tag})" for tag, kind in KINDS.items()]
        raise DataError(not_accepted(f"{path}: first element", root.tag, accepted))
    return root


def _parsed(content: bytes) -> ET.Element:
    """Return the first element; a file that nests elements without end would end the process elsewhere."""
    parser, depth = ET.XMLPullParser(("start", "end")), 0
    for start in range(0, len(content), 2**16):
        parser.feed(content[start : start + 2**16])
        for event in parser.read_events():
            depth += 1 if event[0] == "start" else -1
            if depth > MOST_LEVELS:
                raise ValueError(f"more than {MOST_LEVELS} elements in each other are not accepted")
    parser.close()
    return ET.fromstring(content)


def _imported(tree: Tree, robot: Robot, kind: str, path: Path, armature: float) -> Imported:
    """Return a robot with its bodies, and with rotors of all joints."""
    parts = bodies_of(tree, robot.base, robot.kept, robot.held)
    hinges = [body.joint for body in parts if body.joint is not None]
    if not hinges:
        raise DataError("no hinge that moves a mass; accepted: a robot whose joints turn")
    if len(hinges) > MOST_JOINTS:
        raise DataError(f"{len(hinges)} hinges are not accepted; accepted: at most {MOST_JOINTS}; --lock welds a joint")
    masses = [mass_of(body, tree.links) for body in parts]
    if robot.floating and masses[0].is_token:
        raise DataError(f"a base that floats without mass, {parts[0].name}, is not accepted; accepted: --base fixed")
    if not robot.floating:
        masses[0] = STANDING
    notes = [*tree.notes, *robot.notes, *_set_armature(hinges, armature)]
    notes += [note for mass in masses for note in mass.notes]
    without = [body.name for body, mass in zip(parts, masses, strict=True) if mass.is_token and body.parts]
    if without:
        notes.append(f"no mass in the file: {', '.join(without)}; {TOKEN_MASS:g} kg is taken, which changes no torque")
    bodies = _bodies(parts, masses, robot, notes)
    return Imported(
        title_of(tree.name, path.stem), bodies, [], {}, robot.floating, kind, tree, robot, parts, masses, notes
    )


def _bodies(parts: Sequence[Body], masses: Sequence[Mass], robot: Robot, notes: list[str]) -> list[dict[str, Any]]:
    """Return the rows of bodies, and note names that differ from those of the file."""
    own = [body.name for body in parts]
    if not robot.floating:
        own[0] = "base"
    words = words_of(own, "body", {"world"})
    first = 0 if robot.floating else 1
    notes += renamed(own[first:], words[first:], "bodies")
    shift = _shift(parts, robot, notes)
    rows = []
    for k, (body, mass) in enumerate(zip(parts, masses, strict=True)):
        parent = "world" if k == 0 else words[body.parent]
        pos = body.pos - shift if k and body.parent == 0 else body.pos
        rows.append(_row(words[k], parent, pos, body.turn, mass))
    return rows


def _shift(parts: Sequence[Body], robot: Robot, notes: list[str]) -> Array:
    """Return the place from which a base that stands still counts [m], and note it where it is not the world's."""
    places = [body.pos for body in parts[1:] if body.parent == 0]
    if robot.floating or np.abs(places).max() <= MOST_M:
        return np.zeros(3)
    told = ", ".join(f"{value:g}" for value in places[0])
    notes.append(f"the robot stands at [{told}] m in the file; the table counts places from there")
    return places[0]


def _row(name: str, parent: str, pos: Array, turn: Array, mass: Mass) -> dict[str, Any]:
    """Return the row of a body, in SI units."""
    quat = pin.Quaternion(turn).normalized().coeffs()[[3, 0, 1, 2]]
    lists = {"pos": pos, "quat": quat, "com": mass.com, "inertia": six(mass.inertia)}
    listed = {key: [float(x) + 0.0 for x in value] for key, value in lists.items()}  # no -0.0
    return {"name": name, "parent": parent, **listed, "mass": float(mass.mass)}


def _joints(found: Imported, torque_limit: float, speed_limit: float) -> Iterator[dict[str, Any]]:
    """Yield the rows of hinges in their order, and note of which the file says no limit that a table takes."""
    names = [joint.name for joint in found.hinges]
    words = words_of(names, "joint", {BASE_LIMB, *VIRTUAL} if found.floating else set())
    found.notes += renamed(names, words, "joints")
    bodies = [row["name"] for row, body in zip(found.bodies, found.parts, strict=True) if body.joint is not None]
    unlimited: dict[str, list[str]] = {"range": [], "torque": [], "speed": []}
    for joint, word, body in zip(found.hinges, words, bodies, strict=True):
        low, high = _range(joint)
        torque, speed = _within(joint.torque, TORQUE_NM), _within(joint.speed, SPEED_RAD_S)
        unlimited["range"] += [word] if (low, high) != joint.range else []
        unlimited["torque"] += [] if torque else [word]
        unlimited["speed"] += [] if speed else [word]
        yield {
            "id": word, **({"name": joint.name} if joint.name else {}), "body": body,
            "axis": [float(x) + 0.0 for x in joint.axis], "range": [low, high],
            "torque_limit": torque or torque_limit, "armature": joint.armature, "velocity_limit": speed or speed_limit,
        }  # fmt: skip
    taken = {"range": f"{MOST_RAD} rad", "torque": f"{torque_limit:g} N m", "speed": f"{speed_limit:g} rad/s"}
    for kind, without in unlimited.items():
        if without:
            beyond = _beyond(kind, found.hinges)
            found.notes.append(f"{kind} of {', '.join(without)}: not in the file{beyond}, {taken[kind]} is taken")


def _range(joint: Joint) -> tuple[float, float]:
    """Return the range of a joint [rad] as a table takes it, two turns to each side where there is none."""
    if joint.range is None:
        return -MOST_RAD, MOST_RAD
    low, high = max(joint.range[0], -MOST_RAD), min(joint.range[1], MOST_RAD)
    return (low, high) if low < high else (-MOST_RAD, MOST_RAD)


def _within(value: float | None, bounds: tuple[float, float]) -> float | None:
    """Return a limit, or None for one that means that there is none."""
    return value if value is not None and bounds[0] <= value <= bounds[1] else None


def _beyond(kind: str, joints: Sequence[Joint]) -> str:
    """Return what is said where some joint has a limit, but none that a table takes."""
    if kind == "range":
        beyond = [joint.range for joint in joints if joint.range not in (None, _range(joint))]
        return f" or wider than {MOST_RAD} rad" if beyond else ""
    values = [joint.torque if kind == "torque" else joint.speed for joint in joints]
    low, high = TORQUE_NM if kind == "torque" else SPEED_RAD_S
    return f" or not within {low} to {high}" if any(value and not low <= value <= high for value in values) else ""


def _set_armature(joints: Sequence[Joint], armature: float) -> Iterator[str]:
    """Give joints without a rotor inertia another one [kg m^2], and yield what was done."""
    without = [joint for joint in joints if joint.armature == 0.0]
    for joint in without:
        joint.armature = armature
    if armature and without:
        which = "all joints" if len(without) == len(joints) else f"{len(without)} of {len(joints)} joints"
        yield f"armature of {which}: not in the file, {armature:g} kg m^2 is taken"


def _further(found: Imported, asked: bool | None) -> Iterator[str]:
    """Yield what the file tells of the base, sensors and feet, and what it has that a table does not hold."""
    if found.kind == "URDF" and asked is None:
        base = "floating" if found.floating else "fixed"
        yield f"the base is taken as {base}, which a URDF does not say; --base tells the other"
    if found.floating:
        found.imu, notes = sensors_of(found.tree, found.parts, found.bodies)
        yield from notes
        yield from feet_of(
            found.tree.links[found.robot.base].turn, found.parts, found.bodies, found.groups, found.joints
        )
    yield from _left_out(found.hinges, found.tree.chains, has_imu=found.imu is not None)


def _left_out(joints: Sequence[Joint], chains: int, *, has_imu: bool) -> Iterator[str]:
    """Yield what the file has and a table does not hold."""
    lost = {"damping": any(joint.damping for joint in joints), "dry friction": any(joint.friction for joint in joints)}
    for name, is_there in lost.items():
        if is_there:
            yield f"{name} of joints: not taken over; networks learn it"
    if not any(joint.armature for joint in joints):
        yield "armature: zero for all joints; add the rotors' inertia, reflected to the joints, where gears are high"
    if chains:
        yield f"{chains} equality constraints (closed chains): not taken over"
    passive = [joint.name or f"joint {joint.index}" for joint in joints if not joint.has_motor]
    if passive:
        yield f"no motor in the file: {', '.join(passive)}; --lock welds what a log does not have"
    rest = ["feet", "sole", *([] if has_imu else ["imu"]), "leg", "hands", "posture", "shapes", "points"]
    yield f"{', '.join(rest)}: not in the file; docs/robots.md says what needs them"


def check_base(word: str | None) -> bool | None:
    """Return whether the base floats, by what a user said; None where nothing was said.

    Raises:
        DataError: it is neither of the two.
    """
    kinds = {None: None, "floating": True, "fixed": False}
    if word not in kinds:
        raise DataError(not_accepted("--base", word, ["fixed", "floating"]))
    return kinds[word]
