"""A robot's table from a URDF or MJCF file: `./reproduce robot FILE` (docs/robots.md)."""

import logging
import re
import sys
import tempfile
from argparse import Namespace
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from mobnet.core.child import in_child
from mobnet.core.errors import ConfigError, DataError, refusal
from mobnet.core.files import write_text
from mobnet.core.options import import_parser
from mobnet.core.place import command
from mobnet.core.printed import printed
from mobnet.core.word_checks import check_robot, floats, imported_table
from mobnet.formats.loading import load_section
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import RobotDescription, describe
from mobnet.robot.import_checks import differences
from mobnet.robot.import_file import content_of
from mobnet.robot.import_links import Imported, values_of
from mobnet.robot.importing import import_robot
from mobnet.robot.limit_words import check_limits
from mobnet.robot.table_file import flow

log = logging.getLogger(__name__)
BY_NAME = ("order", "groups", "networks")  # entries of a table with a line for each name
EQUAL = 1e-6  # by which a table may differ from another reading of its file
NOTE = "note: "  # how a printed line of what the file lacks begins
SECONDS = 60.0  # that reading a file may take; that of 1 MB takes 2 s


def table_text(imported: Imported, source: str) -> str:
    """Return the YAML of a table: a line for each body and each joint."""
    values = values_of(imported)
    lines = [
        f"# {_line(imported.name)}: from {_line(source)}, by {command('robot')}. SI units; quaternions w x y z.",
        "# inertia: [xx, yy, zz, xy, xz, yz] about the centre of mass, in body axes.",
        *(f"# {_line(note)}" for note in imported.notes),
    ]
    for key, value in values.items():
        if key in BY_NAME:
            lines += [f"{key}:", *(f"  {flow(name)}: {flow(entry)}" for name, entry in value.items())]
        elif isinstance(value, list):
            lines += [f"{key}:", *(f"  - {flow(row)}" for row in value)]
        else:
            lines.append(f"{key}: {flow(value)}")
    return "\n".join(lines) + "\n"


def _line(text: str) -> str:
    """Return a text on one line: names in a file may hold line breaks, which would end a comment."""
    return " ".join(text.split())


def robot_of_text(text: str, source: Path, imported: Imported | None = None) -> RobotDescription:
    """Return the robot of a table's text as `table_of_text` does its table."""
    return describe(table_of_text(text, source, imported))


def table_of_text(text: str, source: Path, imported: Imported | None = None) -> RobotTable:
    """Return the table of a text, which is written nowhere before it is right.

    Args:
        text: YAML.
        source: the file that it was made of.
        imported: what was read of it; its rows are then named as there.

    Raises:
        DataError: the table is not accepted; the lines name the file that it was made of.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "table.yaml"
        path.write_text(text, encoding="utf-8")
        try:
            return load_section(path, RobotTable)
        except ConfigError as error:
            lines = [_without(line, path) for line in str(error).splitlines()]
            raise refusal(source, (_named(line, imported) for line in lines)) from None


def _without(line: str, path: Path) -> str:
    """Return a fault without the name of a file that is gone."""
    return re.sub(rf"^{re.escape(str(path))}(:\d+)?: ", "", line)


def _named(line: str, imported: Imported | None) -> str:
    """Return a fault with the name of the link or the joint in place of its number."""
    row = re.match(r"(bodies|joints)\.(\d+)\.", line)
    if row is None or imported is None:
        return line
    rows = imported.bodies if row[1] == "bodies" else imported.joints
    names = rows[int(row[2])]
    kind, name = ("link", names["name"]) if row[1] == "bodies" else ("joint", names["id"])
    return f"{kind} {name}: {line[row.end() :]}"


def made(options: Namespace) -> tuple[str, list[str]]:
    """Return the text of a table as the command's options say, checked, and what is printed about it.

    Raises:
        DataError: the file is no robot, a table cannot hold it, or the table differs from another reading of the file.
    """
    taken = options.torque_limit, options.speed_limit, options.armature, options.lock
    imported = import_robot(options.file, floats(options.base), *taken)
    text = table_text(imported, options.file.name)
    return text, list(report_lines(robot_of_text(text, options.file, imported), imported, options.file))


def read_robot(path: Path) -> RobotDescription:
    """Return the robot of a URDF or MJCF file, as the command makes a table of it without further words.

    Raises:
        DataError: the file is no robot, a table cannot hold it, or the table differs from another reading of the file.
    """
    table, notes = read_table(path)
    return replace(describe(table), notes=notes)


def read_table(path: Path) -> tuple[RobotTable, tuple[str, ...]]:
    """Return the table of a URDF or MJCF file, and what is changed, missing or not held by it, as `read_robot` does."""
    options = import_parser().parse_args(["--", str(path)])
    text, lines = _made_in_child(options)
    notes = tuple(line.removeprefix(NOTE) for line in lines if line.startswith(NOTE))
    return table_of_text(text, path), notes


def _made_in_child(options: Namespace) -> tuple[str, list[str]]:
    """Return what `made` does, from a process of its own."""
    content_of(options.file)  # here, as this process looks at a pipe again, and what a child keeps of it is lost
    return in_child(lambda: made(options), SECONDS, str(options.file))


def run(options: Namespace) -> Iterator[str]:
    """Write a table as the command's options say, and yield what is printed."""
    check_robot(options)
    check_limits(options)
    out = imported_table(options)
    text, lines = _made_in_child(options)
    write_text(out, text)
    yield from lines
    yield f"written: {out}"


def main(words: list[str]) -> int:
    """Run the command; return its exit status."""
    options = import_parser().parse_args(words)
    return printed(log, lambda: run(options))


def report_lines(robot: RobotDescription, imported: Imported, path: Path) -> Iterator[str]:
    """Yield what the command prints.

    Raises:
        DataError: the table differs from another reading of the file.
    """
    kind = "floating" if robot.floating else "fixed"
    notes = list[str]()
    compared = list(differences(robot, imported, notes))
    for reading, *apart in compared:
        if not max(apart) <= EQUAL:
            text = f"the table differs from {reading}'s own reading by {max(apart):.1e} of the largest entries"
            raise DataError(
                f"{path}: {text}; accepted: at most {EQUAL:g}; this is a fault of the command, please report it"
            )
    yield f"{robot.name}: {robot.layout.nu} joints, {len(robot.bodies)} bodies, {robot.mass:.6g} kg, {kind} base"
    yield from (f"limb {name}: {', '.join(joints)}" for name, joints in imported.groups.items())
    yield from (f"{NOTE}{_line(note)}" for note in [*imported.notes, *notes])
    changed = ", with these changes" if any(mass.is_changed for mass in imported.masses) else ""
    for reading, inertia, terms in compared:
        apart = f"mass matrix {inertia:.1e}, bias {terms:.1e} of their largest entries"
        yield f"against {reading}'s own reading{changed}: {apart}"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
