"""Signals of an estimate, their names, what they grow with, and the whitening after which they have one size."""

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.core.estimator import Estimate
from mobnet.detection.signals import Watched, slopes_of, whitening_of
from mobnet.kernel.detecting import WatchedSignals

ESTIMATE = Estimate(np.array([[4.0, -2.0]]), np.array([[2.0, 0.5]]))
IN_PLACE = np.array([[0.0, 0.0, 0.0, 0.7, 0.055]])


@pytest.mark.parametrize(("signals", "expected"), [
    (("mean",), [4, -2]), (("std",), [2, 0.5]), (("ratio",), [2, -4]), (("mean", "std"), [4, -2, 2, 0.5]),
])  # fmt: skip
def test_signals_are_those_of_the_estimate(signals, expected):
    watched = Watched(WatchedSignals(signals))
    assert watched.of(ESTIMATE, IN_PLACE).tolist() == [expected]
    assert len(watched.names(["LL1", "LL2"])) == len(expected)
    assert watched.names(["LL1", "LL2"])[0] == f"{signals[0]}.LL1"


def test_a_method_without_standard_deviations_has_no_signal_of_them():
    watched = Watched(WatchedSignals(("std",)))
    with pytest.raises(DataError, match="signal 'std': the estimate has no columns std"):
        watched.of(Estimate(ESTIMATE.tau_ext), IN_PLACE)


def test_signals_are_smaller_where_the_command_lets_one_expect_more():
    slopes = np.array([[5.0, 0.0, 0.0], [0.0, 0.0, 2.0]])
    watched = Watched(WatchedSignals(signals=("mean",), commanded=True), slopes)
    turning = np.array([[-0.2, 0.1, 0.5, 0.7, 0.055]])  # one fifth of a metre back, half a radian to the left
    assert watched.of(ESTIMATE, IN_PLACE).tolist() == [[4.0, -2.0]]
    assert watched.of(ESTIMATE, turning).tolist() == [[2.0, -1.0]]
    assert watched.of(Estimate(ESTIMATE.tau_ext[0]), turning[0]).tolist() == [2.0, -1.0]
    assert watched.relative(ESTIMATE.tau_ext[:, :1], turning).tolist() == [[2.0]]


def test_slopes_are_those_of_a_quantile_and_never_negative():
    rng = np.random.default_rng(0)
    commands = rng.uniform(-1.0, 1.0, (3000, 3)) * (0.2, 0.1, 0.4)
    ahead, side, turn = np.abs(commands).T
    noise = rng.uniform(0.0, 1.0, (3000, 2))
    # below 0.9 of noise lies 0.9 of it; the second signal falls with a step to the side, which no threshold does
    heights = np.column_stack([noise[:, 0] * (2.0 + 10.0 * ahead + 5.0 * turn), noise[:, 1] * (2.0 - 5.0 * side)])
    slopes = slopes_of(heights, commands, 0.9)
    np.testing.assert_allclose(slopes[0], [5.0, 0.0, 2.5], atol=0.5)
    np.testing.assert_allclose(slopes[1], 0.0, atol=0.3)
    assert (slopes >= 0.0).all()


def test_whitened_signals_have_the_unit_matrix_as_second_moment():
    rng = np.random.default_rng(0)
    signals = rng.normal(size=(5000, 3)) @ np.array([[2.0, 0.5, 0.0], [0.0, 1.0, 0.3], [0.0, 0.0, 0.1]])
    white = signals @ whitening_of(signals).T
    np.testing.assert_allclose(white.T @ white / len(white), np.eye(3), atol=1e-6)
    assert Watched(WatchedSignals(signals=("mean",), norm=True)).names(["LL1", "LL2"]) == ["norm"]
