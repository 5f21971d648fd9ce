"""Table and figure of the calibration show what was measured, and keep their golden numbers."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from csv_files import check_golden, check_golden_table, read_table
from made_notes import training_note

from experiments.evaluation.figures.further.reliability import nominal_points
from experiments.evaluation.report.calibration import calibration
from experiments.evaluation.tables.further.calibration_table import COVERAGE, CRPS, verdict
from experiments.settings.evaluation import Evaluation
from experiments.settings.settings import Settings
from mobnet.learning.calibration import calibrate


@pytest.fixture
def made(tmp_path: Path, settings: Settings, evaluation: Evaluation, predicted: Callable[..., tuple]) -> Path:
    """Table and figure of one method in two tests, and of one training."""
    tests, runs = zip(predicted(seed=1, scale=2.0), predicted(seed=2, scale=2.0, pushed="LL3"), strict=True)
    folder = tmp_path / "network"
    folder.mkdir()
    std, learning = np.full((2000, 6), 0.5), settings.learning
    error, shares = np.random.default_rng(3).normal(size=std.shape), learning.calibration_levels
    note = calibrate(error, std, learning.calibration_share, shares).note(settings.layout.limb("LL"), shares)
    (folder / "run.json").write_text(json.dumps(training_note("MOB-Net-LL-s0", [1.0], calibration=note)))
    calibration(
        evaluation.calibration.model_copy(update={"tests": tests}), learning, evaluation.coverage, settings.layout,
        evaluation.statistics, {"robots": [folder]}, runs, tmp_path, tmp_path / "figures",
    )  # fmt: skip
    return tmp_path


def test_every_level_stands_in_the_table_before_and_after(made: Path, settings: Settings) -> None:
    rows = read_table(made / "calibration.csv")
    assert list(dict.fromkeys((row.test, row.pushed) for row in rows)) == [
        ("validation", None), ("walk_test", None), ("knee_swing", "LL3"),
    ]  # fmt: skip
    walk = [row for row in rows if row.test == "walk_test"]
    assert tuple(row.share for row in walk if row.measure == COVERAGE) == settings.learning.calibration_levels
    bar = next(row for row in walk if row.share == settings.learning.calibration_share)
    assert bar.after == pytest.approx(0.68, abs=0.05)
    assert bar.before < 0.6
    assert next(row.unit for row in walk if row.measure == CRPS) == "N m"
    check_golden_table(made / "calibration.csv")


def test_the_bar_is_judged_without_collision_only(made: Path) -> None:
    lines = [line.split("|") for line in (made / "calibration.md").read_text().splitlines()[2:]]
    assert {line[1].strip(): line[-2].strip() for line in lines} == {
        "validation, robots": "yes", "walk test": "yes", "knee swing, pushed": "",
    }  # fmt: skip
    assert [verdict({"pushed": "", "after": bar}, 0.68, 0.05) for bar in (0.64, 0.74)] == ["yes", "no"]


def test_figure_has_a_case_without_and_one_under_collision(made: Path, evaluation: Evaluation) -> None:
    rows = read_table(made / "figures/calibration.csv")
    assert list(dict.fromkeys(row.case for row in rows)) == ["in distribution", "knee hit in swing"]
    assert len(rows) == 2 * evaluation.calibration.points
    for row in rows[:3]:
        assert row.after == pytest.approx(row.nominal, abs=0.06)
    assert (made / "figures/calibration.png").read_bytes().startswith(b"\x89PNG")
    check_golden((made / "figures/calibration.csv").rename(made / "calibration_curves.csv"))


def test_nominal_points_are_even_and_inside() -> None:
    np.testing.assert_allclose(nominal_points(3), [0.25, 0.5, 0.75])
