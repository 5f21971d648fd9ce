"""Intervals over collisions and walks of few robots: simulated coverage, ends, and those of independent values."""

from collections.abc import Callable

import numpy as np
import pytest
from paper_settings import STATISTICS
from scipy.stats import beta

from experiments.evaluation.number.number import Number
from experiments.intervals.clusters import ClusterKey, mean_in, rate_in, share_in
from experiments.intervals.crossed import quantile_of
from experiments.intervals.few_clusters import WIDEST, rate_ends, share_ends
from experiments.intervals.independent import wilson
from experiments.intervals.single import rate_of

ROBOTS, WALKS, DRAWS = 3, 6, 400
LEAST = 0.91  # of 400 intervals, of which 95 % hold: three standard deviations below are .917


def places_of(each: int, robots: int = ROBOTS, shared: bool = False) -> list[ClusterKey]:
    """Return the places of some values in every walk of every robot, whose walks are its own or those of all."""
    found: list[ClusterKey] = []
    for robot in range(robots):
        first = 240 if shared else 240 + 1000 * robot
        for walk in range(WALKS):
            found += [ClusterKey(f"robot_{robot}", first + walk)] * each
    return found


def effects(
    rng: np.random.Generator, each: int, robot: float, walk: float, rest: float = 0.0, shared: bool = False
) -> np.ndarray:
    """Return normal effects of robots and of walks, their own or shared, and a rest, (robots x walks x each,)."""
    walks = walk * rng.standard_normal((1 if shared else ROBOTS, WALKS, 1))
    found = robot * rng.standard_normal((ROBOTS, 1, 1)) + walks
    return (found + rest * rng.standard_normal((ROBOTS, WALKS, each))).ravel()


def covered(draw: Callable[[np.random.Generator], Number], truth: float) -> float:
    """Return which share of intervals hold the truth."""
    rng = np.random.default_rng(7)
    numbers = [draw(rng) for _ in range(DRAWS)]
    return float(np.mean([found.low <= truth <= found.high for found in numbers]))  # type: ignore[operator]


@pytest.mark.parametrize("each", [1, 6])
@pytest.mark.parametrize(("robot", "walk"), [(0.0, 0.0), (1.5, 0.0), (0.0, 1.0), (1.5, 1.0)])
@pytest.mark.parametrize("middle", [-3.0, 0.0, 1.5])
@pytest.mark.parametrize("shared", [False, True])
def test_shares_are_covered_whether_robots_walks_or_neither_differ(
    each: int, robot: float, walk: float, middle: float, shared: bool
) -> None:
    of_all = middle + np.hypot(robot, walk) * np.random.default_rng(0).standard_normal(100_000)
    truth, places = float(np.mean(1.0 / (1.0 + np.exp(-of_all)))), places_of(each, shared=shared)

    def draw(rng: np.random.Generator) -> Number:
        chance = 1.0 / (1.0 + np.exp(-middle - effects(rng, each, robot, walk, shared=shared)))
        return share_in(list(rng.random(len(chance)) < chance), places, STATISTICS)

    assert covered(draw, truth) >= LEAST


@pytest.mark.parametrize(
    ("robot", "walk", "rest"), [(0.2, 0.0, 0.6), (0.6, 0.2, 0.2), (0.2, 0.6, 0.2), (0.0, 0.0, 0.8)]
)
def test_means_of_skewed_values_are_covered(robot: float, walk: float, rest: float) -> None:
    truth, places = float(np.exp((robot**2 + walk**2 + rest**2) / 2.0)), places_of(1)

    def draw(rng: np.random.Generator) -> Number:
        return mean_in(list(np.exp(effects(rng, 1, robot, walk, rest))), places, STATISTICS, "N s")

    assert covered(draw, truth) >= LEAST


@pytest.mark.parametrize("robot", [0.0, 0.8])
@pytest.mark.parametrize("events", [0.2, 3.0])
def test_rates_are_covered_whether_robots_differ_or_not(robot: float, events: float) -> None:
    places, hours = places_of(1), [0.5] * (ROBOTS * WALKS)

    def draw(rng: np.random.Generator) -> Number:
        expected = events / len(hours) * ROBOTS * np.exp(effects(rng, 1, robot, 0.0) - robot**2 / 2.0)
        return rate_in([int(count) for count in rng.poisson(expected)], hours, places, STATISTICS)

    assert covered(draw, events * ROBOTS / sum(hours)) >= LEAST


def test_walks_taken_as_independent_would_be_covered_half_of_the_time() -> None:
    """The reason for all this: Wilson's interval of 108 collisions of three robots that differ."""
    rng, held = np.random.default_rng(7), 0
    for _ in range(DRAWS):
        chance = 1.0 / (1.0 + np.exp(-effects(rng, 6, 1.5, 0.0)))
        low, high = wilson(float(np.mean(rng.random(108) < chance)), 108, STATISTICS.confidence)
        held += low <= 0.5 <= high
    assert held / DRAWS < 0.7


def test_nothing_found_in_all_walks_of_three_robots_leaves_more_than_a_quarter_open() -> None:
    found = share_in([False] * 18, places_of(1), STATISTICS)
    assert found.value == found.low == 0.0
    assert found.high == pytest.approx(0.284, abs=0.001)  # by Wilson alone .176
    all_found = share_in([True] * 18, places_of(1), STATISTICS)
    assert all_found.low == pytest.approx(1.0 - 0.284, abs=0.001)


def test_more_robots_narrow_a_share_more_than_more_walks_of_each() -> None:
    def width(robots: int, walks: int) -> float:
        low, high = share_ends([walks // 3] * robots, [walks] * robots, STATISTICS)
        return high - low

    assert width(12, 6) < 0.8 * width(3, 24)


def test_independent_events_have_the_interval_of_a_uniform_prior() -> None:
    """A closed form: each cluster has one event, so that no correlation shows; highest density of beta(8, 4)."""
    low, high = share_ends([1] * 7 + [0] * 3, [1] * 10, STATISTICS)
    law = beta(8, 4)
    assert law.cdf(high) - law.cdf(low) == pytest.approx(0.95, abs=2e-3)
    assert law.pdf(low) == pytest.approx(law.pdf(high), rel=0.02)


def test_no_event_ends_where_a_count_of_robots_that_differ_does() -> None:
    found, apart = rate_in([0] * 18, [1 / 18] * 18, places_of(1), STATISTICS), rate_of(0, 1.0, STATISTICS)
    assert found.low == 0.0
    assert found.high == pytest.approx(4.56, abs=0.05)
    assert apart.high == pytest.approx(3.69, abs=0.01)


@pytest.mark.parametrize("scale", [0.01, 100.0])
def test_a_rate_is_that_of_its_unit_of_time(scale: float) -> None:
    counts = [2, 1, 0]
    ends = rate_ends(counts, [0.3, 0.4, 0.5], STATISTICS)
    scaled = rate_ends(counts, [0.3 * scale, 0.4 * scale, 0.5 * scale], STATISTICS)
    assert [end * scale for end in scaled] == pytest.approx(list(ends), rel=1e-6)


def test_a_rate_looks_far_enough_up() -> None:
    """The end of two robots that differ as much as can be lies within what is looked at."""
    _, high = rate_ends([40, 0], [0.5, 0.5], STATISTICS)
    assert high < 0.9 * WIDEST * (40 + 2 + 4 * 41**0.5)


def test_a_robot_that_did_not_walk_says_nothing_about_a_rate() -> None:
    places = places_of(1)[::WALKS]
    walked = rate_in([2, 1], [0.5, 0.5], places[:2], STATISTICS)
    assert rate_in([2, 1, 0], [0.5, 0.5, 0.0], places, STATISTICS) == walked


def test_an_impulse_has_no_end_below_zero() -> None:
    bimodal = [5.0, 8.0, 130.0] * 6
    found = mean_in(bimodal, places_of(1), STATISTICS, "N s")
    assert found.low is not None
    assert 0.0 < found.low < (found.value or 0.0)
    with_zero = mean_in([0.0, 8.0, 130.0] * 6, places_of(1), STATISTICS, "N s")
    assert with_zero.low is not None
    assert with_zero.low >= 0.0


def test_one_robot_has_an_interval_over_its_walks_and_one_walk_none() -> None:
    one = [place for place in places_of(6) if place.robot == "robot_0"]
    found = share_in([True, False] * 18, one, STATISTICS)
    assert found.low is not None
    first = [ClusterKey("robot_0", 240)] * 6
    assert share_in([True, False] * 3, first, STATISTICS) == Number(0.5)
    assert mean_in([1.0, 2.0, 3.0], first[:3], STATISTICS, "ms") == Number(2.0, unit="ms")
    assert rate_in([1], [0.5], first[:1], STATISTICS) == Number(2.0, unit="1/h")


def test_no_value_is_no_number() -> None:
    assert share_in([], [], STATISTICS) == Number(None)
    assert mean_in([], [], STATISTICS, "N") == Number(None, unit="N")
    assert rate_in([], [], [], STATISTICS) == Number(None, unit="1/h")


def test_of_a_full_grid_the_mean_s_interval_is_that_of_intervals() -> None:
    from experiments.intervals.crossed import RunGrid, summarise

    values = np.exp(np.random.default_rng(3).normal(size=(ROBOTS, WALKS)))
    for shared in (False, True):
        ours = mean_in(list(values.ravel()), places_of(1, shared=shared), STATISTICS, "N")
        grid = summarise([RunGrid(values, "robots", () if shared else tuple(range(ROBOTS)))], STATISTICS)
        assert grid.low is not None
        assert ours.low is not None
        # Robots that differ less than independent values would count as these.
        assert ours.low <= grid.low + 1e-12
        apart = values.var(ddof=1) / values.size
        if values.mean(axis=1).var(ddof=1) / ROBOTS > apart:
            assert ours.with_ends == pytest.approx(grid.with_ends)


def test_robots_that_happen_to_be_alike_make_no_interval_shorter_than_independent_values_would() -> None:
    """Each robot has one walk with and one without an event, so that nothing differs over robots."""
    values, places = [0.0, 2.0] * 3, [ClusterKey(f"robot_{k // 2}", k) for k in range(6)]
    reach = quantile_of(2, 0.95) * (6 / 5 / 6) ** 0.5  # six values of variance 6/5
    apart = mean_in([value - 1.0 for value in values], places, STATISTICS, "N")
    assert apart.with_ends == pytest.approx((0.0, -reach, reach))
    assert mean_in(values, places, STATISTICS, "N").low == 0.0  # no value is below zero
    _, low, high = share_in([value > 0.0 for value in values], places, STATISTICS).with_ends
    ends = wilson(0.5, 6, STATISTICS.confidence)
    assert low < ends[0]
    assert high > ends[1]
