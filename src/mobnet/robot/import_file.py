"""The first element of a robot's file, whatever a stranger put there."""

import xml.etree.ElementTree as ET
from pathlib import Path

from mobnet.core.errors import DataError, not_accepted
from mobnet.core.files import check_regular
from mobnet.robot.import_urdf import expanding

MOST_BYTES = 64 * 2**20  # of a file; the largest of public robots has 1 MB
MOST_LEVELS = 500  # of elements in elements; MJCF nests bodies
KINDS = {"robot": "URDF", "mujoco": "MJCF"}  # first element of a file


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
