"""The error budget: what goes away with a source of error is a share of the square, joint by joint and in sum."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from csv_files import check_golden, read_table

from experiments.evaluation.tables.further.error_budget import share_left
from experiments.settings.evaluation import Evaluation
from experiments.settings.runs import Mean
from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout

FACTORS = {"all_uncertainty": 1.0, "exact_model": 0.8, "no_friction": 0.5, "no_load_friction": 1.0, "no_noise": 1.1}
Make = Callable[..., Path]
Cells = Mapping[tuple[str, str, str], Any]
Made = Callable[..., Cells]


@pytest.fixture
def made(make_table: Make, write_budget_scores: Make) -> Made:
    """Write the table for some factors and a joint that is cut: made(factors, cut="", folder) -> its cells."""

    def cells(factors: dict[str, float], cut: str = "", **folder: Path) -> Cells:
        table = make_table("error_budget", scores=[write_budget_scores(factors, cut)], **folder)
        return {(cell.joint, cell.level, cell.metric): cell for cell in read_table(table)}

    return cells


def test_share_gone_is_that_of_the_square_whatever_the_joint(made: Made, layout: JointLayout) -> None:
    """A closed form: errors a factor smaller leave the square of that factor."""
    cells = made(FACTORS)
    for (joint, level, metric), cell in cells.items():
        if metric == "gone":
            assert cell.value == pytest.approx(100 * (1 - FACTORS[level] ** 2), abs=0.01), joint
    assert {joint for joint, _, _ in cells} >= set(layout.names)
    assert cells["LL6", "no_friction", "rmse"].value == pytest.approx(3.0)
    assert cells["left leg", "all_uncertainty", "rmse"].value == pytest.approx(3.5)
    assert ("LL1", "all_uncertainty", "gone") not in cells
    assert (cells["V3", "no_noise", "rmse"].unit, cells["V3", "no_noise", "gone"].unit) == ("N", "%")


def test_a_group_counts_its_joints_by_their_squares(made: Made) -> None:
    """A closed form: of squares 1, 4 and 9 the last is gone."""
    cells = made(dict.fromkeys(FACTORS, 1.0), "W3")
    assert cells["waist", "exact_model", "gone"].value == pytest.approx(100 * 9 / 14, abs=0.01)
    assert cells["waist", "exact_model", "rmse"].value == pytest.approx(1.0)
    assert cells["W2", "exact_model", "gone"].value == pytest.approx(0.0)


def test_intervals_are_paired_over_recordings(made: Made) -> None:
    cells = made(FACTORS)
    gone, rmse = (cells["LL2", "no_friction", metric] for metric in ("gone", "rmse"))
    assert (gone.low, gone.high) == pytest.approx((75.0, 75.0))
    assert rmse.low < 1.0 < rmse.high


def test_a_line_stands_for_every_joint_and_intervals_below_means_alone(
    tmp_path: Path, made: Made, evaluation: Evaluation, layout: JointLayout
) -> None:
    made(FACTORS, cut="LL2")
    check_golden(tmp_path / "error_budget.csv")
    header, _, *lines = (tmp_path / "error_budget.md").read_text().splitlines()
    means = [item for item in evaluation.error_budget.joints if isinstance(item, Mean)]
    assert header.count("gone") == len(FACTORS) - 1
    assert len(lines) == layout.nv + 2 * len(means)
    assert sum("[" in line for line in lines) == len(means)


def test_a_source_that_was_never_switched_off_is_named(made: Made, tmp_path: Path) -> None:
    factors = {level: factor for level, factor in FACTORS.items() if level != "no_noise"}
    with pytest.raises(DataError, match="'no_noise'"):
        made(factors, folder=tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_what_is_left_of_squares_may_be_more_than_all(rng: np.random.Generator) -> None:
    squares = rng.uniform(1.0, 2.0, (3, 5))
    np.testing.assert_allclose(share_left(np.concatenate([squares, 1.5 * squares])), np.full((1, 5), 1.5))
    np.testing.assert_allclose(share_left(np.concatenate([squares, 0.0 * squares])), np.zeros((1, 5)))
