"""A robot's table from a URDF or a MJCF file, whatever a stranger put there."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from mobnet.core.errors import DataError, refusal
from mobnet.core.files import stem_of
from mobnet.robot.import_file import read_file
from mobnet.robot.import_links import Imported, import_tree, left_out
from mobnet.robot.import_mjcf import read_mjcf
from mobnet.robot.import_sensors import feet_of, sensors_of
from mobnet.robot.import_tree import FREE
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
    file = read_file(path)
    try:
        tree = read_urdf(file.root, path) if file.kind == "URDF" else read_mjcf(file)
        robot = import_tree(tree, file.kind, stem_of(path), floating, (torque_limit, speed_limit), armature, locked)
        robot.file = file
        robot.notes += _further(robot, floating)
    except DataError as error:
        raise refusal(path, str(error).splitlines()) from None
    return robot


def _further(imported: Imported, asked: bool | None) -> Iterator[str]:
    """Yield what the file tells of the base, sensors and feet, and what it has that a table does not hold."""
    if imported.kind == "URDF" and asked is None:
        kind = "floating" if imported.floating else "fixed"
        yield f"the base is taken as {kind}, which a URDF does not say; --base tells the other"
    if imported.floating:
        imported.imu, notes = sensors_of(imported.tree, imported.parts, imported.bodies)
        yield from notes
        base = imported.tree.links[imported.robot.base]
        if any(joint.armature for joint in base.joints if joint.kind == FREE):
            yield f"armature of the free joint of {base.name or 'the base'}: not taken over; a base has no rotor"
        yield from feet_of(
            base.turn,
            imported.parts,
            imported.bodies,
            imported.groups,
            imported.joints,
        )
    yield from left_out(imported.hinges, imported.tree.chains, has_imu=imported.imu is not None)
