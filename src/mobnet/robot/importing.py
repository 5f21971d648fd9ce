"""A robot's table from a URDF or a MJCF file, whatever a stranger put there."""

import xml.etree.ElementTree as ET
from collections.abc import Iterator, Sequence
from pathlib import Path

from mobnet.core.errors import DataError, not_accepted
from mobnet.core.files import check_regular
from mobnet.robot.import_links import Imported, import_tree, left_out
from mobnet.robot.import_mjcf import read_mjcf
from mobnet.robot.import_sensors import feet_of, sensors_of
from mobnet.robot.import_urdf import expanding, read_urdf

MOST_BYTES = 64 * 2**20  # of a file; the largest of public robots has 1 MB
MOST_LEVELS = 500  # of elements in elements; MJCF nests bodies
KINDS = {"robot": "URDF", "mujoco": "MJCF"}  # first element of a file


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


def _further(imported: Imported, asked: bool | None) -> Iterator[str]:
    """Yield what the file tells of the base, sensors and feet, and what it has that a table does not hold."""
    if imported.kind == "URDF" and asked is None:
        base = "floating" if imported.floating else "fixed"
        yield f"the base is taken as {base}, which a URDF does not say; --base tells the other"
    if imported.floating:
        imported.imu, notes = sensors_of(imported.tree, imported.parts, imported.bodies)
        yield from notes
        yield from feet_of(
            imported.tree.links[imported.robot.base].turn,
            imported.parts,
            imported.bodies,
            imported.groups,
            imported.joints,
        )
    yield from left_out(imported.hinges, imported.tree.chains, has_imu=imported.imu is not None)


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
    parser = ET.XMLPullParser(("start", "end"))
    depth = 0
    for start in range(0, len(content), 2**16):
        parser.feed(content[start : start + 2**16])
        for event in parser.read_events():
            depth += 1 if event[0] == "start" else -1
            if depth > MOST_LEVELS:
                raise ValueError(f"more than {MOST_LEVELS} elements in each other are not accepted")
    parser.close()
    return ET.fromstring(content)
