"""The rows of products: what each names is there and is taken, and few files know a product by its name."""

import ast
from pathlib import Path

import pytest

from experiments.plan.call import parameters
from experiments.plan.needs import NEEDS
from experiments.plan.products import function_of, quoted, sources
from experiments.settings.evaluation import ENTRIES, PRODUCTS
from experiments.settings.settings import Settings

ROOT = Path(__file__).parents[3]
ROWS = {name: row for name, row in PRODUCTS.items() if name not in ENTRIES}
# Sections of several products stand in their own modules, and values of a name in `configs`; they do not count.
SECTIONS = ("tables", "figures", "measures", "pages", "reaction_tables", "detection_tables")
MOST = 4  # files: row, module, and tests
# Everyday words: as a text they mean something else nearly everywhere.
WORDS = {
    "calibration",
    "changed",
    "claims",
    "commands",
    "coverage",
    "data",
    "kinds",
    "links",
    "methods",
    "noise",
    "peaks",
    "phases",
    "sigma",
    "steps",
    "uncertainty",
}
# Products that more files name. These numbers only fall.
MORE = {
    "figure_05": 5,
    "figure_06": 9,
    "figure_07": 5,
    "figure_10": 8,
    "figure_17": 12,
    "kinds": 7,
    "figure_18": 5,
    "figure_20": 5,  # the settings put the network's own size into its sweep
    "why_share": 6,  # the note on training names its networks and sets as the figure does
    "coverage": 9,
    "peaks": 9,
    "bode": 6,
    "drift": 5,
    "phases": 5,
    "changed": 10,
    "hourly": 6,
    "table_09": 7,  # this and the next ones: settings.counts says how much a cell of theirs counts
    "safety": 6,
    "sensorless": 6,
    "found_by_rate": 6,
    "smallest_force": 5,
    "latency": 6,
    "claims_summary": 8,
    "claims_tolerance": 5,
}
FOLDERS = (
    "src/experiments",
    "workflow",
    "tests/paper/evaluation",
    "tests/paper/plan",
    "tests/paper/settings",
    "tests/paper/workflow",
)


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
    """Return what a module names as a function, a field of `Evaluation`, an attribute of an evaluation, or a text."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        match node:
            case ast.Constant(value=str(text)) if text not in WORDS:
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


def test_few_files_name_a_product() -> None:
    paths: list[Path] = []
    for folder in FOLDERS:
        paths += (ROOT / folder).rglob("*.py")
    named: list[set[str]] = []
    for path in paths:
        is_section = path.parent.name in ("settings", "checks") and path.stem in SECTIONS  # and its checks
        if not is_section and path != Path(__file__):
            named.append(names_in(path))
    counts = {name: sum(name in names for names in named) for name in ROWS}
    assert {name: count for name, count in counts.items() if count > MORE.get(name, MOST)} == {}
