"""The overview holds every method of every test, with dashes where the test does not ask for a column."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from csv_files import check_golden, markdown_cells, read_table, write_rows

from experiments.records.scores import Score
from experiments.settings.tables import MethodsRow
from mobnet.core.rows import read_rows

Make = Callable[..., Path]
MEANS = {"zero": 10.0, "MOB": 9.0, "MOB-Net": 2.0}


ROWS = (
    MethodsRow(scenario="walk_test", level="all_uncertainty", columns={"LL": ("LL3", "avg")}, methods=tuple(MEANS)),
    MethodsRow(scenario="motion_test", level="all_uncertainty", columns=dict.fromkeys(("W", "RA"), ("avg",)),
               methods=("MOB", "MOB-Net")),
)  # fmt: skip


@pytest.fixture
def table(make_table: Make, write_limb_scores: Make) -> Path:
    """The overview of made-up scores."""
    scenarios = dict.fromkeys(row.scenario for row in ROWS)
    return make_table("methods", settings=ROWS, scores=[write_limb_scores(name, MEANS) for name in scenarios])


def test_errors_are_those_asked_for_test_by_test(table: Path) -> None:
    check_golden(table)
    errors = [error for error in read_table(table) if error.metric == "rmse"]
    assert [(error.method, error.limb, error.joint) for error in errors] == [
        *((method, "LL", joint) for method in MEANS for joint in ("LL3", "avg")),
        *((method, limb, "avg") for method in ("MOB", "MOB-Net") for limb in ("W", "RA")),
    ]
    for error in errors:
        assert error.value == pytest.approx(MEANS[error.method])
        assert (error.networks, error.walks) == (2 if error.method == "MOB-Net" else 1, 2)
        assert error.unit == "N m"


def test_the_raw_truth_stands_beside_and_skill_is_what_is_gained_over_nothing(table: Path) -> None:
    """1 - RMSE / RMSE of `zero`, where the test has it; `zero` itself has none."""
    rows = {(row.scenario, row.method, row.joint, row.metric): row for row in read_table(table)}
    assert rows["walk_test", "MOB", "avg", "rmse_raw"].value == pytest.approx(10.0)
    assert rows["walk_test", "MOB", "LL3", "skill"].value == pytest.approx(0.1)
    assert rows["walk_test", "MOB-Net", "avg", "skill"].value == pytest.approx(0.8)
    assert rows["walk_test", "MOB-Net", "avg", "skill"].unit == "-"
    assert {key[1] for key in rows if key[3] == "skill"} == {"MOB", "MOB-Net"}
    assert not [key for key in rows if key[0] == "motion_test" and key[3] == "skill"]


def test_where_the_truth_is_zero_there_is_no_skill(make_table: Make, write_limb_scores: Make) -> None:
    scores = [write_limb_scores("walk_test", {"zero": 0.0, "MOB": 9.0})]
    test = ROWS[0].model_copy(update={"methods": ("zero", "MOB")})
    table = make_table("methods", settings=[test], scores=scores)
    assert "skill" not in {row.metric for row in read_table(table)}
    assert markdown_cells(table)[-1] == ["", "", "skill", "-", "-"]


def test_tests_stand_below_one_another_with_dashes_where_a_column_is_not_theirs(table: Path) -> None:
    lines = markdown_cells(table)
    assert lines[0] == ["Test", "Method", "", "LL3", "LL avg", "W avg", "RA avg"]
    assert lines[2] == ["walk test, all uncertainty", "no estimate", "RMSE", "10.00", "10.00", "-", "-"]
    assert [line[2] for line in lines[2:9]] == ["RMSE", "95%", "raw truth", "RMSE", "95%", "raw truth", "skill"]
    assert lines[13] == ["motion test, all uncertainty", "MOB", "RMSE", "-", "-", "9.00", "9.00"]
    assert [line[1] for line in lines[2:] if line[1]] == ["no estimate", "MOB", "MOB-Net", "MOB", "MOB-Net"]
    tex = table.with_suffix(".tex").read_text()
    assert tex.count(r"\midrule") == 3  # below the head of the first page and of the others, and between the tests
    assert tex.startswith(r"\begin{longtable}{lllrrrr}" + "\n" + r"\methodscaption")


def test_a_scenario_at_two_levels_is_two_tests(make_table: Make, write_limb_scores: Make) -> None:
    path = write_limb_scores("walk_test", {"MOB": 9.0})
    rows = read_rows(path, Score)
    write_rows(path, [*rows, *(replace(row, level="ideal", value=row.value / 9) for row in rows)])
    change = {"columns": {"LL": ("avg",)}, "methods": ("MOB",)}
    tests = [ROWS[0].model_copy(update={**change, "level": level}) for level in ("all_uncertainty", "ideal")]
    table = make_table("methods", settings=tests, scores=[path])
    lines = markdown_cells(table)
    assert [line for line in lines[2:] if line[2] == "RMSE"] == [
        ["walk test, all uncertainty", "MOB", "RMSE", "9.00"], ["walk test, ideal", "MOB", "RMSE", "1.00"],
    ]  # fmt: skip
