"""The check of a leg's free swing tells a network that knows its robot from one that does not."""

import numpy as np
import pytest

from mobnet.learning.calibration import shares_inside

SHARE = 0.68
SPANS = [(0, 20_000), (20_000, 30_000)]


@pytest.fixture
def free():
    """A leg that swings every other second."""
    return np.arange(30_000) // 1000 % 2 == 1


@pytest.mark.parametrize(("ratio", "low", "high"), [(1.0, 0.66, 0.70), (2.0, 0.35, 0.41), (0.5, 0.94, 0.97)])
def test_the_share_is_the_nominal_one_where_the_deviation_is_right(free, ratio, low, high):
    """A closed form of normal errors; what stands in stance does not matter."""
    std = np.full((30_000, 6), 0.8)
    estimate = ratio * std * np.random.default_rng(0).normal(size=std.shape)
    estimate[~free] = 100.0
    shares = shares_inside(estimate, std, free, SPANS, 10_000, SHARE)
    assert shares.shape == (3,)
    assert (low <= shares).all()
    assert (shares <= high).all()


def test_a_window_without_a_swing_tells_nothing(free):
    free[:10_000] = False
    shares = shares_inside(np.zeros((30_000, 2)), np.ones((30_000, 2)), free, SPANS, 10_000, SHARE)
    assert np.isnan(shares).tolist() == [True, False, False]
    assert shares_inside(np.zeros((5000, 2)), np.ones((5000, 2)), free[:5000], [(0, 5000)], 10_000, SHARE).shape == (0,)
