"""Sizes of the uncertainty torque are standard deviations over whole sets, beside the robot's."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from csv_files import check_golden_table, read_table

from experiments.evaluation.tables.further.uncertainty import target_std, verdict
from experiments.evaluation.tables.layout import OUTSIDE, note_tex
from experiments.settings.settings import Settings
from mobnet.core.store import read_array, write_array


def test_standard_deviation_file_by_file_is_equivalent_to_that_of_all_samples_together(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    parts = [rng.normal(1000.0 * k, 1.0 + k, (n, 4)) for k, n in enumerate((50, 400, 7))]
    columns = [(name, "N m", "joint") for name in ("r.A", "r.B", "tau_ext_lp.A", "tau_ext_lp.B")]
    stems = [tmp_path / f"s{k}" for k in range(3)]
    for stem, part in zip(stems, parts, strict=True):
        write_array(stem, part, columns, {"rate_hz": 1.0})
    stored = np.concatenate([read_array(stem)[0] for stem in stems]).astype(float)
    np.testing.assert_allclose(target_std(stems, ["A", "B"]), (stored[:, :2] - stored[:, 2:]).std(axis=0), rtol=1e-12)


def test_rows_stand_beside_the_robots_numbers_above_the_note(
    make_table: Callable[..., Path], settings: Settings, data_sets: dict[str, list[Path]]
) -> None:
    sets = {name: [stem.with_name(f"{stem.name}_residual") for stem in stems] for name, stems in data_sets.items()}
    networks = {limb: settings.networks[limb] for limb in ("LL", "W", "V")}
    bounds = settings.evaluation.uncertainty.model_copy(update={"ratio": {"LL": (0.4, 2.5)}})
    table = make_table("uncertainty", settings=bounds, networks=networks, sets=sets, robots={})
    check_golden_table(table)
    rows = {row.joint: row for row in read_table(table)}
    assert list(rows) == [*(f"LL{i}" for i in range(1, 7)), "W1", "W2", "W3", *(f"V{i}" for i in range(1, 7))]
    assert rows["LL1"].value == pytest.approx(20.0, rel=0.05)  # as the made-up residuals are
    assert rows["W1"].value == pytest.approx(10.0, rel=0.05)
    assert rows["LL1"].published == 9.7
    assert rows["V1"].ratio == pytest.approx(rows["V1"].value / 47.6, rel=1e-4)
    assert {row.within for row in rows.values() if row.limb != "LL"} == {None}
    assert rows["LL2"].within == "yes"
    assert (rows["V1"].unit, rows["V4"].unit) == ("N", "N m")
    note = settings.published.uncertainty.note
    assert note in table.with_suffix(".md").read_text()
    assert table.with_suffix(".tex").read_text().endswith(note_tex(note))


def test_each_surrogate_robot_has_its_rows_and_bounds(
    make_table: Callable[..., Path], settings: Settings, data_sets: dict[str, list[Path]]
) -> None:
    """Of the limbs whose set it has."""
    sets = {name: [stem.with_name(f"{stem.name}_residual") for stem in stems] for name, stems in data_sets.items()}
    networks = {limb: settings.networks[limb] for limb in ("LL", "W")}
    robots = {"robot_1": {"walk": sets["walk"]}, "robot_2": {"walk": sets["walk_plain"]}}
    rows = read_table(make_table("uncertainty", networks=networks, sets=sets, robots=robots))
    assert [row.set for row in rows if row.joint in ("LL1", "W1")] == ["walk", "robot_1", "robot_2", "motion"]
    own = [row for row in rows if row.set == "robot_1"]
    assert [row.joint for row in own] == [f"LL{i}" for i in range(1, 7)]
    low, high = settings.evaluation.uncertainty.robot_ratio
    assert [row.within for row in own] == ["yes" if low <= row.ratio <= high else "no" for row in own]


def test_a_line_is_a_joint_with_a_size_and_a_marked_ratio_of_every_plant(
    make_table: Callable[..., Path], settings: Settings, data_sets: dict[str, list[Path]]
) -> None:
    """So that the table fits a page with three robots."""
    sets = {name: [stem.with_name(f"{stem.name}_residual") for stem in stems] for name, stems in data_sets.items()}
    networks = {limb: settings.networks[limb] for limb in ("LL", "W")}
    bounds = settings.evaluation.uncertainty.model_copy(update={"ratio": {"LL": (0.0, 1.5)}})
    robots = {"robot_1": {"walk": sets["walk"]}}
    table = make_table("uncertainty", settings=bounds, networks=networks, sets=sets, robots=robots)
    lines = table.with_suffix(".md").read_text().splitlines()
    assert lines[0] == "| Limb | Joint | Set | Unit | Original | plant | ratio | robot 1 | ratio |"
    rows = {(row.joint, row.set): row for row in read_table(table)}
    one, robot = rows["LL1", "walk"], rows["LL1", "robot_1"]
    sizes = f"{one.value:.1f} | {one.ratio:.2f}{OUTSIDE} | {robot.value:.1f} | {robot.ratio:.2f}{OUTSIDE} |"
    assert lines[2] == f"| LL | LL1 | walk | N m | 9.7 | {sizes}"  # twice as large as the robot's
    assert lines[3].count(OUTSIDE) == 1  # 0.42 of it, within the plant's bounds
    assert lines[8].endswith(f"{rows['W1', 'motion'].value:.1f} | {rows['W1', 'motion'].ratio:.2f} | - | - |")


def test_bounds_are_closed_and_a_missing_number_is_no_verdict() -> None:
    assert [verdict(ratio, [0.4, 2.5]) for ratio in (0.39, 0.4, 2.5, 2.51)] == ["no", "yes", "yes", "no"]
    assert verdict(None, [0.4, 2.5]) == verdict(1.0, None) == ""
