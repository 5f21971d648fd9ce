"""What is computed of long logs in pieces is what whole arrays give."""

from pathlib import Path

import numpy as np
import pytest

from mobnet.formats.loading import load_section
from mobnet.formats.plain import as_plain
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel
from mobnet.robotlog.hints.bounds import HintBounds
from mobnet.robotlog.hints.changes import Seen, _needed_by_angle, _waves
from mobnet.robotlog.hints.columns import _clipped, held_share
from mobnet.robotlog.hints.motion import turns
from mobnet.robotlog.hints.windows import MotionWindows
from mobnet.robotlog.pieces import PIECE_ROWS, pieces, ranges, root_mean_square

ROWS = 2 * PIECE_ROWS + 77


@pytest.fixture
def values():
    return np.random.default_rng(0).normal(size=(ROWS, 3))


def test_pieces_follow_each_other_up_to_the_end():
    found = list(pieces(1, ROWS))
    np.testing.assert_array_equal(np.concatenate([np.arange(ROWS)[rows] for rows in found]), np.arange(1, ROWS))


def test_ranges_and_means_are_those_of_the_whole(values):
    low, high = ranges(values)
    np.testing.assert_array_equal(low, values.min(axis=0))
    np.testing.assert_array_equal(high, values.max(axis=0))
    np.testing.assert_allclose(root_mean_square(values), np.sqrt(np.square(values).mean(axis=0)), rtol=1e-12)


def test_integrals_are_those_of_one_sum_to_the_bit(values):
    _, integral = turns(values, values, [slice(5, ROWS)], 1000.0, 0.1)
    speed = values[5:]
    travelled = np.zeros(speed.shape)
    np.cumsum((speed[1:] + speed[:-1]) / 2000.0, axis=0, out=travelled[1:])
    np.testing.assert_array_equal(integral, np.diff(travelled[::100], axis=0))


def test_a_window_is_a_sample_at_least(values):
    change, integral = turns(values, values, [slice(0, 50)], 2.0, 0.1)
    np.testing.assert_array_equal(change, np.diff(values[:50], axis=0))
    np.testing.assert_allclose(integral, (values[1:50] + values[:49]) / 4.0)


def test_shares_count_every_sample(values):
    coarse = np.round(values.clip(-1.0, 1.0), 1)
    same, moves = coarse[1:] == coarse[:-1], coarse[1:] != 0.0
    np.testing.assert_array_equal(held_share(coarse), (same & moves).sum(axis=0) / moves.sum(axis=0))
    at_ends = np.maximum((coarse == 1.0).sum(axis=0), (coarse == -1.0).sum(axis=0))
    np.testing.assert_array_equal(_clipped(coarse, *ranges(coarse)), at_ends / ROWS)


@pytest.mark.parametrize(("table", "joint"), [("tests/data/arm.yaml", 0), ("configs/robots/tocabi.yaml", 3)])
def test_five_angles_of_a_joint_tell_all_others(table, joint, settings):
    robot = describe(load_section(Path(table), RobotTable))
    nominal, rng = NominalModel(robot), np.random.default_rng(1)
    layout = robot.layout
    q, v = rng.normal(size=(4, 11, layout.nq)), rng.normal(size=(4, 11, layout.nv))
    none = np.zeros((4, layout.nu))
    loads = {side: rng.normal(size=(4, 11, 6)) for side in robot.feet}
    windows = MotionWindows(q, v, none, none, loads, 0.1)
    seen = Seen(nominal, as_plain(settings.robotlog, HintBounds), windows, windows.asked(nominal), none[0], (), (), ())
    by_angle = _needed_by_angle(seen, windows, joint)
    for shift in (-2.0, 0.0, 0.3):
        turned = q.copy()
        turned[..., joint - layout.nu] += shift
        needed = MotionWindows(turned, v, none, none, loads, 0.1).needed(nominal)[:, joint]
        np.testing.assert_allclose((_waves(np.array([shift])) @ by_angle)[0], needed, atol=1e-9)
