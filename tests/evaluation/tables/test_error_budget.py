"""The error budget: what goes away with a source of error is a share of the square, joint by joint and in sum."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from csv_files import read_table

from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.evaluation.tables.error_budget import error_budget, share_gone

FACTORS = {"all_uncertainty": 1.0, "exact_model": 0.8, "no_friction": 0.5, "no_load_friction": 1.0, "no_noise": 1.1}
Write = Callable[..., Path]
Cells = Mapping[tuple[str, str, str], Any]


def made(config: dict[str, Any], scores_csv: Path, out: Path) -> Cells:
    """Return the cells that are written, by joint, level and metric."""
    error_budget(config, scores_csv, out)
    return {(cell.joint, cell.level, cell.metric): cell for cell in read_table(out / "error_budget.csv")}


def test_share_gone_is_that_of_the_square_whatever_the_joint(
    tmp_path: Path, config: dict[str, Any], layout: JointLayout, write_budget_scores: Write
) -> None:
    """A closed form: errors a factor smaller leave the square of that factor."""
    cells = made(config, write_budget_scores(FACTORS), tmp_path)
    for (joint, level, metric), cell in cells.items():
        if metric == "gone":
            assert cell.value == pytest.approx(100 * (1 - FACTORS[level] ** 2), abs=0.01), joint
    assert {joint for joint, _, _ in cells} >= set(layout.names)
    assert cells["LL6", "no_friction", "rmse"].value == pytest.approx(3.0)
    assert cells["left leg", "all_uncertainty", "rmse"].value == pytest.approx(3.5)
    assert ("LL1", "all_uncertainty", "gone") not in cells
    assert (cells["V3", "no_noise", "rmse"].unit, cells["V3", "no_noise", "gone"].unit) == ("N", "%")


def test_a_group_counts_its_joints_by_their_squares(
    tmp_path: Path, config: dict[str, Any], write_budget_scores: Write
) -> None:
    """A closed form: of squares 1, 4 and 9 the last is gone."""
    cells = made(config, write_budget_scores(dict.fromkeys(FACTORS, 1.0), "W3"), tmp_path)
    assert cells["waist", "exact_model", "gone"].value == pytest.approx(100 * 9 / 14, abs=0.01)
    assert cells["waist", "exact_model", "rmse"].value == pytest.approx(1.0)
    assert cells["W2", "exact_model", "gone"].value == pytest.approx(0.0)


def test_intervals_are_paired_over_recordings(
    tmp_path: Path, config: dict[str, Any], write_budget_scores: Write
) -> None:
    cell = made(config, write_budget_scores(FACTORS), tmp_path)["LL2", "no_friction", "gone"]
    assert (cell.low, cell.high) == pytest.approx((75.0, 75.0))
    rmse = made(config, write_budget_scores(FACTORS), tmp_path)["LL2", "no_friction", "rmse"]
    assert rmse.low is not None
    assert rmse.high is not None
    assert rmse.low < 1.0 < rmse.high


def test_a_line_stands_for_every_joint_and_intervals_below_means_alone(
    tmp_path: Path, config: dict[str, Any], layout: JointLayout, write_budget_scores: Write
) -> None:
    made(config, write_budget_scores(FACTORS), tmp_path)
    header, _, *lines = (tmp_path / "error_budget.md").read_text().splitlines()
    means = [item for item in config["evaluation"]["error_budget"]["joints"] if isinstance(item, dict)]
    assert header.count("gone") == len(FACTORS) - 1
    assert len(lines) == layout.nv + 2 * len(means)
    assert sum("[" in line for line in lines) == len(means)


def test_a_source_that_was_never_switched_off_is_named(
    tmp_path: Path, config: dict[str, Any], write_budget_scores: Write
) -> None:
    factors = {level: factor for level, factor in FACTORS.items() if level != "no_noise"}
    with pytest.raises(DataError, match="'no_noise'"):
        made(config, write_budget_scores(factors), tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_an_error_that_grows_is_a_negative_share(rng: np.random.Generator) -> None:
    squares = rng.uniform(1.0, 2.0, (3, 5))
    np.testing.assert_allclose(share_gone(np.concatenate([squares, 1.5 * squares])), -50.0)
    np.testing.assert_allclose(share_gone(np.concatenate([squares, 0.0 * squares])), 100.0)
