"""Looks, as figures draw them."""

import numpy as np
import pytest

from experiments.evaluation.figures.drawing.robot import lowest
from experiments.settings.settings import Settings
from mobnet.robot.description import WalkingRobot, dressed


def test_looks_stand_on_the_same_soles_and_are_as_high_as_the_robot(settings: Settings, robot: WalkingRobot) -> None:
    shown, q = dressed(robot, settings.robot.looks), np.eye(1, robot.layout.nq, 3)[0]
    assert lowest(shown, q) == pytest.approx(lowest(robot, q))
    heads = [max(row.pos[2] + row.size[-1] for row in one.shapes if row.body == "Head_Link") for one in (robot, shown)]
    assert heads[0] == pytest.approx(heads[1], abs=0.02)
