"""The table of parts of a walk has a column for each part, and dashes for limbs that are no legs."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden, read_table, write_rows

from mobnet.core.columns import Score
from mobnet.evaluation.number.files import read_rows
from mobnet.evaluation.tables.further.phases import PARTS
from mobnet.settings.evaluation import Evaluation, LimbRuns

TEST = LimbRuns(scenario="walk_test", level="all_uncertainty", methods=("zero", "MOB"), limbs=("LL", "W"))
METRICS = {"rmse": (2.0, "N m"), **{f"rmse_{part}": (2.0 + k, "N m") for k, part in enumerate(PARTS, start=1)}}


def test_parts_stand_side_by_side_and_what_a_limb_lacks_is_a_dash(
    make_table: Callable[..., Path], evaluation: Evaluation, write_measured: Callable[..., list[Path]]
) -> None:
    (path,) = write_measured([TEST], METRICS)
    legs_alone = ("rmse_swing", "rmse_touch_down", "rmse_stance")
    rows = [row for row in read_rows(path, Score) if row.limb == "LL" or row.metric not in legs_alone]
    write_rows(path, rows)
    settings = evaluation.phases.model_copy(update={"tests": (TEST,)})
    table = make_table("phases", settings=settings, scores=[path])
    lines = table.with_suffix(".md").read_text().splitlines()
    assert lines[0] == "| Test | Limb | Method | all | swing | touch-down | stance | stuck | moving |"
    assert lines[2] == "| walk test | LL | zero | 2.00 | 3.00 | 4.00 | 5.00 | 6.00 | 7.00 |"
    assert lines[4] == "| walk test | W | zero | 2.00 | - | - | - | 6.00 | 7.00 |"
    rows = {(row.method, row.limb, row.joint, row.metric): row for row in read_table(table)}
    assert rows["MOB", "LL", "LL4", "rmse_stance"].value == pytest.approx(5.5)
    assert ("MOB", "W", "W1", "rmse_stance") not in rows
    check_golden(table)
