"""The table of changed robots has a block for each change, shares in per cent, and dashes without deviations."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden, read_table, write_rows

from mobnet.core.columns import Score
from mobnet.evaluation.number.files import read_rows
from mobnet.settings.evaluation import Evaluation, LimbRuns

LEVELS = {"as known": "robots", "warmed up": "robots_warm"}
METRICS = {
    "rmse": (2.0, "N m"), "known_share": (0.6, "-"), "free_share": (0.5, "-"), "flagged_share": (0.25, "-"),
}  # fmt: skip


def test_shares_stand_beside_errors_and_a_method_without_deviations_has_dashes(
    make_table: Callable[..., Path], evaluation: Evaluation, write_measured: Callable[..., list[Path]]
) -> None:
    tests = {
        title: LimbRuns(scenario="changed_walk", level=level, methods=("MOB", "MOB-Net"), limbs=("LL",))
        for title, level in LEVELS.items()
    }
    scores = write_measured(tests.values(), METRICS)
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
