"""Intervals over collisions and walks of few robots: simulated coverage, ends, and those of independent values."""

from collections.abc import Callable

import numpy as np
import pytest
from scipy.special import ndtri

from experiments.evaluation.number.clusters import ClusterKey, mean_in, rate_in, share_in, wilson
from experiments.evaluation.number.intervals import quantile_of
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.single import rate_of
from experiments.settings.runs import Statistics

STATISTICS = Statistics(confidence=0.95)
ROBOTS, WALKS, DRAWS = 3, 6, 200
LEAST = 0.91  # of 200 intervals, of which 95 % hold: three standard deviations below are .904


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
        flags, apart = list(rng.random(108) < chance), [ClusterKey(f"{k}", k) for k in range(108)]
        found = share_in(flags, apart, STATISTICS)
        assert found.low is not None
        assert found.high is not None
        held += found.low <= 0.5 <= found.high
    assert held / DRAWS < 0.7


def test_nothing_found_in_all_walks_of_three_robots_leaves_half_open() -> None:
    found = share_in([False] * 18, places_of(1), STATISTICS)
    assert found.value == found.low == 0.0
    assert found.high == pytest.approx(0.507, abs=0.001)  # by Wilson alone .176
    all_found = share_in([True] * 18, places_of(1), STATISTICS)
    assert all_found.low == pytest.approx(1.0 - 0.507, abs=0.001)


def test_no_event_in_an_hour_of_three_robots_ends_where_robots_are_few() -> None:
    found, apart = rate_in([0] * 18, [1 / 18] * 18, places_of(1), STATISTICS), rate_of(0, 1.0, STATISTICS)
    assert found.low == 0.0
    assert found.high == pytest.approx((apart.high or 0.0) * (4.3027 / 1.96) ** 2, rel=1e-3)


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
    from experiments.evaluation.number.intervals import RunGrid, summarise

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
    share = share_in([value > 0.0 for value in values], places, STATISTICS)
    count = 6 * (float(ndtri(0.975)) / quantile_of(2, 0.95)) ** 2
    assert share.with_ends == pytest.approx((0.5, *wilson(0.5, count, STATISTICS)))
