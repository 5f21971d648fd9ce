"""Thresholds have the rate of false alarms that they are made for, and intervals hold it as often as they say."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import lognorm

from mobnet.core.errors import DataError
from mobnet.detection.thresholds import SHAPES, Calibrated, Tail, calibrate, expected_counts, fit_tail
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import TailNumbers

SWINGS, DURATION_S = 870, 20 * 60.0  # of twenty minutes
WALKS = 200
PER_H = SWINGS * 3600.0 / DURATION_S


@pytest.fixture
def numbers(settings):
    """As configured, with fewer resamples: hundreds of walks are calibrated here."""
    return replace(as_plain(settings.detection.thresholds, TailNumbers), resamples=200)


@pytest.mark.parametrize(("shape", "scale"), [(-0.2, 1.0), (0.0, 0.5), (0.2, 2.0)])
def test_the_tail_of_a_known_law_is_found(shape, scale):
    uniform = np.random.default_rng(1).uniform(size=200_000)
    over = -np.log(uniform) if shape == 0 else (uniform**-shape - 1.0) / shape
    tail = fit_tail(3.0 + scale * over, 0.1)
    grown = np.log(10.0) if shape == 0 else (0.1**-shape - 1.0) / shape
    assert tail.level == pytest.approx(3.0 + scale * grown, rel=0.02)
    assert tail.shape == pytest.approx(shape, abs=0.03)
    assert tail.share == pytest.approx(0.1, rel=1e-3)
    assert tail.above(tail.size(1e-3)) == pytest.approx(1e-3)


def test_a_law_with_an_end_gives_nothing_beyond_it():
    tail = Tail(level=1.0, share=0.1, scale=0.5, shape=-0.5)
    assert tail.above(2.0) == 0.0
    assert tail.size(1e-9) == pytest.approx(2.0, abs=1e-3)


@pytest.mark.parametrize("shape", [-0.5, 0.0, 0.3])
def test_below_its_level_a_tail_says_no_more_than_at_it(shape):
    """The level of a walk drawn anew may lie above the threshold of the walk itself."""
    tail = Tail(level=1.0, share=0.1, scale=0.5, shape=shape)
    assert tail.above(0.2) == tail.above(1.0) == pytest.approx(0.1)
    assert tail.size(0.5) == tail.size(0.1) == pytest.approx(1.0)


def test_the_shape_of_a_tail_of_few_swings_stays_within_its_bounds():
    one = fit_tail(np.array([*np.zeros(99), 1.0]), 0.01)
    assert (one.shape, one.share) == (SHAPES[0], 0.01)
    assert one.scale == pytest.approx((1.0 - one.level) * (1.0 - SHAPES[0]))
    wide = fit_tail(np.concatenate([np.zeros(90), np.geomspace(1e-6, 1e6, 10)]), 0.1)
    assert wide.shape == SHAPES[1]


@pytest.mark.parametrize("spread", [0.2, 0.4], ids=["light tail", "heavy tail"])
def test_the_interval_holds_the_rate_as_often_as_it_says_and_counts_of_held_out_walks_too(numbers, spread):
    """Largest values of swings are lognormal; the true rate above the threshold is known."""
    held, counted, rates = 0, 0, []
    for seed in range(WALKS):
        rng = np.random.default_rng(seed)
        found = calibrate(rng.lognormal(0.0, spread, SWINGS), range(SWINGS), DURATION_S, 1.0, numbers)
        rates.append(float(lognorm.sf(found.factor, spread)) * PER_H)
        held += found.low <= rates[-1] <= found.high
        low, high = expected_counts(found, 2.0, 0.95)
        counted += low <= (rng.lognormal(0.0, spread, 6 * SWINGS) > found.factor).sum() <= high
    assert held >= 0.90 * WALKS
    assert counted >= 0.95 * WALKS
    # Most thresholds have a lower rate than the wanted one, and few a far higher one: the mean is what is promised.
    assert np.mean(rates) == pytest.approx(1.0, abs=0.4)


@pytest.mark.parametrize(("rate_per_h", "most"), [(1.0, 3.0), (10.0, 1.8)])
def test_the_mean_rate_of_walks_whose_episodes_differ_is_nearer_to_the_wanted_one(numbers, rate_per_h, most):
    """Nearer than where a fitted law is asked for the wanted rate itself; one an hour is far beyond what was seen."""
    episodes = np.repeat(np.arange(16), 54)
    fewer = replace(numbers, resamples=100)
    levels = np.exp(0.1 * np.random.default_rng(0).normal(size=20_000))  # of the episodes of all walks
    rates, plain = [], []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        largest = rng.lognormal(0.0, 0.25, len(episodes)) * rng.choice(levels, 16)[episodes]
        found = calibrate(largest, episodes.tolist(), len(episodes) * 3600.0 / PER_H, rate_per_h, fewer)
        asked = fit_tail(largest, fewer.tail_share).size(rate_per_h / PER_H)
        rates.append(float(lognorm.sf(found.factor / levels, 0.25).mean()) * PER_H)
        plain.append(float(lognorm.sf(asked / levels, 0.25).mean()) * PER_H)
    assert np.mean(rates) < 0.95 * np.mean(plain)
    assert 0.5 * rate_per_h < np.mean(rates) < most * rate_per_h


def test_episodes_that_differ_make_the_interval_wider_and_the_threshold_higher(numbers):
    rng = np.random.default_rng(5)
    episodes = np.repeat(np.arange(15), 58)
    largest = rng.lognormal(0.0, 0.2, SWINGS) * np.repeat(rng.lognormal(0.0, 0.4, 15), 58)
    apart = calibrate(largest, range(SWINGS), DURATION_S, 60.0, numbers)
    together = calibrate(largest, episodes.tolist(), DURATION_S, 60.0, numbers)
    assert together.factor > apart.factor
    assert together.high > 1.2 * apart.high


def test_a_wanted_rate_that_is_common_is_met_without_going_beyond_what_was_seen(numbers):
    largest = np.random.default_rng(2).lognormal(0.0, 0.3, SWINGS)
    found = calibrate(largest, range(SWINGS), DURATION_S, 60.0, numbers)
    assert (largest > found.factor).sum() == pytest.approx(20, abs=4)
    assert found.low < 60.0 < found.high


@pytest.mark.parametrize(("largest", "rate", "text"), [
    (np.arange(1.0, 50.0), 1.0, "49 swings that calibrate; 200 or more are needed, some"),
    (np.ones(300), 1.0, "the largest value of each swing is 1.0; numbers that change are needed"),
    (np.minimum(np.arange(1.0, 301.0), 240.0), 1.0, "0 different .* 240 times their scales; 1 or more"),
    (np.minimum(np.arange(1.0, 301.0), 280.0), 1.0, "10 different .* 270 times their scales; 15 or more"),
    (np.arange(1.0, 301.0), 500.0, "rate: '500 per hour' is not accepted; accepted: below 108"),
])  # fmt: skip
def test_what_gives_no_threshold_is_told(largest, rate, text, settings):
    with pytest.raises(DataError, match=text):
        calibrate(largest, range(len(largest)), 1000.0, rate, as_plain(settings.detection.thresholds, TailNumbers))


def test_a_tail_of_which_every_second_value_differs_gives_a_threshold(settings):
    largest = np.minimum(np.arange(1.0, 301.0), 285.0)  # 30 in the tail, the last 15 of them the same
    assert (
        calibrate(largest, range(300), 1000.0, 1.0, as_plain(settings.detection.thresholds, TailNumbers)).factor > 270.0
    )


def test_a_walk_drawn_anew_without_its_rare_swings_expects_no_alarm(numbers):
    """All swings that exceed a value that many share may lie in one episode, which a walk drawn anew may miss."""
    episodes, rng = np.repeat(np.arange(15), 58), np.random.default_rng(0)
    largest = np.minimum(rng.lognormal(0.0, 0.3, SWINGS), 1.3)
    largest[episodes == 3] += np.abs(rng.normal(size=58))
    found = calibrate(largest, episodes.tolist(), DURATION_S, 1.0, numbers)
    assert 0.0 == found.low <= found.rate_per_h <= found.high < np.inf


def test_expected_counts_reach_over_both_what_is_unknown_and_chance():
    assert expected_counts(Calibrated(1.0, 1.0, 0.0, 3.0), 2.0, 0.95) == (0, 11)
    assert expected_counts(Calibrated(1.0, 60.0, 40.0, 80.0), 1.0, 0.95) == (28, 98)


def test_a_rate_of_zero_promises_no_alarm():
    assert expected_counts(Calibrated(1.0, 0.0, 0.0, 0.0), 2.0, 0.95) == (0, 0)
    assert expected_counts(Calibrated(1.0, 1.0, 0.0, 3.0), 0.0, 0.95) == (0, 0)
