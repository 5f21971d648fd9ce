"""The rows of products: what each names is there and is taken, and few files know a product by its name."""

import ast
from pathlib import Path

import pytest

from experiments.plan.call import parameters
from experiments.plan.needs import NEEDS
from experiments.plan.products import function_of, quoted, sources
from experiments.settings.evaluation import ENTRIES, PRODUCTS
from experiments.settings.settings import Settings

ROOT = Path(__file__).parents[2]
ROWS = {name: row for name, row in PRODUCTS.items() if name not in ENTRIES}
# Sections of several products stand in their own modules, and values of a name in `configs`; they do not count.
SECTIONS = ("tables", "figures", "measures", "pages", "reaction_tables", "detection_tables")
MOST = 4  # files: row, module, and tests
# Products that more files name. These numbers only fall. Many of the names are words that mean something else, too.
MORE = {
    "noise": 6, "figure_05": 5, "figure_06": 9, "figure_07": 5, "figure_10": 8, "figure_17": 12, "kinds": 12,
    "methods": 24, "figure_18": 5, "coverage": 19, "calibration": 10, "peaks": 10, "bode": 5, "phases": 9, "sigma": 7,
    "changed": 15, "hourly": 6, "table_09": 7, "table_13": 5, "false_alarms": 5, "safety": 6, "sensorless": 6,
    "found_by_rate": 6, "smallest_force": 6, "links": 6, "data": 29, "commands": 13, "steps": 10, "uncertainty": 17,
    "latency": 6, "claims": 29, "claims_summary": 7,
}  # fmt: skip


@pytest.mark.parametrize("name", ROWS)
def test_a_function_takes_all_that_its_row_names(name: str, settings: Settings) -> None:
    row = ROWS[name]
    required, optional = parameters(function_of(settings.evaluation, name))
    taken = {*required, *optional}
    assert {*row.needs, *row.sections} <= taken
    assert set(row.needs.values()) <= NEEDS.keys()
    assert all(hasattr(settings.evaluation, section) for section in row.sections)
    assert row.table == ("table_dir" in taken)
    assert row.figure == ("figure_dir" in taken)
    assert row.figure or not (row.bars or row.further or row.pictured)
    assert row.table or not (row.quoted or row.source or row.columns)


def test_every_need_has_a_row() -> None:
    named: set[str] = set()
    for row in PRODUCTS.values():
        named.update(row.needs.values())
    assert named == NEEDS.keys()


def test_quoted_tables_and_sources_are_those_of_the_rows(settings: Settings) -> None:
    """The order of the first is that of the lines of numbers.tex."""
    assert [ROWS[name].quoted for name in quoted()] == list(range(1, len(quoted()) + 1))
    assert sources(settings.evaluation)[:5] == ["table_05", "table_06", "table_07", "table_08", "table_09"]
    assert {"methods", "peaks", "false_alarms", "found_by_rate"} <= {*sources(settings.evaluation)}


def names_in(path: Path) -> set[str]:
    """Return what a module names as a text, a function, a field of `Evaluation` or an attribute of an evaluation."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        match node:
            case ast.Constant(value=str(text)):
                found.add(text)
            case ast.FunctionDef(name=name):
                found.add(name)
            case ast.AnnAssign(target=ast.Name(id=name)) if path.stem == "evaluation":
                found.add(name)
            case ast.Attribute(value=ast.Name(id="evaluation"), attr=name):
                found.add(name)
            case ast.Attribute(value=ast.Attribute(attr="evaluation"), attr=name):
                found.add(name)
            case _:
                pass
    return found


@pytest.fixture(scope="module")
def naming() -> dict[Path, set[str]]:
    """What each module of experiments, workflow and tests names."""
    paths: list[Path] = []
    for folder in ("src/experiments", "workflow", "tests"):
        paths += (ROOT / folder).rglob("*.py")
    kept = [path for path in paths if not (path.parent.name == "settings" and path.stem in SECTIONS)]
    return {path: names_in(path) for path in kept if path != Path(__file__)}


def test_few_files_name_a_product(naming: dict[Path, set[str]]) -> None:
    counts = {name: sum(name in named for named in naming.values()) for name in ROWS}
    assert {name: count for name, count in counts.items() if count > MORE.get(name, MOST)} == {}
    # A ceiling that is higher than it must be would let the next file in.
    assert {name: ceiling for name, ceiling in MORE.items() if ceiling > max(counts[name], MOST)} == {}
