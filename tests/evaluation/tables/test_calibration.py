"""Table and figure of the calibration say what the runs gave, and keep their golden form."""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from csv_files import read_table

from mobnet.evaluation.figures.calibration import nominal_points
from mobnet.evaluation.measure.calibration import Grid
from mobnet.evaluation.number.number import Number
from mobnet.evaluation.report.calibration import calibration
from mobnet.evaluation.tables.calibration import COVERAGE, CRPS, verdict
from mobnet.learning.calibration import calibrate

GOLDEN = Path(__file__).parents[3] / "tests/golden"
Make = Callable[..., dict[str, Any]]


@pytest.fixture
def made(tmp_path: Path, config: dict[str, Any], told: Make) -> Path:
    """Table and figure of one method in two tests, and of one training."""
    tests = [told(seed=1, scale=2.0), told(seed=2, scale=2.0, pushed="LL3", scenario="knee_swing")]
    folder = tmp_path / "network"
    folder.mkdir()
    std = np.full((2000, 6), 0.5)
    error = np.random.default_rng(3).normal(size=std.shape)
    levels = config["evaluation"]["calibration"]["levels"]
    note = calibrate(error, std, 0.68, levels).note([f"LL{i}" for i in range(1, 7)], levels)
    (folder / "run.json").write_text(json.dumps({"method": "MOB-Net", "diverged": False, "calibration": note}))
    calibration(config, [str(folder)], tests, tmp_path, tmp_path / "figures")
    return tmp_path


def test_every_level_stands_in_the_table_before_and_after(made: Path, config: dict[str, Any]) -> None:
    rows = read_table(made / "calibration.csv")
    assert list(dict.fromkeys((row.test, row.pushed) for row in rows)) == [
        ("validation", None), ("walk_test", None), ("knee_swing", "LL3"),
    ]  # fmt: skip
    walk = [row for row in rows if row.test == "walk_test"]
    assert [row.share for row in walk if row.measure == COVERAGE] == config["evaluation"]["calibration"]["levels"]
    bar = next(row for row in walk if row.share == 0.68)
    assert bar.after == pytest.approx(0.68, abs=0.05)
    assert bar.before < 0.6
    assert next(row.unit for row in walk if row.measure == CRPS) == "N m"


def test_the_bar_is_judged_without_collision_only(made: Path, config: dict[str, Any]) -> None:
    lines = [line.split("|") for line in (made / "calibration.md").read_text().splitlines()[2:]]
    assert {line[1].strip(): line[-2].strip() for line in lines} == {
        "validation": "yes", "walk test": "yes", "knee swing, pushed": "",
    }  # fmt: skip
    grid = Grid("walk_test", "ideal", "", "MOB-Net", "LL", "N m", np.zeros(0))
    assert [verdict(grid, Number(bar), config["evaluation"]["calibration"]) for bar in (0.64, 0.74)] == ["yes", "no"]


def test_figure_has_a_panel_without_and_one_under_collision(made: Path, config: dict[str, Any]) -> None:
    rows = list(csv.DictReader((made / "figures/calibration.csv").read_text().splitlines()))
    assert list(dict.fromkeys(row["panel"] for row in rows)) == ["in distribution", "knee swing, pushed"]
    assert len(rows) == 2 * config["evaluation"]["calibration"]["points"]
    for row in rows[:3]:
        assert float(row["after"]) == pytest.approx(float(row["nominal"]), abs=0.06)
    assert (made / "figures/calibration.png").read_bytes().startswith(b"\x89PNG")


def test_nominal_points_are_even_and_inside() -> None:
    np.testing.assert_allclose(nominal_points(3), [0.25, 0.5, 0.75])


def test_table_and_figure_are_the_golden_ones(made: Path) -> None:
    for name in ("calibration.csv", "figures/calibration.csv"):
        golden = GOLDEN / name.replace("figures/calibration", "calibration_curves")
        if os.environ.get("UPDATE_GOLDEN"):
            golden.write_text((made / name).read_text())
        assert (made / name).read_text() == golden.read_text()
