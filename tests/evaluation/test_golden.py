"""Golden files: the numbers of every table and figure, from frozen scores.

After a change that is meant to move them: `UPDATE_GOLDEN=1 python -m pytest tests/evaluation/test_golden.py`,
then read the diff.
"""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mobnet.evaluation.figures.commands import commands
from mobnet.evaluation.figures.figure_05 import figure_05
from mobnet.evaluation.figures.figure_06 import figure_06
from mobnet.evaluation.figures.figure_07 import figure_07
from mobnet.evaluation.figures.figure_08 import figure_08
from mobnet.evaluation.figures.figure_09 import figure_09
from mobnet.evaluation.figures.figure_10 import figure_10
from mobnet.evaluation.figures.figure_17 import figure_17
from mobnet.evaluation.figures.figure_18 import figure_18
from mobnet.evaluation.figures.figure_19 import figure_19
from mobnet.evaluation.figures.figure_20 import figure_20
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
GOLDEN = REPO / "tests/golden"


def check(*produced: Path) -> None:
    """Compare files with the golden ones of their names, or make them the golden ones."""
    for path in produced:
        if os.environ.get("UPDATE_GOLDEN"):
            (GOLDEN / path.name).write_text(path.read_text())
        assert path.read_text() == (GOLDEN / path.name).read_text()


def test_table_05_is_the_golden_one(tmp_path: Path, config: dict[str, Any]) -> None:
    table(config, "table_05", {"forward_walk": GOLDEN / "scores.csv"}, tmp_path)
    check(tmp_path / "table_05.csv")


@pytest.mark.parametrize("name", ["table_06", "table_07", "table_10", "table_11"])
def test_tables_of_errors_are_the_golden_ones(
    name: str, tmp_path: Path, config: dict[str, Any], write_table_scores: Callable[..., dict[str, Path]]
) -> None:
    pushes = ["rmse_pushed", *(f"rmse_push_{k}" for k in range(1, 5))]
    table(config, name, write_table_scores(name, "rmse", "r_rmse", *pushes), tmp_path)
    check(tmp_path / f"{name}.csv")


def test_error_budget_is_the_golden_one(
    tmp_path: Path, config: dict[str, Any], write_budget_scores: Callable[..., Path]
) -> None:
    error_budget(config, write_budget_scores(cut="LL2"), tmp_path)
    check(tmp_path / "error_budget.csv")


def test_claims_are_the_golden_ones(tmp_path: Path, config: dict[str, Any], write_training: Callable[..., str]) -> None:
    losses = {"GRU": -4.0, "LSTM": -3.8, "MLP": -3.0}
    folders = [write_training(kind, seed, loss + 0.05 * seed) for kind, loss in losses.items() for seed in range(2)]
    claims(config, GOLDEN / "claims.yaml", [GOLDEN / "scores.csv"], folders, tmp_path)
    check(tmp_path / "claims.csv")


def test_figure_05_is_made_of_the_golden_numbers(
    tmp_path: Path, config: dict[str, Any], walk: Callable[..., dict[str, Any]]
) -> None:
    figure_05(config, [walk(-15.0, method="MOB"), walk(1.5)], tmp_path)
    check(tmp_path / "figure_05.csv")


def test_figures_over_time_are_made_of_the_golden_numbers(
    tmp_path: Path, config: dict[str, Any], walk: Callable[..., dict[str, Any]]
) -> None:
    mob, net = walk(-15.0, method="MOB"), walk(1.5, std=0.5)
    joints = ["W2", "V3"]
    figure_07(config, [walk(-15.0, method="MOB", joints=joints), walk(1.5, joints=joints, std=0.5)], tmp_path)
    figure_08(config, [net], tmp_path)
    figure_09(config, [mob, net], tmp_path)
    check(*(tmp_path / f"{name}.csv" for name in ("figure_07", "figure_08", "figure_09")))


def test_figures_of_pushes_are_made_of_the_golden_numbers(
    tmp_path: Path,
    config: dict[str, Any],
    walk: Callable[..., dict[str, Any]],
    write_push_scores: Callable[..., Path],
) -> None:
    entries = [walk(-15.0, method="MOB"), walk(1.5)]
    names = ("hip_pitch_step", "knee_swing", "knee_support", "walk_test")
    scores = {name: write_push_scores(name, {"MOB": 20.0 - k, "MOB-Net": 3.0 + k}) for k, name in enumerate(names)}
    figure_06(config, entries, scores["hip_pitch_step"], tmp_path)
    figure_10(config, {"swing knee": entries, "support knee": entries}, scores, tmp_path)
    check(*(tmp_path / f"{name}.csv" for name in ("figure_06", "figure_06_bars", "figure_10", "figure_10_bars")))


def test_tables_of_the_data_are_the_golden_ones(
    tmp_path: Path, config: dict[str, Any], data_sets: dict[str, list[str]]
) -> None:
    sets = {name: data_sets[name] for name in ("walk", "motion")}
    data(config, sets, tmp_path)
    steps(config, {"walk": data_sets["walk"]}, tmp_path)
    commands(config, sets, tmp_path)
    uncertainty(config, {name: [f"{stem}_residual" for stem in stems] for name, stems in sets.items()}, tmp_path)
    check(*(tmp_path / f"{name}.csv" for name in ("data", "steps", "uncertainty", "commands")))


def test_figure_19_and_coverage_are_the_golden_ones(
    tmp_path: Path, config: dict[str, Any], data_sets: dict[str, list[str]]
) -> None:
    training = {"with RTE": data_sets["walk"], "without RTE": data_sets["walk_plain"]}
    tests = [{"scenario": "walk_test", "level": "all_uncertainty", "recordings": data_sets["test"]}]
    figure_19(config, training, tests, tmp_path)
    coverage(config, training, tests, tmp_path)
    check(*(tmp_path / f"{name}.csv" for name in ("figure_19", "coverage")))


def test_table_01_is_the_golden_one(tmp_path: Path, full_config: dict[str, Any]) -> None:
    table_01(full_config | {"published": str(REPO / "configs/legacy_published.yaml")}, tmp_path)
    check(tmp_path / "table_01.csv")


def test_figures_and_tables_of_trainings_are_made_of_the_golden_numbers(
    tmp_path: Path, config: dict[str, Any], write_training: Callable[..., str]
) -> None:
    losses = {"GRU": -4.0, "LSTM": -3.8, "RNN": -3.1, "TCN": -3.5, "MLP": -3.0, "MLP-500": -3.3, "windows": -3.9}
    folders = [write_training(kind, seed, loss + 0.05 * seed) for kind, loss in losses.items() for seed in range(2)]
    folders.append(write_training("printed-rate", epochs=1, diverged=True))
    entries = [
        {"panel": panel, "base": base, "folders": [write_training(f"{base}-{k}", 0, -3.0 - k, **{panel: 10000 * k})]}
        for panel in ("parameters", "samples")
        for base in ("MOB-Net", "FTS-e2e")
        for k in (1, 2)
    ]
    figure_17(folders[:12], tmp_path)
    kinds(config, folders, tmp_path)
    figure_20(entries, tmp_path)
    check(*(tmp_path / f"{name}.csv" for name in ("figure_17", "figure_20", "kinds")))


def test_figures_and_tables_of_limbs_are_made_of_the_golden_numbers(
    tmp_path: Path, config: dict[str, Any], write_limb_scores: Callable[..., Path]
) -> None:
    means = {"MOB": 9.0, "MOB-Net": 2.0, "MOB-Net-Single": 2.5, "FTS-e2e": 3.0}
    scores = {name: write_limb_scores(name, means) for name in ("motion_test", "hand_wrench", "walk_test")}
    figure_18(config, scores, tmp_path)
    methods(config, scores, tmp_path)
    check(*(tmp_path / f"{name}.csv" for name in ("figure_18", "methods")))
