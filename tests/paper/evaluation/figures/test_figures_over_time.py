"""Figures 5, 7, 8, 9 and 12 show the joints and the stretch asked for, each curve off the truth by its error.

Their bars have errors of all walks beside those of the curves, and the paper's.
"""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from called import call
from csv_files import check_golden, read_table, write_rows

from experiments.evaluation.figures.paper.figure_05 import read_panel
from experiments.plan.items import walks
from experiments.plan.runs import Run
from experiments.records.scores import Score
from experiments.settings.evaluation import Evaluation
from experiments.settings.settings import Settings
from mobnet.core.joints import JointLayout

Walk = Callable[..., Run]
Draw = Callable[..., None]
START_S, CYCLE_ROWS = 1.0, 140
OFF = {"MOB": -15.0, "MOB-Net": 1.5}  # errors of the curves [N m]
MEANS = {"zero": 40.0, "MOB": 20.0, "MOB-Net": 2.0}  # errors over all walks [N m]


@pytest.fixture
def draw(settings: Settings, evaluation: Evaluation, tmp_path: Path) -> Draw:
    """Return a function of (name, runs) that writes a figure beside scores of all its joints, which are MEANS."""

    def write(name: str, runs: Sequence[Run]) -> None:
        section = getattr(evaluation, name)
        tests = getattr(section, "panels", {getattr(section, "level", ""): section})
        metric, layout = getattr(section, "metric", "rmse"), settings.layout
        rows = [
            Score(section.scenario, level, method, 0, walk, limb, joint, metric, mean, layout.unit(joint))
            for level in tests
            for method, mean in MEANS.items()
            for walk in (1, 2)
            for limb, joints in layout.groups.items()
            for joint in joints
        ]
        write_rows(tmp_path / "scores.csv", rows)
        own: dict[str, Any] = {"settings": section, "name": name, "start_s": START_S, "runs": runs}
        own |= {"scores": [tmp_path / "scores.csv"], "published": settings.published.tables[section.table]}
        shared = {**dict(settings), "layout": layout, "statistics": evaluation.statistics, "figure_dir": tmp_path}
        call(getattr(walks, name)(), {**shared, **own})

    return write


def bars_of(folder: Path, name: str) -> dict[tuple[str, str, str], tuple[Any, Any, Any]]:
    """Return level, method and joint -> the error, the paper's and that of the curve [N m] of a figure's bars."""
    rows = read_table(folder / f"{name}_bars.csv")
    return {(row.level, row.method, row.joint): (row.value, row.published, row.rmse_drawn) for row in rows}


def test_panel_of_figure_05_holds_the_cycle_of_the_joint(walk: Walk, layout: JointLayout) -> None:
    panel = read_panel(layout, [walk(2.0)], "LL3", START_S)
    assert panel.title == "all uncertainty"
    assert len(panel.time) == CYCLE_ROWS
    assert panel.time[0] == 0.0
    assert panel.flags["swing"].sum() == CYCLE_ROWS // 2
    truth, estimate = panel.curves
    np.testing.assert_allclose(estimate.values - truth.values, 2.0, rtol=1e-4)


def test_figure_05_is_written_as_vector_picture_and_numbers(tmp_path: Path, walk: Walk, draw: Draw) -> None:
    runs = [walk(0.0, method="zero"), *(walk(error, method=method) for method, error in OFF.items())]
    draw("figure_05", runs)
    assert (tmp_path / "figure_05.pdf").read_bytes().startswith(b"%PDF")
    assert (tmp_path / "figure_05.png").read_bytes().startswith(b"\x89PNG")
    assert b"<svg" in (tmp_path / "figure_05.svg").read_bytes()
    lines = (tmp_path / "figure_05.csv").read_text().splitlines()
    assert lines[0] == "panel,time_s,swing,truth,MOB,MOB-Net"  # zero is a bar, and no curve
    assert len(lines) == 1 + CYCLE_ROWS
    bars = bars_of(tmp_path, "figure_05")
    assert bars["all_uncertainty", "MOB", "LL3"] == (20.0, 18.67, pytest.approx(15.0, rel=1e-4))
    assert bars["all_uncertainty", "zero", "LL3"][:2] == (40.0, None)
    assert bars["all_uncertainty", "FTS-e2e", "LL3"] == (None, 2.47, None)  # it was not run
    check_golden(tmp_path / "figure_05.csv", tmp_path / "figure_05_bars.csv")


@pytest.mark.parametrize(
    ("name", "level", "joints"),
    [("figure_07", "all_uncertainty", ["W2", "V3"]), ("figure_12", "robots", ["W2", "RA2", "V3"])],
)
def test_hand_figures_show_every_so_many_samples_of_each_joint_with_its_unit(
    tmp_path: Path, walk: Walk, draw: Draw, evaluation: Evaluation, name: str, level: str, joints: list[str]
) -> None:
    section = getattr(evaluation, name)
    assert list(section.joints) == joints
    draw(name, [walk(-15.0, method="MOB", joints=joints), walk(1.5, joints=joints, std=0.5)])
    rows = read_table(tmp_path / f"{name}.csv")
    units = ["N" if joint == "V3" else "N m" for joint in joints]
    titles = [f"{joint} [{unit}]" for joint, unit in zip(joints, units, strict=True)]
    assert list(dict.fromkeys(row.panel for row in rows)) == titles
    assert [row.time_s for row in rows[:10]] == pytest.approx([0.05 * k for k in range(10)])
    assert len(rows) == 10 * len(joints)
    for row in map(vars, rows):
        assert row["MOB-Net"] - row["truth"] == pytest.approx(1.5, abs=1e-3)
        assert row["MOB-Net std"] == 0.5
        assert section.called in row
    bars = bars_of(tmp_path, name)
    assert bars[level, "MOB-Net", "V3"][0] == 2.0
    assert bars[level, "MOB-Net", "W2"][2] == pytest.approx(1.5, rel=1e-4)
    # errors of a limb, over that of no estimate
    for limb in ("W", "V1 to V3"):
        assert bars[level, "MOB", limb][0] == pytest.approx(MEANS["MOB"] / MEANS["zero"])
        assert bars[level, "MOB-Net", limb][0] == pytest.approx(MEANS["MOB-Net"] / MEANS["zero"])
    check_golden(tmp_path / f"{name}.csv", tmp_path / f"{name}_bars.csv")


def test_figure_08_shows_target_prediction_and_error_of_every_joint(tmp_path: Path, walk: Walk, draw: Draw) -> None:
    draw("figure_08", [walk(1.5, std=0.5)])
    rows = read_table(tmp_path / "figure_08.csv")
    assert list(dict.fromkeys(row.panel for row in rows)) == [f"LL{i}" for i in range(1, 7)]
    assert len(rows) == 6 * CYCLE_ROWS
    for row in map(vars, rows):
        assert [row["target"], row["MOB-Net"], row["MOB-Net std"]] == pytest.approx([5.0, 3.5, 0.5], rel=1e-4)
    assert bars_of(tmp_path, "figure_08")["robots", "MOB-Net", "LL2"] == (2.0, 6.266, pytest.approx(1.5, rel=1e-4))
    check_golden(tmp_path / "figure_08.csv", tmp_path / "figure_08_bars.csv")


def test_figure_09_has_every_method_on_every_joint_and_draws_some(tmp_path: Path, walk: Walk, draw: Draw) -> None:
    draw("figure_09", [walk(error, method=method) for method, error in OFF.items()])
    rows = read_table(tmp_path / "figure_09.csv")
    assert list(dict.fromkeys(row.panel for row in rows)) == [f"LL{i}" for i in range(1, 7)]
    for row in map(vars, rows[70:80]):
        assert [row[method] - row["truth"] for method in OFF] == pytest.approx(list(OFF.values()), rel=1e-3)
    assert {joint for _, _, joint in bars_of(tmp_path, "figure_09")} == {f"LL{i}" for i in range(1, 7)}
    svg = (tmp_path / "figure_09.svg").read_text()
    for title in ("(a) hip roll (LL2)", "(b) hip pitch (LL3)", "(c) knee (LL4)"):
        assert f"<!-- {title} -->" in svg
    assert "LL5" not in svg
    check_golden(tmp_path / "figure_09.csv", tmp_path / "figure_09_bars.csv")
