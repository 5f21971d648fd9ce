"""Changes of the configuration's files that a test makes: one value replaced, moved, renamed or written twice."""

import copy
import re
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import yaml

from experiments.settings.load import NAMED_FILES, PARTS
from mobnet.core.errors import ConfigError
from mobnet.formats.reading import Place
from mobnet.settings.lab import CONFIGS

FILES = {name: CONFIGS / f"{name}.yaml" for name in (*PARTS, *NAMED_FILES) if name != "robot"}
FILES["robot"] = CONFIGS / "robots" / "tocabi.yaml"
VALUES: dict[str, Any] = {name: yaml.safe_load(path.read_text()) for name, path in FILES.items()}
REFUSED = ("type", "nan", "infinite", "nothing", "extra key", "nested", "twice")  # whatever it is done to
LINE = re.compile(rf"(?P<file>{re.escape(str(CONFIGS))}/\S+\.yaml):(?P<line>\d+): (?P<place>[^:]+): .*accepted: .+")
LONGEST_S = 10.0  # of the processor, from the start of a run to its refusal
Load = Callable[[str, str], object]
THOUSAND = 1000  # between a unit and the one that it is mistaken for


@dataclass(frozen=True)
class Mutation:
    """A file with a change of some kind at a place; the text of the whole file."""

    file: str
    place: Place
    kind: str
    text: str

    def __repr__(self) -> str:
        """Name the change."""
        return f"{self.file}: {'.'.join(map(str, self.place))}: {self.kind}"


def places(value: Any, place: Place = ()) -> Iterator[tuple[Place, Any]]:
    """Yield every value of some values, with its place."""
    yield place, value
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield from places(item, (*place, key))


def replaced(value: Any, place: Place, new: Any) -> Any:
    """Return values with a new one at a place."""
    if not place:
        return new
    value = copy.copy(value)
    value[place[0]] = replaced(value[place[0]], place[1:], new) if place[1:] else new
    return value


def dumped(file: str, place: Place, new: Any) -> str:
    """Return the text of a file with a new value at a place."""
    return yaml.dump(replaced(VALUES[file], place, new), Dumper=yaml.CSafeDumper, sort_keys=False, allow_unicode=True)


def changes(value: Any) -> dict[str, Any]:
    """Return what may be put in the place of a value, by kind of change."""
    if value is None:
        return {"type": "none", "nested": [value], "number": 0.5}
    if isinstance(value, bool):
        return {"type": str(value).lower() + "!", "nothing": None, "nested": [value]}
    if isinstance(value, int | float):
        return {
            "type": f"{value} units", "nan": float("nan"), "infinite": float("inf"), "nothing": None,
            "nested": {"x": value},
            "sign": -value or -1, "unit": value * THOUSAND or 1e9, "unit down": value / THOUSAND or -1e9,
        }  # fmt: skip
    if isinstance(value, str):
        return {
            "type": 7, "nothing": "", "nested": [[value]], "spelling": f"{value}x", "pattern": f"{value}.*",
            "path": f"../{value}",
        }  # fmt: skip
    if isinstance(value, list):
        first, last = value[:1], value[1:]
        return {
            "type": 3,
            "nested": {"x": value},
            "reversed": value[::-1],
            "short": value[:-1],
            "twice more": last + first * 2,
        }
    keys = list(value)
    gone = {f"without {key}": {name: value[name] for name in keys if name != key} for key in keys}
    renamed = {f"renamed {key}": {f"{name}x" if name == key else name: value[name] for name in keys} for key in keys}
    return {"type": 3, "nested": [value], "extra key": {**value, "extra key": 1}, **gone, **renamed}


def written_twice(file: str) -> Iterator[Mutation]:
    """Yield a file with one of its keys written twice, for each key of a mapping in block style."""
    text = FILES[file].read_text()
    lines = text.splitlines(keepends=True)
    for place, key, value in block_keys(yaml.compose(text, yaml.CSafeLoader), ()):
        line, column = value.end_mark.line, key.start_mark.column
        again = f"{' ' * column}{key.value}: {text[value.start_mark.index : value.end_mark.index]}\n"
        yield Mutation(file, place, "twice", "".join([*lines[: line + 1], again, *lines[line + 1 :]]))


def block_keys(node: Any, place: Place) -> Iterator[tuple[Place, Any, Any]]:
    """Yield place, key and value of every plain value of one line in mappings in block style."""
    if not isinstance(node, yaml.MappingNode) or node.flow_style:
        return
    for key, value in node.value:
        if isinstance(value, yaml.ScalarNode) and value.start_mark.line == value.end_mark.line:
            yield (*place, key.value), key, value
        yield from block_keys(value, (*place, key.value))


def refusal(load_with: Load, file: str, text: str) -> list[str]:
    """Return the lines that refuse a file, none if it is accepted; whatever else happens is an error."""
    started = time.process_time()  # other programs take their share of the machine
    try:
        load_with(file, text)
    except ConfigError as error:
        lines = str(error).splitlines()
        assert len(set(lines)) == len(lines)
        for line in lines:
            found = LINE.fullmatch(line)
            assert found, line
            length = text.count("\n") if found["file"] == str(FILES[file]) else 1_000_000
            assert 1 <= int(found["line"]) <= length + 1, line
        return lines
    finally:
        assert time.process_time() - started < LONGEST_S
    return []
