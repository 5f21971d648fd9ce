"""What pydantic refuses, as one text for each fault at the place that was typed, with all that is accepted there."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any, TypeVar, cast

from pydantic import BaseModel, ValidationError

from mobnet.core.errors import ConfigError, misfit, not_accepted
from mobnet.formats.reading import Place, Problem

Schema = dict[str, Any]
Fault = tuple[Place, str, Mapping[str, Any]]  # place, tag of a union, what pydantic found
SHOWN = 80  # characters of a value
WORDS = {
    "integer": "a whole number",
    "number": "a number",
    "string": "text",
    "boolean": "true or false",
    "null": "null",
}
BOUNDS = {"exclusiveMinimum": "above", "minimum": "from", "exclusiveMaximum": "below", "maximum": "to"}
Kind = TypeVar("Kind", bound=BaseModel)


def validated(kind: type[Kind], values: Mapping[str, Any], typed: object, line_of: Callable[[Place, str], str]) -> Kind:
    """Return a section with these values; `line_of` makes a line of a place and a text.

    Raises:
        ConfigError: a line for each fault in the values as they were typed.
    """
    try:
        return kind.model_validate(values)
    except ValidationError as error:
        raise ConfigError(once(line_of(*problem) for problem in problems(error, kind, typed))) from None


def refuse_faults(lines: Iterable[str]) -> None:
    """Raise a ConfigError of these lines, if there are any."""
    if text := once(lines):
        raise ConfigError(text)


def once(lines: Iterable[str]) -> str:
    """Return each line once: a fault behind a YAML alias is met at several places."""
    return "\n".join(dict.fromkeys(lines))


def problems(error: ValidationError, kind: type[BaseModel], given: object) -> Iterator[tuple[Place, str]]:
    """Yield place and text of all that pydantic found in the values given of a section, with what is accepted."""
    schema = _schema_of(kind)
    faults = dict[Place, list[Fault]]()
    errors = cast("list[Mapping[str, Any]]", error.errors(include_url=False))
    for each in errors:
        loc = tuple(each["loc"])
        place, union, branch = _typed(loc, each["type"], given)
        if each["type"] != "too_short" or not any(loc == other["loc"][: len(loc)] != other["loc"] for other in errors):
            faults.setdefault(union if branch else place, []).append((place, branch, each))
    for union, of_union in faults.items():
        deepest, branch, _ = max(of_union, key=lambda fault: len(fault[0]))
        if branch and deepest == union:
            yield union, f"{_short(_at(given, union))} is not accepted; accepted: {accepted_at(schema, union)}"
            continue
        yield from ((place, _text(place, each, schema, given)) for place, of, each in of_union if of == branch)


@cache
def _schema_of(kind: type[BaseModel]) -> Schema:
    """Return the JSON schema of a section."""
    return kind.model_json_schema()


def accepted_at(schema: Schema, place: Place) -> str:
    """Return what the JSON schema of a section accepts at a place, as text."""
    return _all_of(_schemas_at(schema, place), schema)


def _typed(loc: Place, what: str, given: object) -> tuple[Place, Place, str]:
    """Return the place of an error without the tags of unions, the place of the first union, and its tag."""
    place = list[str | int]()
    union = ()
    branch = ""
    for index, key in enumerate(loc):
        is_last = index == len(loc) - 1
        if _has(_at(given, tuple(place)), key) or (is_last and what in ("missing", "extra_forbidden", "value_error")):
            place.append(key)
        elif not branch and key != "[key]":
            union = tuple(place)
            branch = str(key)
    return tuple(place), union, branch


def _text(place: Place, details: Mapping[str, Any], schema: Schema, given: object) -> str:
    """Return the text of one error of pydantic at its place."""
    what = details["type"]
    context = details.get("ctx", {})
    if details["loc"][-1:] == ("[key]",):
        accepted = context.get("pattern") or context.get("expected") or "a shorter name"
        return f"key {place[-1]!r} is not accepted; accepted: {accepted}"
    if what == "extra_forbidden":
        keys = list[str]()
        for part in _schemas_at(schema, place[:-1]):
            keys += part.get("properties", {})
        return not_accepted("key", place[-1], keys)
    if what == "missing":
        return f"key is missing; accepted: {accepted_at(schema, place)}"
    if what == "value_error":
        text = str(context["error"])
        return f"{_short(details['input'])} is not accepted; {text}" if text.startswith("accepted: ") else text
    return f"{_short(details['input'])} is not accepted; accepted: {accepted_at(schema, place)}"


def _short(value: object) -> str:
    """Return a value as text of one line, cut where it is long."""
    text = " ".join(repr(value).split())
    return text if len(text) <= SHOWN else f"{text[:SHOWN]}..."


def _has(value: object, key: str | int) -> bool:
    """Return whether a value holds something under a key or an index."""
    if isinstance(value, Mapping):
        return key in value
    return isinstance(value, list | tuple) and isinstance(key, int) and key < len(cast("Sequence[object]", value))


def _at(value: Any, place: Place) -> Any:
    """Return what stands at a place of some values, None where nothing does."""
    for key in place:
        value = value[key] if _has(value, key) else None
    return value


def _schemas_at(schema: Schema, place: Place) -> list[Schema]:
    """Return the schemas of what may stand at a place."""
    schemas = list(_parts(schema, schema))
    for key in place:
        parents = schemas
        schemas = list[Schema]()
        for node in parents:
            for below in _below(node, key):
                schemas += _parts(below, schema)
    return schemas


def _parts(node: Schema, schema: Schema) -> Iterator[Schema]:
    """Yield a schema, or each of those that it is a union of, without references."""
    if "$ref" in node:
        node = schema["$defs"][node["$ref"].removeprefix("#/$defs/")]
    if "anyOf" in node:
        for part in node["anyOf"]:
            yield from _parts(part, schema)
    else:
        yield node


def _below(node: Schema, key: str | int) -> Iterator[Schema]:
    """Yield the schemas of what stands under a key or an index."""
    if isinstance(key, int):
        prefix = node.get("prefixItems", [])
        yield from prefix[key : key + 1] or [node[name] for name in ("items",) if isinstance(node.get(name), dict)]
    elif key in node.get("properties", {}):
        yield node["properties"][key]
    else:
        yield from node.get("patternProperties", {}).values()
        yield from (node[name] for name in ("additionalProperties",) if isinstance(node.get(name), dict))


def _all_of(parts: Iterable[Schema], schema: Schema) -> str:
    """Return what any of some schemas accepts, as text."""
    return " or ".join(dict.fromkeys(_described(part, schema) for part in parts)) or "another value"


def _described(node: Schema, schema: Schema) -> str:
    """Return what one schema accepts, as text."""
    if "enum" in node or "const" in node:
        return ", ".join(map(repr, node.get("enum", [node.get("const")])))
    kind = node.get("type", "")
    if kind == "array":
        least = node.get("minItems", 0)
        most = node.get("maxItems")
        count = most if most == least else f"{least} or more" if least else "any number of"
        items = node.get("prefixItems", [node.get("items", {})])
        inner = dict.fromkeys(_all_of(_parts(item, schema), schema) for item in items)
        return f"a list of {count}: {', '.join(inner)}"
    if kind == "object":
        keys = node.get("properties")
        return f"a mapping with the keys {', '.join(keys)}" if keys else "a mapping of names"
    ends = " ".join(f"{word} {node[name]}" for name, word in BOUNDS.items() if name in node)
    form = f"of the form {node['pattern']}" if "pattern" in node else ""
    return " ".join(filter(None, (WORDS.get(kind, "any value"), ends, form)))


def at_most(place: Place, value: float, most: float, what: str) -> Iterator[Problem]:
    """Yield a value above the most that is accepted."""
    if value > most:
        yield place, misfit(value, f"at most {most:g}, {what}")


def below(place: Place, value: float, end: float, what: str) -> Iterator[Problem]:
    """Yield a value that is not below a limit."""
    if value >= end:
        yield place, misfit(value, f"below {end:g}, {what}")


def at_least(place: Place, value: float, least: float, what: str) -> Iterator[Problem]:
    """Yield a value below the least that is accepted."""
    if value < least:
        yield place, misfit(value, f"at least {least:g}, {what}")


def within(place: Place, value: float, ends: tuple[float, float], what: str) -> Iterator[Problem]:
    """Yield a value outside of a range, whose ends are accepted."""
    if not ends[0] <= value <= ends[1]:
        yield place, misfit(value, f"{ends[0]:g} to {ends[1]:g}, {what}")


def as_many(place: Place, count: int, wanted: int, what: str) -> Iterator[Problem]:
    """Yield a list of numbers that has another length than what it belongs to."""
    if count != wanted:
        yield place, misfit(f"{count} numbers", f"{wanted}, {what}")
