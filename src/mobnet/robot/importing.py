"""A robot's table from a URDF or a MJCF file."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from mobnet.core.errors import DataError
from mobnet.robot.import_file import KINDS, read_root
from mobnet.robot.import_links import Imported, import_tree, left_out
from mobnet.robot.import_mjcf import read_mjcf
from mobnet.robot.import_sensors import feet_of, sensors_of
from mobnet.robot.import_urdf import read_urdf


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
    kind = KINDS[root.tag]
    try:
        tree = read_urdf(root, path) if kind == "URDF" else read_mjcf(path)
        robot = import_tree(tree, kind, path.stem, floating, (torque_limit, speed_limit), armature, locked)
        robot.notes += _further(robot, floating)
    except DataError as error:
        raise DataError(f"{path}: {error}") from None
    return robot


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
    yield from left_out(found.hinges, found.tree.chains, has_imu=found.imu is not None)
