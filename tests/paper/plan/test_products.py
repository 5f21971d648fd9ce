"""The rows of tables and figures: their functions take what they give, and few files know a product by its name."""

import ast
import inspect
from pathlib import Path

import pytest
from paper_settings import settings_at

from experiments.plan.items import errors
from experiments.plan.items.texts import PICTURED, QUOTED, SOURCES
from experiments.plan.plan import Plan, make_plan
from experiments.plan.products import FAMILIES, all_items, names_of, sources
from experiments.settings.runs import LimbRuns
from experiments.settings.settings import Settings
from mobnet.core.errors import ConfigError

ROOT = Path(__file__).parents[3]
ROWS = {item.name: item for item in all_items()}
# Sections stand in their own modules, and values of a name in `configs`; they do not count.
SECTIONS = ("evaluation", "tables", "figures", "measures", "pages", "reaction_tables", "detection_tables")
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
    "figure_06": 9,
    "figure_07": 5,
    "figure_10": 7,
    "figure_17": 10,
    "kinds": 6,
    "figure_18": 5,
    "figure_20": 5,  # the settings put the network's own size into its sweep
    "why_share": 6,  # the note on training names its networks and sets as the figure does
    "coverage": 10,
    "false_alarms": 5,
    "ten_first": 5,
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
}
FOLDERS = (
    "src/experiments",
    "workflow",
    "tests/paper/evaluation",
    "tests/paper/plan",
    "tests/paper/settings",
    "tests/paper/workflow",
)


@pytest.fixture(scope="module")
def plan() -> Plan:
    return make_plan(settings_at("smoke"), with_pdf=True)


def test_every_function_takes_what_its_product_gives(plan: Plan) -> None:
    for name in plan.names:
        product = plan.product(name)
        function = product.call.late()
        try:
            inspect.signature(function).bind(**product.arguments)
        except TypeError as fault:
            pytest.fail(f"{name}: {function.__module__}: {fault}")


def test_a_row_says_what_is_written() -> None:
    assert len(ROWS) == len(all_items())
    for row in ROWS.values():
        assert row.table or row.figure
        assert row.figure or not (row.bars or row.further or row.kept)
    tables = {name for name, row in ROWS.items() if row.table}
    figures = {name for name, row in ROWS.items() if row.figure}
    assert tables >= {*names_of(QUOTED), *names_of(SOURCES)}
    assert figures >= {*names_of(PICTURED)}


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.__name__)
def test_what_imports_late_has_a_row(family: object) -> None:
    late: set[object] = {errors.error_table}  # of each entry of `tables`
    late.update(row.late for row in all_items())
    for name, function in inspect.getmembers(family, inspect.isfunction):
        if function.__module__ == family.__name__ and not inspect.signature(function).parameters:
            assert function in late, name


def test_a_figure_of_the_configuration_has_a_row(plan: Plan) -> None:
    section = LimbRuns(scenario="forward_walk", level="all_uncertainty", methods=("MOB",), limbs=("LL",))
    evaluation = plan.settings.evaluation.model_copy(update={"figures": {"drifts": section}})
    settings = plan.settings.model_copy(update={"evaluation": evaluation})
    with pytest.raises(ConfigError, match=r"figure without a row: 'drifts' is not accepted; accepted: drift, "):
        make_plan(settings, with_pdf=True)


def test_sources_are_those_of_the_main_tables(settings: Settings) -> None:
    assert sources(settings.evaluation)[:5] == ["table_05", "table_06", "table_07", "table_08", "table_09"]
    assert {"methods", "peaks", "false_alarms", "found_by_rate"} <= {*sources(settings.evaluation)}


def names_in(path: Path) -> set[str]:
    """Return what a module names as a function, an attribute of an evaluation, or a text."""
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        match node:
            case ast.Constant(value=str(text)) if text not in WORDS:
                found.add(text)
            case ast.FunctionDef(name=name):
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
