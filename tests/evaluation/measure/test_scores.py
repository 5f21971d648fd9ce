"""Scores of made-up runs with known errors."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from csv_files import read_table

from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array, write_array
from mobnet.evaluation.measure.scores import limb_values, score, score_run

Walk = Callable[..., dict[str, Any]]


def test_constant_error_is_scored_as_that_constant_in_every_joint(walk: Walk, layout: JointLayout) -> None:
    """A closed form."""
    rows = [row for row in score_run(layout, "forward_walk", walk(-3.0)) if row.metric == "rmse"]
    assert [row.joint for row in rows] == [*layout.limb("LL"), "avg"]
    assert [row.value for row in rows] == pytest.approx([3.0] * 7, rel=1e-5)
    assert {(row.limb, row.unit, row.scenario, row.method) for row in rows} == {
        ("LL", "N m", "forward_walk", "MOB-Net")
    }


def test_a_constant_error_does_not_change_the_roughness(walk: Walk, layout: JointLayout) -> None:
    """Invariant under an offset of the estimate."""
    one, two = (
        [row.value for row in score_run(layout, "walk", walk(error)) if row.metric == "roughness"]
        for error in (0.5, 4.0)
    )
    assert one == pytest.approx(two, rel=1e-4)


def test_average_is_the_mean_of_the_joints_and_base_units_stay_apart(layout: JointLayout) -> None:
    rows = limb_values(layout, {"V1": 3.0, "V2": 5.0, "V4": 1.0, "LL1": 2.0, "LL2": 4.0})
    averages = {(limb, unit): value for limb, joint, value, unit in rows if joint == "avg"}
    assert averages == {("V", "N"): 4.0, ("V", "N m"): 1.0, ("LL", "N m"): 3.0}


def test_order_of_rows_is_that_of_the_entries(
    tmp_path: Path, walk: Walk, config: dict[str, Any], layout: JointLayout
) -> None:
    entries = [walk(1.0), {**walk(2.0), "test_seed": 2}]
    score(config, "forward_walk", entries, tmp_path / "scores.csv")
    rows = read_table(tmp_path / "scores.csv")
    half = len(rows) // 2
    assert [row.test_seed for row in rows] == [1] * half + [2] * half
    assert [row.joint for row in rows[:half]] == [row.joint for row in rows[half:]]


def test_an_estimate_of_another_run_is_refused(walk: Walk, layout: JointLayout) -> None:
    entry = {**walk(1.0), "residual": walk(1.0, steps=3)["residual"]}
    with pytest.raises(DataError, match=r"rows is 560, but 420"):
        score_run(layout, "walk", entry)


def test_an_estimate_without_torque_is_refused(tmp_path: Path, walk: Walk, layout: JointLayout) -> None:
    write_array(tmp_path / "e", np.ones((560, 1)), [("std.LL1", "N m", "joint")], {"rate_hz": 100.0})
    with pytest.raises(DataError, match=r"no column tau_ext\.<joint>; it holds std\.LL1"):
        score_run(layout, "walk", {**walk(1.0), "estimate": tmp_path / "e"})


def test_a_residual_without_the_truth_is_refused(tmp_path: Path, walk: Walk, layout: JointLayout) -> None:
    write_array(tmp_path / "r", np.ones((560, 1)), [("r.LL1", "N m", "joint")], {"rate_hz": 100.0})
    with pytest.raises(DataError, match=r"column 'tau_ext_lp\.LL1' is missing"):
        score_run(layout, "walk", {**walk(1.0), "residual": tmp_path / "r"})


def test_pushes_are_scored_each_and_together(tmp_path: Path, walk: Walk, layout: JointLayout) -> None:
    entry = walk(2.0)
    rows = np.arange(560)
    pushed = np.isin(rows, [*range(100, 110), *range(300, 330)])
    error = np.where(rows < 200, 1.0, 3.0) * pushed
    write_array(tmp_path / "recording", pushed[:, None].astype(float), [("pushed", "-", "-")], {"rate_hz": 100.0})
    truth, _ = read_array(Path(entry["residual"]), ["tau_ext_lp.LL3"])
    write_array(tmp_path / "e", truth + error[:, None], [("tau_ext.LL3", "N m", "joint")], {"rate_hz": 100.0})
    entry |= {"recording": tmp_path / "recording", "estimate": tmp_path / "e"}
    at_once = {"before_s": 0.0, "after_s": 0.0}
    values = {row.metric: row.value for row in score_run(layout, "knee", entry, at_once) if row.joint == "LL3"}
    expected = {"rmse_push_1": 1.0, "rmse_push_2": 3.0, "rmse_pushed": 7.0**0.5, "rmse": (280 / 560) ** 0.5}
    assert {name: values[name] for name in expected} == pytest.approx(expected, rel=1e-5)
    wide = score_run(layout, "knee", entry, {"before_s": 0.1, "after_s": 0.2})
    assert next(row.value for row in wide if row.metric == "rmse_push_1") == pytest.approx(0.5, rel=1e-5)
    assert not [row for row in score_run(layout, "knee", entry) if "push" in row.metric]


def test_a_run_without_a_push_has_no_row_of_pushes(tmp_path: Path, walk: Walk, layout: JointLayout) -> None:
    write_array(tmp_path / "recording", np.zeros((560, 1)), [("pushed", "-", "-")], {"rate_hz": 100.0})
    entry = walk(2.0) | {"recording": tmp_path / "recording"}
    rows = score_run(layout, "knee", entry, {"before_s": 0.1, "after_s": 0.2})
    assert {row.metric for row in rows} == {"rmse", "roughness", "r_rmse"}


def test_relative_error_is_a_percentage_and_left_out_where_there_is_no_torque(
    tmp_path: Path, walk: Walk, layout: JointLayout
) -> None:
    entry = walk(3.0)
    residual, _ = read_array(Path(entry["residual"]), [f"tau_ext_lp.LL{k}" for k in range(1, 7)])
    residual[:, 2] = 0.0
    columns = [(f"tau_ext_lp.LL{k}", "N m", "joint") for k in range(1, 7)]
    write_array(tmp_path / "r", residual, columns, {"rate_hz": 100.0})
    rows = [row for row in score_run(layout, "walk", entry | {"residual": tmp_path / "r"}) if row.metric == "r_rmse"]
    assert [row.joint for row in rows] == ["LL1", "LL2", "LL4", "LL5", "LL6", "avg"]
    assert {row.unit for row in rows} == {"%"}
    assert rows[0].value == pytest.approx(300.0 / np.abs(residual[:, 0]).max(), rel=1e-5)
