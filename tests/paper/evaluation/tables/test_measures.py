"""Tables of what is measured on walks: means over runs test by test, and dashes where a run or a limb has no number."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden, markdown_cells, read_table, write_rows

from experiments.evaluation.tables.further.phases import PARTS
from experiments.records.scores import Score
from experiments.settings.evaluation import Evaluation
from experiments.settings.runs import LimbRuns
from mobnet.core.rows import read_rows

Make, Write = Callable[..., Path], Callable[..., list[Path]]
LEVELS = {"as known": "robots", "warmed up": "robots_warm"}
SHARES = {
    "rmse": (2.0, "N m"), "known_share": (0.6, "-"), "free_share": (0.5, "-"), "flagged_share": (0.25, "-"),
}  # fmt: skip
WALKED = LimbRuns(scenario="walk_test", level="all_uncertainty", methods=("zero", "MOB"), limbs=("LL", "W"))
ERRORS = {"rmse": (2.0, "N m"), **{f"rmse_{part}": (2.0 + k, "N m") for k, part in enumerate(PARTS, start=1)}}
PUSHED = LimbRuns(scenario="knee_swing", level="all_uncertainty", methods=("MOB", "MOB-Net"), limbs=("LL",))
RISES = {"push_share": (0.8, "-"), "rise_delay": (-10.0, "ms"), "rise_delay_observer": (9.0, "ms")}


def test_shares_stand_beside_errors_and_a_method_without_deviations_has_dashes(
    make_table: Make, evaluation: Evaluation, write_measured: Write
) -> None:
    tests = {
        title: LimbRuns(scenario="changed_walk", level=level, methods=("MOB", "MOB-Net"), limbs=("LL",))
        for title, level in LEVELS.items()
    }
    scores = write_measured(tests.values(), SHARES)
    path = next(path for path in scores if "changed_walk" in path.name)
    rows = read_rows(path, Score)
    write_rows(path, [row for row in rows if row.method == "MOB-Net" or row.metric == "rmse"])
    table = make_table("changed", settings=evaluation.changed.model_copy(update={"tests": tests}), scores=scores)
    lines = table.with_suffix(".md").read_text().splitlines()
    assert lines[0].startswith("| Robot | Limb | Method | RMSE [N m] | errors in 68% [%] | free swings in 68% [%] |")
    assert lines[2] == "| as known | LL | MOB | 2.00 | - | - | - |"
    assert lines[5] == "|  |  | MOB-Net | 2.20 | 66.0 | 55.0 | 27.5 |"
    shares = [row for row in read_table(table) if row.metric == "flagged_share" and row.joint == "avg"]
    assert [row.value for row in shares] == pytest.approx([0.275, 0.275])
    check_golden(table)


def test_parts_stand_side_by_side_and_what_a_limb_lacks_is_a_dash(
    make_table: Make, evaluation: Evaluation, write_measured: Write
) -> None:
    (path,) = write_measured([WALKED], ERRORS)
    legs_alone = ("rmse_swing", "rmse_touch_down", "rmse_stance")
    rows = [row for row in read_rows(path, Score) if row.limb == "LL" or row.metric not in legs_alone]
    write_rows(path, rows)
    settings = evaluation.phases.model_copy(update={"tests": (WALKED,)})
    table = make_table("phases", settings=settings, scores=[path])
    lines = table.with_suffix(".md").read_text().splitlines()
    assert lines[0] == "| Test | Limb | Method | all | swing | touch-down | stance | stuck | moving |"
    assert lines[2] == "| walk test | LL | no estimate | 2.00 | 3.00 | 4.00 | 5.00 | 6.00 | 7.00 |"
    assert lines[4] == "| walk test | W | no estimate | 2.00 | - | - | - | 6.00 | 7.00 |"
    rows = {(row.method, row.limb, row.joint, row.metric): row for row in read_table(table)}
    assert rows["MOB", "LL", "LL4", "rmse_stance"].value == pytest.approx(5.5)
    assert ("MOB", "W", "W1", "rmse_stance") not in rows
    check_golden(table)


@pytest.fixture
def table(make_table: Make, evaluation: Evaluation, write_measured: Write) -> Path:
    """The table of one test of two methods."""
    settings = evaluation.peaks.model_copy(update={"tests": (PUSHED,)})
    return make_table("peaks", settings=settings, scores=write_measured([PUSHED], RISES))


def test_numbers_are_means_over_runs_with_their_units(table: Path) -> None:
    rows = {(row.method, row.joint, row.metric): row for row in read_table(table)}
    assert rows["MOB", "LL3", "push_share"].value == pytest.approx(0.8)
    assert rows["MOB-Net", "avg", "rise_delay"].value == pytest.approx(-11.0)
    assert {rows["MOB", "avg", name].unit for name in RISES} == {"-", "ms"}
    assert rows["MOB-Net", "avg", "push_share"].networks == 2
    check_golden(table)


def test_the_low_pass_alone_stands_above_the_methods(table: Path) -> None:
    lines = markdown_cells(table)
    assert [line[:3] for line in lines[2:]] == [
        ["knee swing", "LL", "low-pass of (11)"], ["", "", "MOB"], ["", "", "MOB-Net"],
    ]  # fmt: skip
    assert [lines[2][3], lines[2][5], lines[4][3], lines[4][5]] == ["1", "9.0", "0.88", "-11.0"]


def test_a_delay_is_a_lower_bound_where_that_of_a_walk_is(
    make_table: Make, evaluation: Evaluation, write_measured: Write
) -> None:
    settings = evaluation.peaks.model_copy(update={"tests": (PUSHED,)})
    for share, text in ((0.0, "-11.0"), (0.25, ">-11.0")):
        scores = write_measured([PUSHED], {**RISES, "rise_bound": (share, "-")})
        assert markdown_cells(make_table("peaks", settings=settings, scores=scores))[4][5] == text


def test_a_test_that_is_too_short_for_a_push_has_dashes(
    make_table: Make, evaluation: Evaluation, write_measured: Write
) -> None:
    settings = evaluation.peaks.model_copy(update={"tests": (PUSHED,)})
    table = make_table("peaks", settings=settings, scores=write_measured([PUSHED], {"rmse": (1.0, "N m")}))
    assert read_table(table) == []
    assert "| MOB-Net | - |  | - |  |" in table.with_suffix(".md").read_text()
