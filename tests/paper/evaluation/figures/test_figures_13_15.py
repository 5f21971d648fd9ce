"""Figures of collisions: pictures at the largest force, histograms of all, standard deviations around three."""

from pathlib import Path

import numpy as np
import pytest
from csv_files import check_golden, read_table, write_rows
from made_detections import SEED, write_detections
from made_swings import GROUND, RATE_HZ, swinging, unseen

from experiments.evaluation.figures.drawing.robot import lowest, projection
from experiments.evaluation.figures.drawing.solids import Solid, outline_of
from experiments.evaluation.figures.paper.figure_13 import figure_13
from experiments.evaluation.figures.paper.figure_14 import figure_14
from experiments.evaluation.figures.paper.figure_15 import figure_15
from experiments.records.collisions import Collision
from experiments.settings.settings import Settings
from mobnet.core.columns import torque_columns
from mobnet.core.detections import Threshold
from mobnet.core.errors import DataError
from mobnet.core.recording import Recording
from mobnet.core.recording_file import write_recording
from mobnet.core.store import write_array
from mobnet.robot.description import WalkingRobot

START, LENGTH, PEAK = GROUND + 150, 78, 150.0  # of the collision, in samples and [N]
CELLS = ("foot front",)
Made = tuple[Path, dict[str, dict[str, Path]], Path]


@pytest.fixture
def made(settings: Settings, tmp_path: Path) -> Made:
    """A recording of a collision with the front of the left foot, the files of its detectors, and an estimate."""
    layout, sensed = settings.layout, swinging(settings.layout, 1)
    push = np.zeros((len(sensed), 4))
    force = PEAK * np.sin(np.pi * np.arange(LENGTH) / LENGTH)
    push[START : START + LENGTH, 0], push[START : START + LENGTH, 1] = 1, -force
    stem = tmp_path / f"s{SEED}"
    write_recording(
        stem, Recording(sensed, ((0, len(sensed)),), RATE_HZ, {}, unseen(layout, len(sensed), push)), layout
    )
    std = np.tile(np.linspace(1.0, 2.0, len(sensed))[:, None], 12)
    columns = torque_columns(layout, ["tau_ext", "std"], layout.limb("LL"))
    write_array(tmp_path / "estimate" / f"s{SEED}", std, columns, {"rate_hz": RATE_HZ})
    times = START / RATE_HZ, (START + 5) / RATE_HZ, (START + LENGTH) / RATE_HZ
    hit = Collision("collisions", SEED, 1, "collision_left_foot_front", "LL", "foot", "front", *times, PEAK, 7.0, 0.4)
    rows = [Threshold(f"{name}-sigma", "LL", "largest", "std.LL3", 1, 3.0, "N m") for name in ("MOB-Net", "FTS-e2e")]
    files = {name: tmp_path / f"{name}.csv" for name in ("collisions", "thresholds")}
    write_rows(files["collisions"], [hit], Collision)
    write_rows(files["thresholds"], rows, Threshold)
    return stem, {"robot_1": files}, tmp_path / "estimate" / f"s{SEED}"


def test_a_picture_shows_the_collision_when_its_force_is_largest(
    settings: Settings, made: Made, tmp_path: Path
) -> None:
    stem, detections, _ = made
    section = settings.evaluation.figure_13.model_copy(update={"cells": CELLS})
    figure_13(section, settings.detection, settings.robot, settings.robot.looks, detections, [stem], tmp_path)
    (row,) = read_table(tmp_path / "figure_13.csv")
    assert (row.panel, row.force_n) == ("foot front", pytest.approx(PEAK, rel=0.01))
    assert row.time_s == pytest.approx((START + LENGTH / 2) / RATE_HZ, abs=0.002)
    assert row.force_x_n == pytest.approx(-PEAK, rel=0.01)
    assert row.point_x_m > 0.1  # ahead of the base
    assert row.point_z_m == pytest.approx(0.1, abs=0.15)  # near the ground
    wrong = section.model_copy(update={"cells": ("knee front",)})
    with pytest.raises(DataError, match="collision of LL in collisions: 'knee front' is not accepted"):
        figure_13(wrong, settings.detection, settings.robot, settings.robot.looks, detections, [stem], tmp_path)


def test_solids_are_seen_as_large_as_they_are(robot: WalkingRobot) -> None:
    view = projection(0.0, 0.0)  # from ahead: right is the robot's left, up is up
    np.testing.assert_allclose(view, [[0, 1, 0], [0, 0, 1], [1, 0, 0]], atol=1e-12)
    foot = next(shape for shape in robot.shapes if shape.name == "left_foot")
    outline = outline_of(Solid(foot, np.eye(3), np.zeros(3), "0.5"), view)
    np.testing.assert_allclose(np.ptp(outline, axis=0), [2 * foot.size[1], 2 * foot.size[2]])
    thigh = next(shape for shape in robot.shapes if shape.name == "left_thigh")
    outline = outline_of(Solid(thigh, np.eye(3), np.zeros(3), "0.5"), view)
    assert np.ptp(outline[:, 1]) == pytest.approx(0.23 + 2 * thigh.size[0], rel=0.01)  # of a polygon
    q = np.eye(1, robot.layout.nq, 3)[0]
    assert lowest(robot, q) < -0.8


def test_histograms_count_every_collision(settings: Settings, tmp_path: Path) -> None:
    figure_14(
        settings.evaluation.figure_14,
        settings.detection,
        settings.published.section_5_3,
        write_detections(tmp_path / "detection"),
        tmp_path,
    )
    rows = read_table(tmp_path / "figure_14.csv")
    for level in ("all uncertainty", "robots"):
        for quantity in ("largest force", "impulse", "contact time"):
            own = [row for row in rows if (row.level, row.quantity) == (level, quantity)]
            assert sum(row.count for row in own) == 24
            assert own[0].bin_from <= own[0].least <= own[0].mean <= own[0].most <= own[-1].bin_to
    assert {row.published for row in rows} == {None, 7.0, 78.0}
    check_golden(tmp_path / "figure_14.csv")


def test_standard_deviations_stand_beside_force_and_threshold(settings: Settings, made: Made, tmp_path: Path) -> None:
    stem, detections, estimate = made
    section = settings.evaluation.figure_15.model_copy(update={"cells": CELLS, "kind": "largest"})
    estimates = {"MOB-Net": [estimate], "FTS-e2e": [estimate]}
    figure_15(section, settings.detection, settings.layout, detections, [stem], estimates, tmp_path)
    rows = [row for row in read_table(tmp_path / "figure_15.csv") if row.method == "MOB-Net"]
    assert (rows[0].time_s, rows[0].threshold_nm) == (pytest.approx(-0.2), 3.0)
    assert max(row.force_n for row in rows) == pytest.approx(PEAK, rel=0.01)
    assert {row.force_n > 0 for row in rows if row.time_s < 0} == {False}
    assert {row.swing for row in rows if -0.15 < row.time_s < 0.19} == {1.0}
    assert rows[0].std_nm < rows[-1].std_nm
