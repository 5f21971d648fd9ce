"""Figures 5, 7, 8 and 9 show the joints and the stretch asked for, each curve off the truth by its error."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from csv_files import check_golden, read_table

from mobnet.core.joints import JointLayout
from mobnet.evaluation.figures.paper.figure_05 import figure_05, read_panel
from mobnet.evaluation.figures.paper.figure_08 import figure_08
from mobnet.evaluation.figures.paper.figure_09 import figure_09
from mobnet.evaluation.figures.paper.hand_figure import hand_figure
from mobnet.plan.runs import Run
from mobnet.settings.evaluation import Evaluation

Walk = Callable[..., Run]
START_S, CYCLE_ROWS = 1.0, 140


def test_panel_of_figure_05_holds_the_cycle_of_the_joint(walk: Walk, layout: JointLayout) -> None:
    panel = read_panel(layout, walk(2.0), "LL3", START_S)
    assert panel.title == "MOB-Net, all uncertainty"
    assert len(panel.time) == CYCLE_ROWS
    assert panel.time[0] == 0.0
    assert panel.flags["swing"].sum() == CYCLE_ROWS // 2
    truth, estimate = panel.curves
    np.testing.assert_allclose(estimate.values - truth.values, 2.0, rtol=1e-4)


def test_figure_05_is_written_as_vector_picture_and_numbers(
    tmp_path: Path, walk: Walk, layout: JointLayout, evaluation: Evaluation
) -> None:
    figure_05(evaluation.figure_05, START_S, layout, [walk(-15.0, method="MOB"), walk(1.5)], tmp_path)
    assert (tmp_path / "figure_05.pdf").read_bytes().startswith(b"%PDF")
    assert (tmp_path / "figure_05.png").read_bytes().startswith(b"\x89PNG")
    lines = (tmp_path / "figure_05.csv").read_text().splitlines()
    assert lines[0] == "panel,time_s,swing,truth,MOB,MOB-Net"
    assert len(lines) == 1 + 2 * CYCLE_ROWS
    check_golden(tmp_path / "figure_05.csv")


def test_figure_07_shows_every_fifth_sample_of_each_joint_with_its_unit(
    tmp_path: Path, walk: Walk, layout: JointLayout, evaluation: Evaluation
) -> None:
    joints = list(evaluation.figure_07.joints)
    runs = [walk(-15.0, method="MOB", joints=joints), walk(1.5, joints=joints, std=0.5)]
    hand_figure(evaluation.figure_07, "figure_07", layout, runs, tmp_path)
    rows = read_table(tmp_path / "figure_07.csv")
    assert list(dict.fromkeys(row.panel for row in rows)) == ["W2 [N m]", "V3 [N]"]
    assert [row.time_s for row in rows[:10]] == pytest.approx([0.5 + 0.05 * k for k in range(10)])
    assert len(rows) == 2 * 10
    for row in map(vars, rows):
        assert row["MOB-Net"] - row["truth"] == pytest.approx(1.5, abs=1e-3)
        assert row["MOB-Net std"] == 0.5
    check_golden(tmp_path / "figure_07.csv")


def test_figure_08_shows_target_prediction_and_error_of_every_joint(
    tmp_path: Path, walk: Walk, layout: JointLayout, evaluation: Evaluation
) -> None:
    figure_08(evaluation.figure_08, START_S, layout, [walk(1.5, std=0.5)], tmp_path)
    rows = read_table(tmp_path / "figure_08.csv")
    assert list(dict.fromkeys(row.panel for row in rows)) == [f"LL{i}, RMSE 1.50 N m" for i in range(1, 7)]
    assert len(rows) == 6 * CYCLE_ROWS
    for row in map(vars, rows):
        assert [row["target"], row["MOB-Net"], row["MOB-Net std"]] == pytest.approx([5.0, 3.5, 0.5], rel=1e-4)
    check_golden(tmp_path / "figure_08.csv")


def test_figure_09_shows_every_method_on_every_joint(
    tmp_path: Path, walk: Walk, layout: JointLayout, evaluation: Evaluation
) -> None:
    errors = {"MOB": -15.0, "MOB-Net": 1.5}
    runs = [walk(error, method=method) for method, error in errors.items()]
    figure_09(evaluation.figure_09, START_S, layout, runs, tmp_path)
    rows = read_table(tmp_path / "figure_09.csv")
    assert list(dict.fromkeys(row.panel for row in rows)) == [f"LL{i}" for i in range(1, 7)]
    for row in map(vars, rows[70:80]):
        assert [row[method] - row["truth"] for method in errors] == pytest.approx(list(errors.values()), rel=1e-3)
    check_golden(tmp_path / "figure_09.csv")
