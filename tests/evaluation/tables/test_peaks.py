"""The table of pushes shows the mean over walks and the observer's own low-pass above the methods."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden, read_table

from mobnet.settings.evaluation import Evaluation, LimbRuns

Make = Callable[..., Path]
TEST = LimbRuns(scenario="knee_swing", level="all_uncertainty", methods=("MOB", "MOB-Net"), limbs=("LL",))
METRICS = {
    "peak_ratio": (0.8, "-"), "rise_delay": (-10.0, "ms"),
    "peak_ratio_observer": (0.93, "-"), "rise_delay_observer": (9.0, "ms"),
}  # fmt: skip


@pytest.fixture
def table(make_table: Make, evaluation: Evaluation, write_measured: Callable[..., list[Path]]) -> Path:
    """The table of one test of two methods."""
    settings = evaluation.peaks.model_copy(update={"tests": (TEST,)})
    return make_table("peaks", settings=settings, scores=write_measured([TEST], METRICS))


def test_numbers_are_means_over_runs_with_their_units(table: Path) -> None:
    rows = {(row.method, row.joint, row.metric): row for row in read_table(table)}
    assert rows["MOB", "LL3", "peak_ratio"].value == pytest.approx(0.8)
    assert rows["MOB-Net", "avg", "rise_delay"].value == pytest.approx(-11.0)
    assert {rows["MOB", "avg", name].unit for name in METRICS} == {"-", "ms"}
    assert rows["MOB-Net", "avg", "peak_ratio"].networks == 2
    check_golden(table)


def test_the_low_pass_alone_stands_above_the_methods(table: Path) -> None:
    lines = [
        [cell.strip() for cell in line.split("|")[1:-1]] for line in table.with_suffix(".md").read_text().splitlines()
    ]
    assert [line[:3] for line in lines[2:]] == [
        ["knee swing", "LL", "low-pass of (11)"], ["", "", "MOB"], ["", "", "MOB-Net"],
    ]  # fmt: skip
    assert [lines[2][3], lines[2][5], lines[4][3], lines[4][5]] == ["0.93", "9.0", "0.88", "-11.0"]


def test_a_test_that_is_too_short_for_a_push_has_dashes(
    make_table: Make, evaluation: Evaluation, write_measured: Callable[..., list[Path]]
) -> None:
    settings = evaluation.peaks.model_copy(update={"tests": (TEST,)})
    table = make_table("peaks", settings=settings, scores=write_measured([TEST], {"rmse": (1.0, "N m")}))
    assert read_table(table) == []
    assert "| MOB-Net | - |  | - |  |" in table.with_suffix(".md").read_text()
