"""The entries of a robot's table from its links, those of a file or of a model that a program holds.

Links that no joint moves are one body with the link that carries them. What the links do not say, what a table cannot
hold and what is changed is told line by line.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain
from typing import Any

import numpy as np

from mobnet.core.errors import DataError, refuse_lines
from mobnet.core.joints import N_VIRTUAL
from mobnet.robot.import_base import RobotSelection, robot_of
from mobnet.robot.import_file import RobotFile
from mobnet.robot.import_inertia import TOKEN_MASS, Mass, faults_of, mass_of
from mobnet.robot.import_names import limbs, title_of
from mobnet.robot.import_rows import body_rows, joint_rows
from mobnet.robot.import_tree import Joint, LinkTree, RigidBody, bodies_of

VIRTUAL = [f"V{k + 1}" for k in range(N_VIRTUAL)]
BASE_LIMB = "V"
MOST_LINKS = 2000  # of a file
MOST_SHOWN = 5  # names of links in a line
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
        file: where it was read from; None for a model that a program holds.
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
    file: RobotFile | None = None

    @property
    def hinges(self) -> list[Joint]:
        """The joints of the table in their order."""
        return [body.joint for body in self.parts if body.joint is not None]


def import_tree(
    tree: LinkTree,
    kind: str,
    otherwise: str,
    floating: bool | None,
    limits: tuple[float, float],
    armature: float,
    locked: Sequence[str] = (),
) -> Imported:
    """Return the robot of links as `import_robot` does; `otherwise` is its name where the links have none.

    Raises:
        DataError: a table cannot hold the robot, or no joint of it turns.
    """
    if len(tree.links) > MOST_LINKS:
        raise DataError(f"{len(tree.links)} links are not accepted; accepted: at most {MOST_LINKS}")
    robot = _with_bodies(tree, robot_of(tree, floating, locked), kind, otherwise, armature)
    moved = [row["name"] for row, body in zip(robot.bodies, robot.parts, strict=True) if body.joint is not None]
    taken = {BASE_LIMB, *VIRTUAL} if robot.floating else set[str]()
    robot.joints += joint_rows(robot.hinges, moved, taken, limits, robot.notes)
    robot.groups |= limbs(robot.bodies, robot.joints)
    return robot


def values_of(robot: Imported) -> dict[str, Any]:
    """Return the entries of a robot's table."""
    virtual = {"virtual": VIRTUAL} if robot.floating else {}
    base_limb = {BASE_LIMB: VIRTUAL} if robot.floating else {}
    imu = {"imu": robot.imu} if robot.imu else {}
    return {
        "name": robot.name,
        "base": "floating" if robot.floating else "fixed",
        **imu,
        "order": {**virtual, "actuated": [row["id"] for row in robot.joints]},
        "groups": {**base_limb, **robot.groups},
        "networks": {name: {"joints": [name], "Q": [name], "T": []} for name in robot.groups},
        "joints": robot.joints,
        "bodies": robot.bodies,
    }


def _with_bodies(tree: LinkTree, robot: RobotSelection, kind: str, otherwise: str, armature: float) -> Imported:
    """Return a robot with its bodies, and with rotors of all joints."""
    parts = bodies_of(tree, robot.base, robot.kept, robot.held)
    hinges = [body.joint for body in parts if body.joint is not None]
    if not hinges:
        raise DataError(_without_hinges(robot.idle))
    if len(hinges) > MOST_JOINTS:
        raise DataError(f"{len(hinges)} hinges are not accepted; accepted: at most {MOST_JOINTS}; --lock welds a joint")
    masses = [mass_of(body, tree.links) for body in parts]
    if robot.floating and masses[0].is_token:
        raise DataError(f"a base that floats without mass, {parts[0].name}, is not accepted; accepted: --base fixed")
    if not robot.floating:
        masses[0] = STANDING
    refuse_lines(
        chain.from_iterable(faults_of(body, mass, tree.links) for body, mass in zip(parts, masses, strict=True))
    )
    notes = [*tree.notes, *robot.notes, *_set_armature(hinges, armature)]
    for mass in masses:
        notes += mass.notes
    without = [body.name for body, mass in zip(parts, masses, strict=True) if mass.is_token and body.parts]
    if without:
        notes.append(f"no mass in the file: {', '.join(without)}; {TOKEN_MASS:g} kg is taken")
    bodies = body_rows(parts, masses, robot, notes)
    return Imported(
        title_of(tree.name, otherwise), bodies, [], {}, robot.floating, kind, tree, robot, parts, masses, notes
    )


def _without_hinges(idle: Sequence[str]) -> str:
    """Return why no joint of a robot turns; links whose hinges move no mass show that the file lacks masses."""
    if not idle:
        return "no hinge that moves a mass; accepted: a robot whose joints turn"
    names = ", ".join(name or "one without a name" for name in idle[:MOST_SHOWN])
    names += ", ..." if len(idle) > MOST_SHOWN else ""
    what = f"no hinge that moves a mass: no <inertial> with a mass in any link that a hinge moves ({names})"
    return f"{what}; accepted: mass and inertia of each link, from the robot's maker or its CAD model"


def _set_armature(joints: Sequence[Joint], armature: float) -> Iterator[str]:
    """Give joints without a rotor inertia another one [kg m^2], and yield what was done."""
    without = [joint for joint in joints if joint.armature == 0.0]
    for joint in without:
        joint.armature = armature
    if armature and without:
        which = "all joints" if len(without) == len(joints) else f"{len(without)} of {len(joints)} joints"
        yield f"armature of {which}: not in the file, {armature:g} kg m^2 is taken"


def left_out(joints: Sequence[Joint], chains: int, *, has_imu: bool) -> Iterator[str]:
    """Yield what the file has and a table does not hold."""
    lost = {
        "damping": any(joint.damping for joint in joints),
        "dry friction": any(joint.friction for joint in joints),
        "springs (stiffness)": any(joint.stiffness for joint in joints),
    }
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
