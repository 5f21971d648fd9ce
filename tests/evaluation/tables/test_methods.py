"""The overview holds every method of every test, with dashes where the test does not ask for a column."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from csv_files import check_golden, read_table, write_rows

from mobnet.core.columns import Score
from mobnet.evaluation.number.files import read_rows
from mobnet.settings.evaluation import MethodsRow

Make = Callable[..., Path]
MEANS = {"MOB": 9.0, "MOB-Net": 2.0, "FTS-e2e": 3.0}


ROWS = (
    MethodsRow(scenario="walk_test", level="all_uncertainty", columns={"LL": ("LL3", "avg")}, methods=tuple(MEANS)),
    MethodsRow(scenario="motion_test", level="all_uncertainty", columns=dict.fromkeys(("W", "RA"), ("avg",)),
               methods=("MOB", "MOB-Net")),
)  # fmt: skip


@pytest.fixture
def table(make_table: Make, write_limb_scores: Make) -> Path:
    """The overview of made-up scores."""
    return make_table(
        "methods", settings=ROWS, scores={row.scenario: write_limb_scores(row.scenario, MEANS) for row in ROWS}
    )


def test_errors_are_those_asked_for_test_by_test(table: Path) -> None:
    check_golden(table)
    errors = read_table(table)
    assert [(error.method, error.limb, error.joint) for error in errors] == [
        *((method, "LL", joint) for method in MEANS for joint in ("LL3", "avg")),
        *((method, limb, "avg") for method in ("MOB", "MOB-Net") for limb in ("W", "RA")),
    ]
    for error in errors:
        assert error.value == pytest.approx(MEANS[error.method])
        assert (error.networks, error.walks) == (1 if error.method == "MOB" else 2, 2)
        assert error.unit == "N m"


def test_tests_stand_below_one_another_with_dashes_where_a_column_is_not_theirs(table: Path) -> None:
    lines = table.with_suffix(".md").read_text().splitlines()
    assert lines[0] == "| Test | Method | LL3 | LL avg | W avg | RA avg |"
    assert lines[2] == "| walk test, all uncertainty | MOB | 9.00 | 9.00 | - | - |"
    assert lines[3].endswith("|  |  |")
    assert lines[8] == "| motion test, all uncertainty | MOB | - | - | 9.00 | 9.00 |"
    methods_of_lines = [line.split("|")[2].strip() for line in lines[2:]]
    assert methods_of_lines[::2] == ["MOB", "MOB-Net", "FTS-e2e", "MOB", "MOB-Net"]
    assert set(methods_of_lines[1::2]) == {"95%"}
    assert table.with_suffix(".tex").read_text().count(r"\midrule") == 2


def test_a_scenario_at_two_levels_is_two_tests(make_table: Make, write_limb_scores: Make) -> None:
    path = write_limb_scores("walk_test", {"MOB": 9.0})
    rows = read_rows(path, Score)
    write_rows(path, [*rows, *(replace(row, level="ideal", value=row.value / 9) for row in rows)])
    change = {"columns": {"LL": ("avg",)}, "methods": ("MOB",)}
    tests = [ROWS[0].model_copy(update={**change, "level": level}) for level in ("all_uncertainty", "ideal")]
    table = make_table("methods", settings=tests, scores={"walk_test": path})
    lines = table.with_suffix(".md").read_text().splitlines()
    assert lines[2::2] == ["| walk test, all uncertainty | MOB | 9.00 |", "| walk test, ideal | MOB | 1.00 |"]
