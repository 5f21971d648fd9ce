"""Pages of reference have every command and every key of the configuration."""

import re
from itertools import pairwise

from experiments.commands.words import COMMANDS
from experiments.settings.settings import Settings
from experiments.site.reference import (
    PUBLIC,
    accepted,
    commands_page,
    configuration_pages,
    described,
    reference_pages,
)


def test_every_command_has_its_help() -> None:
    page = commands_page()
    assert re.findall(r"^## \./reproduce (\w+)$", page, re.MULTILINE) == list(COMMANDS)
    assert "--dry-run" in page
    assert "--cuda" in page


def test_every_section_of_the_configuration_stands_once_with_all_its_keys() -> None:
    schema = Settings.model_json_schema()
    pages = dict(configuration_pages(schema))
    page = "\n\n".join(pages.values())
    below = [path.removesuffix(".md") for path in pages if path != "reference/configuration.md"]
    assert len(below) > 20
    assert [path for path in below if f"\n/{path}\n" not in pages["reference/configuration.md"]] == []
    places = [found.start() for found in re.finditer(r"^## ", page, re.MULTILINE)] + [len(page)]
    tables = {
        page[a:b].split("\n")[0][3:]: re.findall(r"^\| `(\w+)` \|", page[a:b], re.MULTILINE)
        for a, b in pairwise(places)
    }
    objects = {name: one for name, one in schema["$defs"].items() if "properties" in one}
    assert len(places) - 1 == len(schema["$defs"]) + 1
    assert tables.keys() == {"Settings", *schema["$defs"]}
    assert {name: tables[name] for name in objects} == {name: list(one["properties"]) for name, one in objects.items()}


def test_what_a_key_accepts_is_told_in_words() -> None:
    assert accepted({"type": "number", "exclusiveMinimum": 0, "maximum": 2.5}) == "number, above 0, up to 2.5"
    assert accepted({"$ref": "#/$defs/Plant"}) == "[Plant](#section-plant)"
    assert accepted({"anyOf": [{"type": "string"}, {"type": "null"}]}) == "text or nothing"
    assert accepted({"enum": ["a", "b"]}) == "`a`, `b`"
    pair = {"type": "array", "prefixItems": [{"type": "integer"}] * 2, "minItems": 2, "maxItems": 2}
    assert accepted(pair) == "list of integer, at least 2 items, at most 2 items"
    assert accepted({"type": "object", "patternProperties": {"^a": {"type": "integer"}}}) == "mapping of integer"
    assert (
        accepted({"type": "integer", "maximum": 4294967295, "default": 7}) == "integer, up to 4294967295, default `7`"
    )


def test_the_attributes_of_a_section_are_a_list() -> None:
    text = described({"description": "A part.\n\nAttributes:\n    one: first\n        of all.\n    two: second."})
    assert text == "A part.\n\n* one: first\n  of all.\n* two: second.\n"


def test_every_shown_package_is_a_page_of_its_modules_below_that_of_internals() -> None:
    pages = dict(reference_pages({name: [f"mobnet.{name}.one"] for name in PUBLIC}))
    assert all(f".. automodule:: mobnet.{name}.one" in pages[f"reference/{name}.md"] for name in PUBLIC)
    assert all(f"({name}.md)" in pages["reference/internals.md"] for name in PUBLIC)
