"""Table N of the paper = product = configuration = file = test = a row of docs/map.md; nothing is an orphan."""

import re
from functools import reduce
from pathlib import Path
from typing import NamedTuple

import pytest

from experiments.plan.plan import make_plan
from experiments.plan.products import CAPTIONS
from experiments.settings.load import load_settings
from mobnet.core.code import start_of

from .conftest import ROOT

TABLES = [f"Table {n}" for n in (*range(1, 12), 13)]
FIGURES = [f"Figure {n}" for n in (*range(5, 11), *range(12, 21))]
SECTIONS = ["Section 6.1", "Section 6.2", "Section 6.3", "Section 7"]
NUMBERED = re.compile(r"(?:table|figure)_\d\d")
MAIN = load_settings(overrides={"scale": "default"})


class Item(NamedTuple):
    """A row of the map's first table."""

    paper: str
    shows: str
    rule: str
    made_by: str
    file: str
    test: str
    state: str


class System(NamedTuple):
    """A row of the map's second table."""

    paper: str
    here: str
    test: str
    state: str


def rows(part):
    lines = [line for line in (ROOT / "docs/map.md").read_text().split("\n## ")[part].splitlines() if line[:1] == "|"]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


ITEMS = [Item(*(cell.strip("`") for cell in row)) for row in rows(0)]
SYSTEMS = [System(*row) for row in rows(1)]
MADE = [item for item in ITEMS if item.rule != "-"]


@pytest.fixture(scope="module")
def products():
    return list(make_plan(MAIN, with_pdf=True).products)


@pytest.fixture(scope="module")
def outputs(products):
    return {name: product.name for product in products for name in product.outputs}


def test_the_map_names_the_function_that_a_rule_calls(products):
    """So two files lead from Table 7 to its code: the map and the module."""
    made = {product.name: product.job.call.function for product in products}
    assert [(item.rule, item.made_by) for item in MADE if item.made_by != made[item.rule]] == []


def numbered(names):
    return {found for name in names for found in NUMBERED.findall(name)}


def test_everything_the_paper_numbers_is_on_the_map_once():
    named = [item.paper for item in ITEMS]
    assert [name for name in (*TABLES, *FIGURES, *SECTIONS) if named.count(name) != 1] == []


@pytest.mark.parametrize("item", ITEMS, ids=[item.paper for item in ITEMS])
def test_an_item_is_made_or_an_input_or_to_do(item, outputs):
    if item.state == "done":
        assert outputs[item.file] == item.rule
        assert (ROOT / item.test).is_file()
    elif item.state.startswith("input: "):
        assert found(item.state.removeprefix("input: `"))
        assert (ROOT / item.file).is_file()
    else:
        assert item[2:] == ("-", "-", "-", "-", "to do")


@pytest.mark.parametrize("system", SYSTEMS, ids=[system.paper for system in SYSTEMS])
def test_a_system_exists_or_is_to_do(system):
    if system.state == "done":
        assert [name for name in re.findall(r"`([^`]+)`", f"{system.here} {system.test}") if not found(name)] == []
        assert system.test != "-"
    else:
        assert system[1:] == ("-", "-", "to do")


def found(name):
    """Return whether a name is a file, a module or a key of the configuration."""
    if "/" in name:
        return (ROOT / name).exists()
    if name.startswith(("mobnet.", "experiments.")):
        return start_of(name).is_file()

    def below(section, key):
        return section[key] if isinstance(section, dict) else getattr(section, key)

    return reduce(below, name.split("."), MAIN) is not None


def test_no_numbered_table_or_figure_is_an_orphan(outputs):
    evaluation = MAIN.evaluation
    configured = numbered((*type(evaluation).model_fields, *evaluation.tables))
    assert numbered(item.file for item in MADE) == numbered(outputs) == configured
    text = (ROOT / "paper/main.tex").read_text()
    assert [name for name in configured if name not in text] == []


def test_every_table_and_figure_of_ours_begins_with_the_question_that_it_answers(outputs):
    """What is not the paper's has to answer one; its caption is the one place that asks it."""
    places = {".md": "tables", ".png": "figures"}
    ours = {
        f"{folder}/{Path(file).stem}"
        for file in outputs
        if (folder := places.get(Path(file).suffix)) and not NUMBERED.fullmatch(Path(file).stem)
    }
    assert {"tables/compute", "tables/claims", "figures/bode"} <= ours
    for name in sorted(ours):
        _, empty, *lines = (ROOT / CAPTIONS / f"{name}.rst").read_text(encoding="utf-8").splitlines()
        first = re.match(r"[^.:?]+[.:?]", " ".join(lines))
        assert not empty, name
        assert first, name
        assert first[0].endswith("?"), name


def test_the_readme_says_what_each_scale_takes():
    """Time, core-hours, memory and disk."""
    lines = [
        [cell.strip() for cell in line.strip("|").split("|")] for line in (ROOT / "README.md").read_text().splitlines()
    ]
    rows = {cells[0].strip("`"): cells[2:] for cells in lines if cells[0].strip("`") in MAIN.scales}
    assert list(rows) == list(MAIN.scales)
    assert all(len(numbers) == 4 and all(re.match(r"\d", number) for number in numbers) for numbers in rows.values())
