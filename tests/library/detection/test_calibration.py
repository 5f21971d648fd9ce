"""Heights of swings from which thresholds are made: phases that hold no signal, ends of recordings, no swing at all."""

from pathlib import Path

import numpy as np
import pytest

from mobnet.core.estimator import Estimate
from mobnet.detection.calibration import (
    NotWatchedError,
    QuietWalk,
    _cut,
    _over_swings,
    _whitening,
    swing_heights,
    usual_largest,
)
from mobnet.detection.detector import GateSignal
from mobnet.detection.signals import Watched, whitening_of
from mobnet.detection.watch import LegRecording, LimbSetup
from mobnet.kernel.detecting import WatchedSignals

RATE_HZ, ROWS = 1000.0, 1000


@pytest.fixture
def setup(settings, robot):
    return LimbSetup(settings.detection, robot, "LL", RATE_HZ)


def recorded(swings, phase=0.0, seed=1):
    """Return a leg in a recording of a second, watched all the time."""
    gate = GateSignal(np.ones(ROWS, dtype=bool), np.full(ROWS, phase))
    return LegRecording(Path(f"s{seed}"), ((0, ROWS),), np.zeros((ROWS, 5)), gate, swings, ("-",) * len(swings))


def test_a_phase_that_never_holds_a_signal_in_a_swing_does_not_count_in_that_swing():
    """Zero is what a signal is that was watched for too short a time to be held: no height, and no small one."""
    heights = np.array([[[1.0], [0.0]], [[3.0], [5.0]], [[2.0], [-np.inf]]])
    assert _over_swings(heights, np.min).tolist() == [[1.0], [5.0]]
    assert _over_swings(heights, len).tolist() == [[3.0], [1.0]]


def test_a_phase_of_zeros_alone_takes_the_largest_other_number():
    heights = np.array([[[1.0], [0.0], [4.0]], [[3.0], [0.0], [2.0]]])
    assert _over_swings(heights, np.max).tolist() == [[3.0], [4.0], [4.0]]
    with pytest.raises(NotWatchedError):
        _over_swings(heights[:, 1:2], np.max)


def test_the_usual_largest_is_the_median_over_parts_of_equal_length():
    heights = np.arange(1.0, 8.0)[:, None, None] * [[[1.0, 10.0]]]
    # parts of two swings have 2, 4 and 6, the seventh swing is left over
    assert usual_largest(heights, 2).tolist() == [[4.0, 40.0]]
    assert usual_largest(heights, 100).tolist() == [[7.0, 70.0]]  # a walk that is shorter is one part


def test_the_end_of_a_swing_is_in_its_last_phase(setup):
    """A phase of exactly 1 lies in none of the parts that are cut half-open."""
    walk = QuietWalk.of(setup, "", [recorded(((100, 900),), phase=1.0)], [Estimate(np.ones((ROWS, 6)))], share=1.0)
    watched = Watched(WatchedSignals(signals=("mean",), phases=4))
    heights = swing_heights(setup, watched, walk)
    assert heights.shape == (1, 4, 6)
    assert np.isneginf(heights[0, :3]).all()
    assert heights[0, 3] == pytest.approx(1.0, rel=1e-3)


def test_a_walk_without_a_swing_has_none_that_calibrate(setup):
    walk = QuietWalk.of(setup, "", [recorded(())], [Estimate(np.zeros((ROWS, 6)))], share=0.5)
    assert (walk.first, walk.hours) == (0, 0.0)


def test_segments_are_cut_before_a_row():
    assert _cut(((0, 10), (10, 20), (20, 30)), 15) == ((0, 10), (10, 15))
    assert _cut(((0, 10), (10, 20)), 20) == ((0, 10), (10, 20))
    assert _cut(((0, 10),), 0) == ()


def test_signals_are_whitened_by_the_calibrating_swings_of_all_recordings_alone(setup):
    """Three of four swings calibrate: both of the first recording, and one of the second."""
    rng = np.random.default_rng(0)
    legs = [recorded(((100, 400), (500, 800)), seed=seed) for seed in (1, 2)]
    signals = [rng.normal(size=(ROWS, 6)) for _ in legs]
    walk = QuietWalk.of(setup, "", legs, [Estimate(each) for each in signals], share=0.75)
    low = [setup.low_passed(each, ((0, ROWS),)) for each in signals]
    expected = whitening_of(np.concatenate([low[0][:800], low[1][:400]]))
    np.testing.assert_allclose(_whitening(setup, walk, signals), expected)
    first = QuietWalk.of(setup, "", legs, [Estimate(each) for each in signals], share=0.25)
    np.testing.assert_allclose(_whitening(setup, first, signals), whitening_of(low[0][:400]))
