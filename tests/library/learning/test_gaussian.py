"""Measures of Gaussian predictions have their closed forms and rank predictions as they should."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.stats import norm

from mobnet.learning.calibration import coverage, fit_of, half_width, likelihood, ranked_score

SHARES = [0.5, 0.68, 0.9, 0.95]


@pytest.fixture
def draws():
    """Errors of two joints with standard deviations 1 and 3."""
    return np.random.default_rng(0).normal(size=(20000, 2)) * [1.0, 3.0]


def test_one_standard_deviation_holds_two_thirds():
    assert half_width(norm.cdf(1.0) - norm.cdf(-1.0)) == pytest.approx(1.0)
    assert half_width(0.95) == pytest.approx(1.96, abs=1e-3)


def test_a_true_deviation_covers_what_it_says_and_half_of_it_less(draws):
    true = np.broadcast_to([1.0, 3.0], draws.shape)
    np.testing.assert_allclose(coverage(draws, true, SHARES), np.array([SHARES, SHARES]).T, atol=0.015)
    expected = [2.0 * norm.cdf(half_width(share) / 2.0) - 1.0 for share in SHARES]
    np.testing.assert_allclose(coverage(draws, true / 2.0, SHARES)[:, 0], expected, atol=0.015)


def test_likelihood_is_that_of_scipy(draws):
    std = np.abs(draws[::-1]) + 0.1
    np.testing.assert_allclose(likelihood(draws, std), -norm.logpdf(draws, scale=std).mean(axis=0))


@pytest.mark.parametrize(("error", "std"), [(0.0, 1.0), (2.5, 0.7), (-4.0, 3.0)])
def test_ranked_score_is_the_integral_that_defines_it(error, std):
    below = quad(lambda x: norm.cdf(x, scale=std) ** 2, -60.0, -error)[0]
    above = quad(lambda x: norm.sf(x, scale=std) ** 2, -error, 60.0)[0]
    assert ranked_score(np.array([[error]]), np.array([[std]]))[0] == pytest.approx(below + above, rel=1e-6)


def test_ranked_score_without_spread_is_the_mean_absolute_error(draws):
    np.testing.assert_allclose(ranked_score(draws, np.full_like(draws, 1e-9)), np.abs(draws).mean(axis=0), rtol=1e-6)


def test_the_true_deviation_scores_best(draws):
    true = fit_of(draws, np.broadcast_to([1.0, 3.0], draws.shape), SHARES)
    for factor in (0.6, 1.6):
        other = fit_of(draws, factor * np.broadcast_to([1.0, 3.0], draws.shape), SHARES)
        assert (other.nll > true.nll).all()
        assert (other.crps > true.crps).all()
