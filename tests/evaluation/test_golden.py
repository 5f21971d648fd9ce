"""Golden files: the numbers of every table, from frozen scores."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from csv_files import GOLDEN, check_golden

from mobnet.evaluation.tables.claims import claims
from mobnet.evaluation.tables.coverage import coverage
from mobnet.evaluation.tables.data import data
from mobnet.evaluation.tables.error_budget import error_budget
from mobnet.evaluation.tables.errors import table
from mobnet.evaluation.tables.kinds import kinds
from mobnet.evaluation.tables.methods import methods
from mobnet.evaluation.tables.steps import steps
from mobnet.evaluation.tables.table_01 import table_01
from mobnet.evaluation.tables.uncertainty import uncertainty

REPO = Path(__file__).parents[2]


def test_table_05_is_the_golden_one(tmp_path: Path, config: dict[str, Any]) -> None:
    table(config, "table_05", {"forward_walk": GOLDEN / "scores.csv"}, tmp_path)
    check_golden(tmp_path / "table_05.csv")


@pytest.mark.parametrize("name", ["table_06", "table_07", "table_10", "table_11"])
def test_tables_of_errors_are_the_golden_ones(
    name: str, tmp_path: Path, config: dict[str, Any], write_table_scores: Callable[..., dict[str, Path]]
) -> None:
    pushes = ["rmse_pushed", *(f"rmse_push_{k}" for k in range(1, 5))]
    table(config, name, write_table_scores(name, "rmse", "r_rmse", *pushes), tmp_path)
    check_golden(tmp_path / f"{name}.csv")


def test_error_budget_is_the_golden_one(
    tmp_path: Path, config: dict[str, Any], write_budget_scores: Callable[..., Path]
) -> None:
    error_budget(config, write_budget_scores(cut="LL2"), tmp_path)
    check_golden(tmp_path / "error_budget.csv")


def test_claims_are_the_golden_ones(tmp_path: Path, config: dict[str, Any], write_training: Callable[..., str]) -> None:
    losses = {"GRU": -4.0, "LSTM": -3.8, "MLP": -3.0}
    folders = [write_training(kind, seed, loss + 0.05 * seed) for kind, loss in losses.items() for seed in range(2)]
    claims(config, GOLDEN / "claims.yaml", [GOLDEN / "scores.csv"], folders, tmp_path)
    check_golden(tmp_path / "claims.csv")


def test_tables_of_the_data_are_the_golden_ones(
    tmp_path: Path, config: dict[str, Any], data_sets: dict[str, list[str]]
) -> None:
    sets = {name: data_sets[name] for name in ("walk", "motion")}
    data(config, sets, tmp_path)
    steps(config, {"walk": data_sets["walk"]}, tmp_path)
    uncertainty(config, {name: [f"{stem}_residual" for stem in stems] for name, stems in sets.items()}, tmp_path)
    check_golden(*(tmp_path / f"{name}.csv" for name in ("data", "steps", "uncertainty")))


def test_coverage_is_the_golden_one(tmp_path: Path, config: dict[str, Any], data_sets: dict[str, list[str]]) -> None:
    training = {"with RTE": data_sets["walk"], "without RTE": data_sets["walk_plain"]}
    tests = [{"scenario": "walk_test", "level": "all_uncertainty", "recordings": data_sets["test"]}]
    coverage(config, training, tests, tmp_path)
    check_golden(tmp_path / "coverage.csv")


def test_table_01_is_the_golden_one(tmp_path: Path, full_config: dict[str, Any]) -> None:
    table_01(full_config | {"published": str(REPO / "configs/legacy_published.yaml")}, tmp_path)
    check_golden(tmp_path / "table_01.csv")


def test_kinds_are_the_golden_ones(tmp_path: Path, config: dict[str, Any], write_training: Callable[..., str]) -> None:
    losses = {"GRU": -4.0, "LSTM": -3.8, "RNN": -3.1, "TCN": -3.5, "MLP": -3.0, "MLP-500": -3.3, "windows": -3.9}
    folders = [write_training(kind, seed, loss + 0.05 * seed) for kind, loss in losses.items() for seed in range(2)]
    folders.append(write_training("printed-rate", epochs=1, diverged=True))
    kinds(config, folders, tmp_path)
    check_golden(tmp_path / "kinds.csv")


def test_methods_are_the_golden_ones(
    tmp_path: Path, config: dict[str, Any], write_limb_scores: Callable[..., Path]
) -> None:
    means = {"MOB": 9.0, "MOB-Net": 2.0, "MOB-Net-Single": 2.5, "FTS-e2e": 3.0}
    scores = {name: write_limb_scores(name, means) for name in ("motion_test", "hand_wrench", "walk_test")}
    methods(config, scores, tmp_path)
    check_golden(tmp_path / "methods.csv")
