"""What is wrong with the words of a lab's command, as far as the configuration and the files that they name tell.

It imports nothing that starts slowly, and `mobnet.commands` asks it before it imports what a command needs.
"""

from argparse import Namespace
from collections.abc import Collection
from pathlib import Path

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.formats.limb_thresholds import LimbThresholds
from mobnet.formats.loading import load_section
from mobnet.formats.log_map import LogMap
from mobnet.robot.description import RobotDescription
from mobnet.robot.given import given_robot
from mobnet.robot.limit_words import check_limits
from mobnet.settings.lab import load_lab


def check_named(options: Namespace) -> None:
    """Check the configuration, the robot's table and other files of settings, and what of them the words name.

    Raises:
        ConfigError: a file, or a limb, a point or a body in the words, is not accepted.
        DataError: a number that a table is to get is not accepted.
    """
    given = vars(options)
    if "torque_limit" in given:
        check_limits(options)
    if "robot" not in given:  # it takes nothing of the configuration
        return
    robot = given_robot(options.robot, load_lab().robot)
    if given.get("map"):
        load_section(options.map, LogMap)
    # A network or recordings say which limb is meant where the words do not.
    if "limb" in given and (options.limb or not (given.get("network") or given.get("recording"))):
        limb_named(robot.layout, options.limb)
    if given.get("payload"):
        carrier_named(robot, options.payload)
    for path in _listed(given.get("thresholds")):
        load_section(path, LimbThresholds)
    for name in given.get("wrench", ()):
        point_named(robot, name)


def limb_named(layout: JointLayout, given: str | None) -> str:
    """Return the limb that is given, or the robot's only one.

    Raises:
        ConfigError: there is none.
    """
    limbs = [name for name, joints in layout.groups.items() if not set(joints) & set(layout.virtual)]
    limb = given or (limbs[0] if len(limbs) == 1 else None)
    if limb is None or limb not in layout.groups:
        raise ConfigError(not_accepted("--limb", limb or "nothing", layout.groups))
    return limb


def carrier_named(robot: RobotDescription, body: str) -> int:
    """Return the number of the joint that moves a body.

    Raises:
        ConfigError: none does.
    """
    moved = [joint.body for joint in robot.joints]
    if body not in moved:
        raise ConfigError(not_accepted("--payload", body, moved))
    return moved.index(body)


def point_named(
    robot: RobotDescription, name: str, joints: Collection[str] | None = None
) -> tuple[str, tuple[float, float, float], str]:
    """Return body, place in it [m] and carrying joint of a point of the table, or of the origin of a body, by name.

    Joints are those of the limb that carries it; other ones may be given.

    Raises:
        ConfigError: there is no such point or body, or none of the joints moves it.
    """
    known = {body.name: (body.name, (0.0, 0.0, 0.0)) for body in robot.bodies}
    known |= {point.name: (point.body, point.pos) for point in robot.points}
    if name not in known:
        points = [point.name for point in robot.points]
        raise ConfigError(not_accepted("--wrench", name, [*points, *(body.name for body in robot.bodies)]))
    body, pos = known[name]
    carrier = carrying_joint(robot, body)
    moving = joints or robot.layout.limb_of
    if carrier is None or carrier not in moving:
        moved = [row.name for row in robot.bodies if carrying_joint(robot, row.name) in moving]
        raise ConfigError(not_accepted("--wrench, what joints of the limb move", name, moved))
    return body, pos, carrier


def carrying_joint(robot: RobotDescription, body: str) -> str | None:
    """Return the joint that carries a body, or None for the base and what is welded to it."""
    parents = {row.name: row.parent for row in robot.bodies}
    while (joint := robot.joint_of(body)) is None and body != robot.base:
        body = parents[body]
    return joint.id if joint else None


def _listed(paths: Path | list[Path] | None) -> list[Path]:
    """Return the paths of a word that may be given once, or several times."""
    if paths is None:
        return []
    return paths if isinstance(paths, list) else [paths]
