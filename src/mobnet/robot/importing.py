"""A robot's table from a URDF or a MJCF file.

Links that no joint moves are one body with the link that carries them. What the file does not say, what a table cannot
hold and what is changed is told line by line.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from mobnet.core.errors import DataError
from mobnet.core.joints import N_VIRTUAL
from mobnet.robot.import_base import RobotSelection, robot_of
from mobnet.robot.import_file import KINDS, read_root
from mobnet.robot.import_inertia import TOKEN_MASS, Mass, mass_of
from mobnet.robot.import_mjcf import read_mjcf
from mobnet.robot.import_names import limbs, title_of
from mobnet.robot.import_rows import body_rows, joint_rows
from mobnet.robot.import_sensors import feet_of, sensors_of
from mobnet.robot.import_tree import Joint, LinkTree, RigidBody, bodies_of
from mobnet.robot.import_urdf import read_urdf

VIRTUAL = [f"V{k + 1}" for k in range(N_VIRTUAL)]
BASE_LIMB = "V"
MOST_LINKS = 2000  # of a file
MOST_JOINTS = 250  # of a table; the library for robots takes 255
# A base that stands still has no momentum: its mass only has to be some mass
STANDING = Mass(1.0, np.zeros(3), 0.01 * np.eye(3))


@dataclass
class Imported:
    """Rows of a table, and what could not be read or is not taken over.

    Attributes:
        notes: lines for the user.
        tree: the file, of the kind `kind`.
        robot: its links that the table holds.
        masses: those of each body, the base first.
    """

    name: str
    bodies: list[dict[str, Any]]
    joints: list[dict[str, Any]]
    groups: dict[str, list[str]]
    floating: bool
    kind: str
    tree: LinkTree
    robot: RobotSelection
    parts: list[RigidBody]
    masses: list[Mass]
    notes: list[str] = field(default_factory=list)
    imu: dict[str, Any] | None = None

    @property
    def hinges(self) -> list[Joint]:
        """The joints of the table in their order."""
        return [body.joint for body in self.parts if body.joint is not None]


def import_robot(
    path: Path,
    floating: bool | None,
    torque_limit: float,
    speed_limit: float,
    armature: float = 0.0,
    locked: Sequence[str] = (),
) -> Imported:
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
        moved = [row["name"] for row, body in zip(found.bodies, found.parts, strict=True) if body.joint is not None]
        taken = {BASE_LIMB, *VIRTUAL} if found.floating else set[str]()
        found.joints += joint_rows(found.hinges, moved, taken, (torque_limit, speed_limit), found.notes)
        found.groups |= limbs(found.bodies, found.joints)
        found.notes += _further(found, floating)
    except DataError as error:
        raise DataError(f"{path}: {error}") from None
    return found


def _imported(tree: LinkTree, robot: RobotSelection, kind: str, path: Path, armature: float) -> Imported:
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
    for mass in masses:
        notes += mass.notes
    without = [body.name for body, mass in zip(parts, masses, strict=True) if mass.is_token and body.parts]
    if without:
        notes.append(f"no mass in the file: {', '.join(without)}; {TOKEN_MASS:g} kg is taken")
    bodies = body_rows(parts, masses, robot, notes)
    return Imported(
        title_of(tree.name, path.stem), bodies, [], {}, robot.floating, kind, tree, robot, parts, masses, notes
    )


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
