"""Results: several joints and metrics are averaged, what is missing is told apart from what cannot be there."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from csv_files import write_rows

from experiments.evaluation.measure.claims.cells import Evidence, read_results
from experiments.records.scores import Score
from experiments.settings.claims import Cell
from mobnet.core.errors import ConfigError, DataError
from mobnet.core.joints import JointLayout

WALK = Cell(scenario="walk", level="ideal", method="MOB")


@pytest.fixture
def results(tmp_path: Path, layout: JointLayout, write_training: Callable[..., Path]) -> Evidence:
    """Two tests of one method, its errors 1, 2 and 3 at the waist, and two kinds of trainings, one all diverged."""
    rows = [
        Score("walk", "ideal", "MOB", 0, test, limb, joint, metric, factor * value * test, "N m")
        for test in (1, 2)
        for limb, joint, value in (("W", "W1", 1.0), ("W", "W2", 2.0), ("W", "W3", 3.0), ("LL", "LL1", 8.0))
        for metric, factor in (("rmse", 1.0), ("rmse_push_1", 10.0))
    ]
    write_rows(tmp_path / "walk.csv", rows)
    folders = [write_training("GRU", seed, -4.0 - seed) for seed in (0, 1)]
    folders.append(write_training("MLP", epochs=1, diverged=True))
    asked = WALK.model_copy(update={"metric": ("rmse", "rmse_push_1")})
    return read_results(layout, [tmp_path / "walk.csv"], folders, [asked])


@pytest.mark.parametrize(
    ("joint", "metric", "first_test"),
    [
        ("W2", None, 2.0),
        ("W", None, 2.0),
        (("W1", "W2"), None, 1.5),
        (("W", "LL1"), None, 3.5),
        ("W1", "rmse_push_1", 10.0),
        ("W1", ("rmse", "rmse_push_1"), 5.5),
    ],
)
def test_a_number_is_the_mean_over_joints_and_metrics(
    results: Evidence, joint: str, metric: str | None, first_test: float
) -> None:
    cell = WALK.model_copy(update={"joint": joint, "metric": metric})
    grids = results.grids(cell)
    assert grids is not None
    np.testing.assert_allclose(np.mean([grid.values for grid in grids], axis=0), [[first_test, 2 * first_test]])
    assert {grid.rows for grid in grids} == {"MOB"}


def test_a_training_is_a_network_on_one_test(results: Evidence) -> None:
    (grid,) = results.grids(Cell(method="GRU", metric="validation loss")) or []
    np.testing.assert_allclose(grid.values, [[-4.0], [-5.0]])


def test_all_trainings_count_among_those_that_may_diverge(results: Evidence) -> None:
    """The share of divergence is the one measure of trainings that diverged."""
    (grid,) = results.grids(Cell(method="MLP", metric="diverged")) or []
    np.testing.assert_allclose(grid.values, [[1.0]])


@pytest.mark.parametrize(
    "cell",
    [WALK.model_copy(update={"joint": "W1", "metric": "rmse_push_9"}), Cell(method="MLP", metric="validation loss")],
)
def test_a_push_that_never_came_and_trainings_that_all_diverged_have_no_number(results: Evidence, cell: Cell) -> None:
    assert results.grids(cell) is None


@pytest.mark.parametrize(
    ("changes", "error", "says"),
    [
        ({"method": "MOB-Net", "joint": "W1"}, DataError, "no run of MOB-Net in walk, ideal"),
        ({"joint": "RA1"}, DataError, "'RA1'"),
        ({"scenario": None, "joint": "W1"}, ConfigError, "scenario=None.*: scenario, level, method and joint"),
        ({}, ConfigError, "joint=None"),
        ({"joint": ("V1", "V4")}, ConfigError, "mixes N and N m"),
        ({"method": "LSTM", "metric": "validation loss"}, DataError, "'LSTM' is not accepted; accepted: GRU, MLP"),
    ],
)
def test_a_run_that_should_be_there_is_named(
    results: Evidence, changes: dict[str, object], error: type[Exception], says: str
) -> None:
    with pytest.raises(error, match=says):
        results.grids(WALK.model_copy(update=changes))
