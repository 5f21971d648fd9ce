"""A robot's table as a file: a line for each entry, with the comments that its source begins with."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from mobnet.core.files import write_text
from mobnet.core.flow import flow
from mobnet.settings.robot import RobotTable


def write_table(path: Path, table: RobotTable, head: Sequence[str]) -> None:
    """Write a table below comments, each of which is a line without its `#`; what is not given is left out."""
    values = table.model_dump(mode="json", exclude_unset=True, exclude_none=True)
    lines = [*(f"# {line}".rstrip() for line in head), *_lines(values)]
    write_text(path, "\n".join(lines) + "\n")


def head_of(path: Path) -> list[str]:
    """Return the comments at the beginning of a table's file, without their `#`."""
    found = list[str]()
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        found.append(line.removeprefix("#").strip())
    return found


def _lines(values: dict[str, Any]) -> Iterator[str]:
    """Yield an entry for each key: rows and mappings have a line for each of their own entries."""
    for key, value in values.items():
        if isinstance(value, dict) and value:
            yield f"{key}:"
            yield from (f"  {flow(name)}: {flow(own)}" for name, own in value.items())
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            yield f"{key}:"
            yield from (f"  - {flow(own)}" for own in value)
        else:
            yield f"{key}: {flow(value)}"
