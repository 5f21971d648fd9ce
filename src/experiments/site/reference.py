"""Pages of reference: the commands of `./reproduce`, every key of the configuration, and the public modules."""

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from experiments.settings.settings import Settings
from experiments.site.contents import menu

PLACE = "reference"
INTERNALS = f"{PLACE}/internals.md"
CONFIGURATION = f"{PLACE}/configuration"
INTERNALS_HEAD = """# Internals

For those who change this project: its packages by what their docstrings say. They may change with any release; programs
of others take the eleven names of [Use it from Python](../docs/interface.md).

"""
PUBLIC = {  # packages whose modules are shown -> what they are for
    "core": "recordings, estimates and files",
    "kernel": "the observer of a `pin.Model`, over arrays",
    "robot": "models of the robot",
    "simulation": "simulated plant and recordings",
    "learning": "networks and their training",
    "estimation": "the observer and all estimators",
    "detection": "detectors of collisions",
    "reaction": "reactions to collisions",
    "robotlog": "logs of a robot of one's own",
    "export": "networks for programs without this project",
}
LIMITS = {
    "exclusiveMinimum": "above {}",
    "minimum": "from {}",
    "exclusiveMaximum": "below {}",
    "maximum": "up to {}",
    "minItems": "at least {} items",
    "maxItems": "at most {} items",
}
TYPES = {"array": "list", "object": "mapping", "string": "text", "null": "nothing"}  # as YAML calls them
REFERENCE = "#/$defs/"
COMMAND = re.compile(r"^ {2}(\w+) {2,}\w", re.MULTILINE)  # in the list of commands


def reference_pages(modules: Mapping[str, Sequence[str]]) -> Iterator[tuple[str, str]]:
    """Yield path and text of each page; `modules` are the dotted names of the modules of each public package."""
    yield f"{PLACE}/commands.md", commands_page()
    yield from configuration_pages(Settings.model_json_schema())
    for package, names in modules.items():
        yield f"{PLACE}/{package}.md", package_page(package, names)
    listed = "".join(f"* [mobnet.{name}]({name}.md): {text}\n" for name, text in PUBLIC.items())
    yield INTERNALS, f"{INTERNALS_HEAD}{listed}\n{menu(f'{PLACE}/{name}' for name in PUBLIC)}"


def commands_page() -> str:
    """Return the page of all commands, each with its own help."""
    overview = printed_by("--help")
    parts = ["# Commands", f"```text\n{overview}\n```"]
    for name in COMMAND.findall(overview):
        parts += [f"## ./reproduce {name}", f"```text\n{printed_by(name, '--help')}\n```"]
    return "\n\n".join(parts) + "\n"


def printed_by(*words: str) -> str:
    """Return what `./reproduce` prints, which this package must not import."""
    wide = {**os.environ, "COLUMNS": "100"}
    done = subprocess.run([sys.executable, "reproduce", *words], capture_output=True, text=True, check=True, env=wide)
    return done.stdout.strip()


def configuration_pages(schema: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield the page of a JSON schema's first keys, and for each key that has sections a page of these.

    A section that several keys have is on the page of the first one, where links of all find it.
    """
    left = {title: schema["$defs"][title] for title in sections_of(schema, schema["$defs"])}
    below: list[str] = []
    for key, value in schema["properties"].items():
        titles = [title for title in sections_of(value, schema["$defs"]) if title in left]
        if titles:
            parts = [f"# {key}", *(section_part(title, left.pop(title)) for title in titles)]
            below.append(f"{CONFIGURATION}/{key}")
            yield f"{below[-1]}.md", "\n\n".join(parts)
    intro = "Files in `configs` hold these keys. `python -m experiments.settings` prints the schema for editors."
    first = section_part(schema["title"], schema)
    yield f"{CONFIGURATION}.md", f"# Configuration\n\n{intro}\n\n{first}\n{menu(below)}"


def section_part(title: str, section: Mapping[str, Any]) -> str:
    """Return a section's heading, what it says, and the table of its keys."""
    rows = "".join(
        f"| `{key}` | {accepted(value)} | {'yes' if key in section.get('required', ()) else 'no'} |\n"
        for key, value in section.get("properties", {}).items()
    )
    table = f"| key | accepted | needed |\n| --- | --- | --- |\n{rows}"
    return f"({anchor(title)})=\n## {title}\n\n{described(section)}\n\n{table}"


def sections_of(schema: Mapping[str, Any], known: Mapping[str, Any]) -> dict[str, None]:
    """Return the names of the sections that a schema refers to, directly or not, each after the one that names it."""
    found: dict[str, None] = {}
    waiting = [schema]
    while waiting:
        text = json.dumps({key: value for key, value in waiting.pop(0).items() if key != "$defs"})
        names = [part.partition('"')[0] for part in text.split(f'"{REFERENCE}')[1:]]
        new = [name for name in dict.fromkeys(names) if name not in found]
        found.update(dict.fromkeys(new))
        waiting += [known[name] for name in new]
    return found


def described(section: Mapping[str, Any]) -> str:
    """Return what a section's docstring says, its list of attributes as a list."""
    text, _, attributes = section.get("description", "").partition("Attributes:\n")
    lines = (line.strip() for line in attributes.splitlines())
    return text.strip() + "\n\n" + "".join(f"* {line}\n" if ": " in line else f"  {line}\n" for line in lines)


def accepted(value: Mapping[str, Any]) -> str:
    """Return in words what the schema of a value accepts."""
    if "$ref" in value:
        title = value["$ref"].removeprefix(REFERENCE)
        return f"[{title}](#{anchor(title)})"
    if "anyOf" in value:
        return " or ".join(dict.fromkeys(map(accepted, value["anyOf"])))
    if "enum" in value or "const" in value:
        return ", ".join(f"`{one}`" for one in value.get("enum", [value.get("const")]))
    text = f"{TYPES.get(value.get('type', ''), value.get('type', 'anything'))}{_of(value)}"
    limits = [form.format(f"{value[key]:.10g}") for key, form in LIMITS.items() if key in value]
    if "default" in value and value["default"] not in ([], {}, None):
        limits.append(f"default `{value['default']}`")
    return ", ".join([text, *limits])


def _of(value: Mapping[str, Any]) -> str:
    """Return of what a list or a mapping is."""
    if "prefixItems" in value:
        return " of " + ", ".join(dict.fromkeys(map(accepted, value["prefixItems"])))
    kinds = [value[key] for key in ("items", "additionalProperties") if isinstance(value.get(key), Mapping)]
    kinds += value.get("patternProperties", {}).values()
    return " of " + " or ".join(map(accepted, kinds)) if kinds else ""


def anchor(title: str) -> str:
    """Return the anchor of a section."""
    return f"section-{title.lower()}"


def package_page(package: str, modules: Sequence[str]) -> str:
    """Return the page of a package, whose modules describe themselves."""
    parts = [f"# mobnet.{package}: {PUBLIC[package]}"]
    parts += [f"## {name}\n\n```{{eval-rst}}\n.. automodule:: {name}\n   :members:\n```" for name in modules]
    return "\n\n".join(parts) + "\n"
