"""Table N of the paper = rule = configuration = file = test = a row of docs/map.md; nothing is an orphan."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import NamedTuple

import pytest

from mobnet.core.config import read_yaml

from .conftest import ROOT

TABLES = [f"Table {n}" for n in (*range(1, 12), 13)]
FIGURES = [f"Figure {n}" for n in (*range(5, 11), *range(12, 21))]
SECTIONS = ["Section 6.1", "Section 6.2", "Section 6.3", "Section 7"]
NUMBERED = re.compile(r"(?:table|figure)_\d\d")
Outputs = Callable[[str], dict[str, str]]


class Row(NamedTuple):
    """A row of the map."""

    paper: str
    shows: str
    rule: str
    file: str
    test: str
    state: str


def rows() -> list[Row]:
    """Return the rows of the map's first table."""
    text = (ROOT / "docs" / "map.md").read_text().split("\n## ")[0]
    lines = [line.strip("|").split("|") for line in text.splitlines() if line.startswith("|")]
    return [Row(*(cell.strip().strip("`") for cell in line)) for line in lines[2:]]


MAKES = [row for row in rows() if row.rule != "-"]


def rules() -> set[str]:
    """Return the names of the workflow's rules."""
    texts = [path.read_text() for path in (ROOT / "workflow" / "rules").glob("*.smk")]
    return set(re.findall(r"^rule (\w+):", "\n".join(texts), re.MULTILINE))


def configured() -> set[str]:
    """Return the numbered tables and figures that the configuration describes."""
    settings = read_yaml(ROOT / "configs" / "config.yaml")["evaluation"]
    return {key for key in (*settings, *settings["tables"]) if NUMBERED.fullmatch(key)}


def test_everything_the_paper_numbers_is_on_the_map_once() -> None:
    named = [row.paper for row in rows()]
    assert [name for name in (*TABLES, *FIGURES, *SECTIONS) if named.count(name) != 1] == []


def test_a_row_is_made_or_says_what_it_waits_for() -> None:
    for row in rows():
        known = row.state.startswith(("done", "input: ", "to do, ")) or "to do, " in row.state
        assert known, row
        assert row.state.startswith("done") == (row.rule != "-"), row


@pytest.mark.parametrize("row", MAKES, ids=[row.rule for row in MAKES])
def test_row_has_rule_script_file_and_test(row: Row, outputs: Outputs) -> None:
    assert row.rule in rules()
    assert (ROOT / "workflow" / "scripts" / f"{row.rule}.py").is_file()
    assert outputs("default")[row.file] == row.rule
    assert (ROOT / row.test).is_file()


def test_no_table_or_figure_is_an_orphan(outputs: Outputs) -> None:
    on_map = {name for row in MAKES for name in NUMBERED.findall(row.file)}
    made = {name for path in outputs("default") for name in NUMBERED.findall(path)}
    numbered = {rule for rule in rules() if NUMBERED.fullmatch(rule)}
    assert on_map == made == configured()
    assert numbered <= made


def test_the_paper_shows_every_table_and_figure() -> None:
    text = (ROOT / "paper" / "main.tex").read_text()
    assert [name for name in configured() if name not in text] == []


def test_every_rule_has_a_script_and_every_script_a_rule() -> None:
    assert rules() == {path.stem for path in (ROOT / "workflow" / "scripts").glob("*.py")}
