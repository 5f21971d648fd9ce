"""The file of a robot: what it holds, read once, and its elements as the libraries of URDF and MJCF take XML.

They know no namespaces: a prefix is a part of a name, and `xmlns` an attribute. Comments may hold hyphens, and the
declaration may stand behind blanks or comments.
"""

import codecs
import gzip
import io
import os
import re
import shlex
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any
from xml.parsers import expat

from mobnet.core.errors import DataError, not_accepted
from mobnet.core.files import check_regular, descriptor_of

MOST_BYTES = 64 * 2**20  # of a file; the largest of public robots has 1 MB
MOST_LEVELS = 500  # of elements in elements; MJCF nests bodies
KINDS = {"robot": "URDF", "mujoco": "MJCF"}  # first element of a file
PACKED = b"\x1f\x8b"  # how a file of gzip begins
MARKS = {codecs.BOM_UTF8: "utf-8-sig", codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}
ENCODING = re.compile(rb"<\?xml\s[^>]*?encoding\s*=\s*[\"']([^\"']*)")
COMMENT = re.compile("<!--.*?-->", re.DOTALL)
DECLARATION = re.compile(r"\s*<\?xml\s.*?\?>", re.DOTALL)
LONGEST = 40  # characters that are shown of what stands before the first element


@dataclass(frozen=True)
class RobotFile:
    """The file of a robot.

    Attributes:
        path: as a user names it.
        kind: URDF or MJCF.
        text: its XML without declaration and comments.
        root: its first element.
        is_stored: whether its library can read it by its path, and with it the files that it names.
    """

    path: Path
    kind: str
    text: str
    root: ET.Element
    is_stored: bool


def read_file(path: Path) -> RobotFile:
    """Return the file of a robot, in the encoding that it declares.

    Raises:
        DataError: it is missing, cannot be read, is no XML, or no robot.
    """
    content = content_of(path)
    is_stored = descriptor_of(path) is None and not content.startswith(PACKED)
    try:
        text = _cleaned(_unpacked(content))
    except (ValueError, LookupError, OSError, EOFError) as error:
        raise DataError(f"{path}: {error}; accepted: a URDF or MJCF file") from None
    try:
        root = _elements(text)
    except (ValueError, expat.ExpatError) as error:
        made = f"a URDF, made by: {expanding(path)}" if "<xacro:" in text else "a URDF or MJCF file"
        raise DataError(f"{path}: {error}; accepted: {made}") from None
    if root.tag not in KINDS:
        accepted = [f"{kind} ({tag})" for tag, kind in KINDS.items()]
        raise DataError(not_accepted(f"{path}: first element", root.tag, accepted))
    return RobotFile(path, KINDS[root.tag], text, root, is_stored)


def content_of(path: Path) -> bytes:
    """Return what a file holds; of standard input and of a pipe that a shell opened, what they held the first time.

    Raises:
        DataError: it is missing, too large or cannot be read.
    """
    descriptor = descriptor_of(path)
    if descriptor is None:
        check_regular(path)
    try:
        if descriptor is None:
            with path.open("rb") as file:
                content = file.read(MOST_BYTES + 1)
        elif os.isatty(descriptor):
            raise DataError(f"{path}: a terminal is not accepted; accepted: a URDF or MJCF file, or a pipe with one")
        else:
            state = os.fstat(descriptor)
            content = _drained(descriptor, state.st_dev, state.st_ino)
    except OSError as error:
        raise DataError(f"{path}: cannot be read: {error.strerror}; accepted: a URDF or MJCF file") from None
    if len(content) > MOST_BYTES:
        raise DataError(f"{path}: more than {MOST_BYTES // 2**20} MiB are not accepted; accepted: a URDF or MJCF file")
    return content


@cache
def _drained(descriptor: int, _device: int, _inode: int) -> bytes:
    """Return what a pipe holds: it can be read once, and a command looks at its robot before it runs and then again."""
    with open(descriptor, "rb", closefd=False) as file:
        return file.read(MOST_BYTES + 1)


def _unpacked(content: bytes) -> bytes:
    """Return a content that may be one of gzip."""
    if not content.startswith(PACKED):
        return content
    with gzip.open(io.BytesIO(content)) as file:
        unpacked = file.read(MOST_BYTES + 1)
    if len(unpacked) > MOST_BYTES:
        raise ValueError(f"more than {MOST_BYTES // 2**20} MiB are not accepted")
    return unpacked


def _cleaned(content: bytes) -> str:
    """Return the text of a file without declaration and comments; each line keeps its number."""
    text = COMMENT.sub(_line_breaks, _decoded(content))
    text = DECLARATION.sub(_line_breaks, text, count=1) if DECLARATION.match(text) else text
    before = text.partition("<")[0].strip()
    if before:
        shown = before.splitlines()[0][:LONGEST]
        raise ValueError(f"text before the first element, {shown!r}, is not accepted")
    return text


def _line_breaks(part: re.Match[str]) -> str:
    """Return the line breaks of a part that is taken out."""
    return "\n" * part[0].count("\n")


def _decoded(content: bytes) -> str:
    """Return the text of bytes in the encoding that they declare, else in UTF-8, or in Latin-1 where they are none."""
    for mark, encoding in MARKS.items():
        if content.startswith(mark):
            return content.decode(encoding)
    if declared := ENCODING.search(content):
        encoding = declared[1].decode("ascii", "replace")
        if codecs.lookup(encoding).name != "utf-8":
            return content.decode(encoding)
    try:
        return content.decode()
    except UnicodeDecodeError:
        return content.decode("latin-1")


def _elements(text: str) -> ET.Element:
    """Return the first element of XML with all below it; names keep their prefixes."""
    builder = ET.TreeBuilder()
    depth = 0

    def start(tag: str, attributes: dict[str, Any]) -> None:
        nonlocal depth
        depth = depth + 1
        if depth > MOST_LEVELS:  # elements without end in each other would end the process elsewhere
            raise ValueError(f"more than {MOST_LEVELS} elements in each other are not accepted")
        builder.start(tag, attributes)

    def end(tag: str) -> None:
        nonlocal depth
        depth = depth - 1
        builder.end(tag)

    parser = expat.ParserCreate()
    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.Parse(text, True)
    return builder.close()


def expanding(path: Path) -> str:
    """Return the command that makes a URDF from xacro."""
    plain = path.name.removesuffix(".xacro").removesuffix(".urdf")
    made = plain if path.suffix == ".xacro" else f"{plain}_expanded"
    return f"xacro {shlex.quote(str(path))} > {shlex.quote(made)}.urdf"
