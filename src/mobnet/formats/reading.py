"""From a YAML file to plain values, with the line of each; the only module that knows YAML.

A file is data. What could run code, hide a value or surprise is refused: tags, keys that occur twice, and what YAML 1.1
reads as something else than it looks like, such as `no`, `017`, `1:30` or `1e3`.
"""

import math
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple, cast

import yaml

from mobnet.core.errors import ConfigError, DataError
from mobnet.core.files import check_regular

Place = tuple[str | int, ...]
Problem = tuple[Place, str]  # what does not fit at a place
TAG = "tag:yaml.org,2002:"
MERGE = f"{TAG}merge"
LARGEST = 100_000  # values, aliases written out: a few lines of nested aliases can stand for billions
SHOWN = 40  # characters of a word
DEEPEST = 100  # levels of a file
Node = Any  # of PyYAML, which has no types
LIBRARY: Any = yaml


def _nothing(_: str) -> None:
    """Read null."""


class Form(NamedTuple):
    """What is accepted of a kind of scalar."""

    pattern: str
    read: Callable[[str], str | int | float | bool | None]
    accepted: str


FORMS = {
    f"{TAG}str": Form(r"(?s:.*)", str, ""),
    f"{TAG}int": Form(r"[-+]?(0|[1-9]\d{0,17})", int, "decimal digits, without a zero or a colon between them"),
    f"{TAG}float": Form(r"(?i:[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?)", float, "a finite decimal number"),
    f"{TAG}bool": Form("true|false", "true".__eq__, "true or false, or quotes around a text"),
    f"{TAG}null": Form("null|~", _nothing, "a value"),
}
NUMBER = re.compile(r"[-+]?(\d[\d_,]*\.?\d*(e[-+]?\d+)?|0[xo][\da-f]+|nan|inf(inity)?)", re.IGNORECASE)  # read as text


class Document:
    """A YAML file: its `values`, and what is not accepted in it, `faults`, as lines of place and text.

    Without `nulls`, null is not accepted: what has no value is left out.
    """

    def __init__(self, path: Path, *, nulls: bool = False) -> None:
        """Read a file; it may be missing."""
        self.path = path
        self.faults = list[str]()
        self.values: dict[str, Any] = {}
        self._nulls, self._root = nulls, self._composed()
        self._read: dict[int, tuple[Any, int]] = {}  # nodes that an alias may name again, with their sizes
        if isinstance(self._root, yaml.MappingNode):
            self.values = self._whole(self._root)
        elif not self.faults:
            self._refuse(1, (), "a list, a text or nothing is not accepted; accepted: a mapping of keys to values")

    @property
    def is_readable(self) -> bool:
        """Whether the file holds YAML at all."""
        return self._root is not None

    def line(self, place: Place) -> int:
        """Return the line of a place, or of what stands nearest above it."""
        node = self._root
        line = 1
        for key in place:
            key_node, node = _child(node, key)
            if key_node is None:
                break
            line = _line(key_node)
        return line

    def holds(self, place: Place) -> bool:
        """Return whether something stands at a place."""
        node = self._root
        for key in place:
            node = _child(node, key)[1]
        return node is not None

    def told(self, place: Place, text: str, line: int | None = None) -> str:
        """Return one line about a place: file, line, key and text."""
        return f"{self.path}:{line or self.line(place)}: {dotted(place)}: {text}"

    def _whole(self, root: Node) -> dict[str, Any]:
        """Return the value of the whole file; chains of aliases may nest deeper than the text."""
        try:
            return self._value(root, ())[0]
        except RecursionError:
            self._refuse(1, (), f"aliases nested too deep are not accepted; accepted: {DEEPEST} levels or fewer")
            return {}

    def _composed(self) -> Node | None:
        """Return the file's nodes; None if it has none."""
        text = ""
        try:
            check_regular(self.path)
            text = self.path.read_text(encoding="utf-8")
            _check_depth(text)
            return LIBRARY.compose(text, LIBRARY.CSafeLoader)
        except DataError as error:
            self.faults.append(str(error))
        except OSError as error:
            what = "file is missing" if isinstance(error, FileNotFoundError) else error.strerror
            self.faults.append(f"{self.path}: {what}; accepted: a YAML file")
        except UnicodeDecodeError as error:
            self.faults.append(f"{self.path}: byte {error.start} is not UTF-8; accepted: a YAML file in UTF-8")
        except (yaml.YAMLError, RecursionError) as error:
            mark = getattr(error, "problem_mark", None)
            place = getattr(error, "position", 0)
            what = getattr(error, "problem", None) or getattr(error, "reason", None) or error
            line = mark.line + 1 if mark else text.count("\n", 0, place) + 1
            said = f"{what} {_token(text, mark)}" if mark else str(what)
            self._refuse(line, (), f"not YAML, {' '.join(said.split())}; accepted: one YAML mapping")
        return None

    def _refuse(self, line: int, place: Place, text: str) -> None:
        """Note a fault."""
        self.faults.append(self.told(place, text, line))

    def _value(self, node: Node, place: Place) -> tuple[Any, int]:
        """Return the value of a node and how many values it holds."""
        known = self._read.get(id(node))
        if known is None:
            self._read[id(node)] = None, LARGEST  # what contains itself is too large
            known = self._read[id(node)] = self._built(node, place)
        if known[1] > LARGEST and not self.faults:
            self._refuse(_line(node), place, f"more than {LARGEST} values are not accepted; accepted: fewer aliases")
        return known

    def _built(self, node: Node, place: Place) -> tuple[Any, int]:
        """Return value and size of a node that is met for the first time."""
        if isinstance(node, yaml.ScalarNode):
            value, fault = read_scalar(node.tag, node.value, plain=not node.style, nulls=self._nulls)
            if fault:
                self._refuse(_line(node), place, fault)
            return value, 1
        kind = "map" if isinstance(node, yaml.MappingNode) else "seq"
        if node.tag != TAG + kind:
            self._refuse(_line(node), place, f"tag {node.tag!r} is not accepted; accepted: values without tags")
            return None, 1
        if isinstance(node, yaml.MappingNode):
            return self._mapping(node, place)
        items = [self._value(item, (*place, i)) for i, item in enumerate(node.value)]
        return [value for value, _ in items], 1 + sum(size for _, size in items)

    def _mapping(self, node: Node, place: Place) -> tuple[dict[str, Any], int]:
        """Return a mapping, what is merged into it first, and its size."""
        merged = dict[str, Any]()
        entries = dict[str, Any]()
        lines = dict[str, int]()
        total = 1
        for key_node, value_node in node.value:
            line = _line(key_node)
            key = key_node.value
            if key_node.tag not in (f"{TAG}str", MERGE):
                shown = key if isinstance(key, str) else "?"
                self._refuse(line, place, f"key {shown!r} is not accepted; accepted: text")
            elif key in lines:
                text = f"a second {key!r} is not accepted; accepted: each key once, it stands in line {lines[key]} too"
                self._refuse(line, (*place, key), text)
            else:
                lines[key] = line
                is_merge = key_node.tag == MERGE
                value, size = self._value(value_node, place if is_merge else (*place, key))
                total += size
                if not is_merge:
                    entries[key] = value
                elif isinstance(value, dict):
                    merged = cast("dict[str, Any]", value)
                else:
                    self._refuse(line, (*place, key), "what is merged is not accepted; accepted: one mapping")
        return {**merged, **entries}, total


def _check_depth(text: str) -> None:
    """Check that nothing is nested deeper than the C library composes: some 100 000 levels end the process."""
    depth = 0
    for event in LIBRARY.parse(text, LIBRARY.CSafeLoader):
        depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
        if depth > DEEPEST:
            raise yaml.MarkedYAMLError(problem=f"more than {DEEPEST} levels at", problem_mark=event.start_mark)


def read_yaml(path: Path, *, nulls: bool = False) -> dict[str, Any]:
    """Read a YAML mapping; a ConfigError has a line for each fault."""
    document = Document(path, nulls=nulls)
    if document.faults:
        raise ConfigError("\n".join(document.faults))
    return document.values


def read_scalar(tag: str, text: str, *, plain: bool = True, nulls: bool = False) -> tuple[Any, str]:
    """Return the value of a scalar with a tag, and what is wrong with it; nothing is if that is empty."""
    form = FORMS.get(tag)
    refused = f"{text or 'nothing'} is not accepted; accepted: "
    if form is None:
        return None, f"{tag!r} {refused}values without tags, quotes around a text"
    if form.read is str and plain and NUMBER.fullmatch(text):
        return None, f"{refused}a finite decimal number such as 1000 or 1.0e+3, or quotes around a text"
    value = form.read(text) if re.fullmatch(form.pattern, text) else math.nan
    if isinstance(value, float) and not math.isfinite(value):
        return None, refused + form.accepted
    if value is None and not nulls:
        return None, f"{refused}a value, or no such key"
    return value, ""


def read_override(value: Any, place: Place, faults: list[tuple[Place, str]]) -> Any:
    """Return a value of `snakemake --config`, whose nested scalars are text, as a file has it; note its faults."""
    if isinstance(value, Mapping):
        items = cast("Mapping[str, Any]", value).items()
        return {key: read_override(item, (*place, key), faults) for key, item in items}
    if isinstance(value, list | tuple):
        items = enumerate(cast("list[Any]", value))
        return [read_override(item, (*place, index), faults) for index, item in items]
    if isinstance(value, float) and not math.isfinite(value):
        faults.append((place, f"{value} is not accepted; accepted: {FORMS[f'{TAG}float'].accepted}"))
    if isinstance(value, str):
        tag = LIBRARY.resolver.Resolver().resolve(yaml.ScalarNode, value, (True, False))
        value, fault = read_scalar(tag, value)
        if fault:
            faults.append((place, fault))
    return value


def mapping(value: object) -> dict[str, Any]:
    """Return a value that is a mapping, and an empty one for any other."""
    return cast("dict[str, Any]", value) if isinstance(value, dict) else {}


def dotted(place: Place) -> str:
    """Return a place as keys joined by dots."""
    return ".".join(map(str, place)) or "top level"


def _token(text: str, mark: Any) -> str:
    """Return the word of a text at which a mark stands, cut where it is long."""
    rest: str = "\n".join(text.splitlines()[mark.line : mark.line + 1])[mark.column :]
    return rest.partition(" ")[0][:SHOWN]


def _line(node: Node) -> int:
    """Return the line on which a node begins."""
    return node.start_mark.line + 1


def _child(node: Node | None, key: str | int) -> tuple[Node | None, Node | None]:
    """Return the node that has the line of a key, and that of its value; merged mappings are looked at last."""
    if isinstance(node, yaml.SequenceNode) and isinstance(key, int) and key < len(node.value):
        return node.value[key], node.value[key]
    pairs: list[tuple[Node, Node]] = node.value if isinstance(node, yaml.MappingNode) else []
    for key_node, value in pairs:
        if key_node.value == key and key_node.tag != MERGE:
            return key_node, value
    for key_node, value in pairs:
        if key_node.tag == MERGE:
            return _child(value, key)
    return None, None
