"""A robot's table as a file: a line for each entry, with the comments that its source begins with."""

import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from mobnet.core.files import write_text
from mobnet.formats.robot import RobotTable

PLAIN = re.compile(r"[A-Za-z_]([A-Za-z0-9_./ -]*[A-Za-z0-9_./-])?")  # texts that need no quotes, but for these words
OTHERWISE = re.compile(r"yes|no|on|off|true|false|null|nan|inf(inity)?", re.IGNORECASE)


def flow(value: Any) -> str:
    """Return a value as YAML on one line; numbers keep all their digits, and texts are quoted where YAML needs it."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{flow(key)}: {flow(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(flow, value)) + "]"
    if isinstance(value, float):
        return _number(value)
    if isinstance(value, str) and PLAIN.fullmatch(value) and not OTHERWISE.fullmatch(value):
        return value
    quoted = json.dumps(value, ensure_ascii=False)
    return re.sub(r"[^\x20-\x7e]", lambda sign: f"\\U{ord(sign[0]):08x}", quoted)  # YAML has no pairs of surrogates


def _number(value: float) -> str:
    """Return a number as YAML takes it: 1e-05 would be a text, and infinity and NaN begin with a dot."""
    if not math.isfinite(value):
        return ".nan" if math.isnan(value) else f"{'-' if value < 0 else ''}.inf"
    digits, e, power = repr(value).partition("e")
    return f"{digits}{'' if '.' in digits else '.0'}{e}{power}"


def write_table(path: Path, table: RobotTable, head: Sequence[str]) -> None:
    """Write a table below comments, each of which is a line without its `#`; what is not given is left out."""
    values = table.model_dump(mode="json", exclude_unset=True, exclude_none=True)
    lines = [*(f"# {line}".rstrip() for line in head), *_lines(values)]
    write_text(path, "\n".join(lines) + "\n")


def head_of(path: Path) -> list[str]:
    """Return the comments at the beginning of a table's file, without their `#`."""
    comments = list[str]()
    for line in path.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        comments.append(line.removeprefix("#").strip())
    return comments


def _lines(values: dict[str, Any]) -> Iterator[str]:
    """Yield an entry for each key: rows and mappings have a line for each of their own entries."""
    for key, value in values.items():
        if isinstance(value, dict) and value:
            yield f"{key}:"
            yield from (f"  {flow(name)}: {flow(entry)}" for name, entry in value.items())
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            yield f"{key}:"
            yield from (f"  - {flow(entry)}" for entry in value)
        else:
            yield f"{key}: {flow(value)}"
