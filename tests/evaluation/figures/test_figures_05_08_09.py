"""The gait cycle of Figure 5 begins at a lift-off, ends at the next, and lies within one segment."""

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mobnet.core.errors import ConfigError, DataError
from mobnet.evaluation.figures.figure_05 import figure_05, read_panel
from mobnet.evaluation.figures.figure_08 import figure_08
from mobnet.evaluation.figures.figure_09 import figure_09
from mobnet.evaluation.measure.gait import foot_of, gait_cycle

Walk = Callable[..., dict[str, Any]]
AIR = np.array([1, 1, 0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 1, 0, 0, 1], dtype=bool)  # lift-offs at 5, 9, 12, 15
WHOLE = ((0, len(AIR)),)


@pytest.mark.parametrize(("start", "rows"), [(0, (5, 9)), (5, (9, 12)), (4, (5, 9)), (6, (9, 12)), (11, (12, 15))])
def test_cycle_goes_from_the_first_lift_off_after_the_start_to_the_next(start: int, rows: tuple[int, int]) -> None:
    assert gait_cycle(AIR, WHOLE, start) == slice(*rows)


def test_every_cycle_is_one_swing_and_one_stance() -> None:
    for start in range(11):
        rows = gait_cycle(AIR, WHOLE, start)
        assert rows is not None
        swing = AIR[rows]
        assert swing[0]
        assert not swing[-1]
        assert np.count_nonzero(np.diff(swing.astype(int))) == 1


def test_cycle_does_not_cross_a_fall() -> None:
    assert gait_cycle(AIR, ((0, 8), (8, 16)), 0) == slice(9, 12)


def test_no_cycle_is_none() -> None:
    assert gait_cycle(AIR, WHOLE, 13) is None
    assert gait_cycle(np.ones(10, dtype=bool), ((0, 10),), 0) is None


def test_panel_holds_the_cycle_of_the_joint(walk: Walk, config: dict[str, Any]) -> None:
    panel = read_panel(config, walk(2.0), "All uncertainty")
    assert panel.title == "MOB-Net, all uncertainty"
    assert len(panel.time) == 140
    assert panel.time[0] == 0.0
    assert panel.flags["swing"].sum() == 70
    truth, estimate = panel.curves
    np.testing.assert_allclose(estimate.values - truth.values, 2.0, rtol=1e-4)


def test_a_scale_too_short_may_start_earlier(walk: Walk, config: dict[str, Any]) -> None:
    config["evaluation"]["figure_05"]["start_s"] = 100.0
    with pytest.raises(DataError, match=r"no whole gait cycle after 100\.0 s; it lasts 5\.6 s"):
        read_panel(config, walk(1.0), "Ideal")
    config["sizes"]["figure_start_s"] = 1.0
    assert len(read_panel(config, walk(1.0), "Ideal").time) == 140


def test_a_joint_that_is_not_estimated_is_named(walk: Walk, config: dict[str, Any]) -> None:
    config["evaluation"]["figure_05"]["joint"] = "W1"
    with pytest.raises(ConfigError, match="'W1' is not accepted; accepted: LL1"):
        read_panel(config, walk(1.0), "Ideal")


def test_a_foot_belongs_to_its_leg(config: dict[str, Any]) -> None:
    robot = Path(config["robot"])
    assert (foot_of(robot, "LL3"), foot_of(robot, "RL6")) == ("left_foot", "right_foot")
    with pytest.raises(ConfigError, match="leg joint: 'LA1' is not accepted"):
        foot_of(robot, "LA1")


def test_figure_is_written_as_vector_picture_and_numbers(tmp_path: Path, walk: Walk, config: dict[str, Any]) -> None:
    figure_05(config, [walk(1.0, method="MOB"), walk(2.0)], tmp_path)
    assert (tmp_path / "figure_05.pdf").read_bytes().startswith(b"%PDF")
    assert (tmp_path / "figure_05.png").read_bytes().startswith(b"\x89PNG")
    lines = (tmp_path / "figure_05.csv").read_text().splitlines()
    assert lines[0] == "panel,time_s,swing,truth,MOB,MOB-Net"
    assert len(lines) == 1 + 2 * 140


def test_figure_08_tells_target_prediction_and_error_of_every_joint(
    tmp_path: Path, walk: Walk, config: dict[str, Any]
) -> None:
    figure_08(config, [walk(2.0, std=0.5)], tmp_path)
    with (tmp_path / "figure_08.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(dict.fromkeys(row["panel"] for row in rows)) == [f"LL{i}, RMSE 2.00 N m" for i in range(1, 7)]
    assert len(rows) == 6 * 140
    for row in rows:
        assert float(row["target"]) == pytest.approx(5.0, rel=1e-4)
        assert float(row["MOB-Net"]) == pytest.approx(3.0, rel=1e-4)
        assert float(row["MOB-Net std"]) == 0.5


def test_figure_09_shows_every_method_on_every_joint(tmp_path: Path, walk: Walk, config: dict[str, Any]) -> None:
    figure_09(config, [walk(-15.0, method="MOB"), walk(4.0, method="MOB-fric"), walk(2.0)], tmp_path)
    with (tmp_path / "figure_09.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert list(dict.fromkeys(row["panel"] for row in rows)) == [f"LL{i}" for i in range(1, 7)]
    for row in rows[70:80]:
        errors = [float(row[method]) - float(row["truth"]) for method in ("MOB", "MOB-fric", "MOB-Net")]
        assert errors == pytest.approx([-15.0, 4.0, 2.0], rel=1e-3)
