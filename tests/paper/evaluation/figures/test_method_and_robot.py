"""The drawings of method and robot: every limb with a network has its block, and what is named lies on the robot."""

from pathlib import Path

import numpy as np
import pytest
from csv_files import check_golden, read_table

from experiments.evaluation.figures.drawing.method_and_robot import draw_all, draw_method, position_of
from experiments.evaluation.figures.drawing.robot_parts import LIMBS, axes_of, limbs_of
from experiments.settings.settings import Settings
from mobnet.robot.description import WalkingRobot


def draw(settings: Settings, folder: Path) -> list[Path]:
    """Make both drawings in a folder, and return their files."""
    own, push = settings.evaluation.drawings, settings.pushes[settings.evaluation.story.push]
    draw_all(own, push, settings.robot, settings.robot.looks, settings.layout, folder)
    return sorted(folder.iterdir())


def test_drawings_are_equal_files_each_time(settings: Settings, tmp_path: Path) -> None:
    first, second = (draw(settings, tmp_path / name) for name in ("first", "second"))
    names = [f"{name}.{ending}" for name in ("method", "robot") for ending in ("csv", "pdf", "png", "svg")]
    assert [path.name for path in first] == names
    assert all(a.read_bytes() == b.read_bytes() for a, b in zip(first, second, strict=True))
    check_golden(*(path for path in first if path.suffix == ".csv"))


def test_each_limb_with_a_network_stands_in_the_method(settings: Settings) -> None:
    limbs = list(settings.evaluation.drawings.limbs)
    assert set(limbs) == set(settings.methods["MOB-Net"].limbs) - {"N"}  # the neck is no limb of the paper
    figure, signals = draw_method(limbs)
    texts = [text.get_text() for text in figure.axes[0].texts]
    assert all(limb in texts for limb in limbs)
    assert ("foot sensors", "networks", "label of the training") in signals
    assert not any(start == "foot sensors" and end != "networks" for start, end, _ in signals)


def test_every_body_belongs_to_the_limb_that_moves_it(robot: WalkingRobot) -> None:
    limbs = limbs_of(robot)
    assert set(limbs.values()) == set(LIMBS)
    assert (limbs["base_link"], limbs["L_Knee_Link"], limbs["Upperbody_Link"]) == ("V", "LL", "W")
    assert (limbs["R_Wrist2_Link"], limbs["Head_Link"]) == ("RA", "N")


def test_axes_are_those_of_the_joints(settings: Settings, robot: WalkingRobot) -> None:
    q = position_of(settings.evaluation.drawings, settings.robot, settings.layout)
    found = axes_of(robot, q, robot.layout.limb("LL"))
    for joint in ("LL3", "LL4", "LL5"):
        roll = settings.evaluation.drawings.pose_rad["LL2"]
        assert found[joint][1] == pytest.approx([0.0, np.cos(roll), np.sin(roll)], abs=1e-9)
    assert np.linalg.norm(found["LL4"][0] - found["LL3"][0]) == pytest.approx(robot.leg.link_length)


def test_what_is_named_stands_on_the_picture(settings: Settings, tmp_path: Path) -> None:
    draw(settings, tmp_path)
    rows = read_table(tmp_path / "robot.csv")
    assert {row.kind for row in rows} == {"axis", "force", "note"}
    assert all(abs(row.x_m) < 0.5 and abs(row.y_m) < 0.7 and -0.01 < row.z_m < 1.9 for row in rows)
    (push,) = [row for row in rows if row.kind == "force"]
    assert 0.3 < push.z_m < 0.7  # below the knee
