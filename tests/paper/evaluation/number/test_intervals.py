"""Intervals: simulated numbers are covered as often as is printed, and ends are those of closed forms."""

import itertools
from collections.abc import Sequence
from math import sqrt

import numpy as np
import pytest
from numpy.typing import NDArray
from paper_settings import STATISTICS
from scipy.stats import t as student

from experiments.evaluation.number.number import Number
from experiments.intervals.crossed import MEAN, RATIO, Formula, RunGrid, slopes_of, summarise
from experiments.intervals.quantities import BELOW, CUT, GAP_RATIO
from experiments.intervals.single import share, trend

DRAWS, LEAST = 200, 0.90
ROBOTS = "robots"  # what the rows of grids are whose methods share them
SPREADS = {
    "equal": (0.1, 0.1, 0.05),
    "networks": (0.2, 0.05, 0.05),
    "walks": (0.05, 0.2, 0.05),
    "rest": (0.02, 0.02, 0.1),
}
SKEW = 0.8  # standard deviation of the logarithm of the effects of skewed walks
PAIRED = 0.7  # correlation of the effects of a walk, or of a robot, on two methods
Array = NDArray[np.float64]


def ends(number: Number) -> Sequence[float]:
    """Return the lower end, the number and the upper end, none of which is missing."""
    found = [number.low, number.value, number.high]
    assert None not in found
    return [float(each or 0.0) for each in found]


def effects_of_walks(rng: np.random.Generator, methods: int, walks: int, skewed: bool) -> Array:
    """Return effects of mean 0 and variance 1 of walks on methods, correlated between methods, (methods, walks)."""
    shared, own = rng.normal(size=(1, walks)), rng.normal(size=(methods, walks))
    normal = sqrt(PAIRED) * shared + sqrt(1 - PAIRED) * own
    if not skewed:
        return normal
    mean, variance = np.exp(SKEW**2 / 2), np.exp(SKEW**2) * (np.exp(SKEW**2) - 1)
    return (np.exp(SKEW * normal) - mean) / sqrt(variance)


def draw(
    rng: np.random.Generator, shape: tuple[int, int], means: Sequence[float], spread: str, skewed: bool, rows: str
) -> list[RunGrid]:
    """Return runs of methods whose means are given, each with networks of its own; one network has no effect.

    Where the rows are robots, a network's effect is that of its robot, which all methods share, and its own, and each
    robot has walks of its own.
    """
    networks, walks = shape
    of_network, of_walk, rest = SPREADS[spread]
    drawn = networks if rows else 1
    common = effects_of_walks(rng, len(means), drawn * walks, skewed).reshape(len(means), drawn, walks)
    paired = PAIRED if rows else 0.0
    robots = rng.normal(size=(networks, 1)) if rows else 0.0
    grids = []
    for k, mean in enumerate(means):
        own = sqrt(paired) * robots + sqrt(1 - paired) * rng.normal(size=(networks, 1))
        errors = 1.0 + of_network * (networks > 1) * own + of_walk * common[k] + rest * rng.normal(size=shape)
        grids.append(RunGrid(mean * errors, rows or f"method {k}", tuple(range(networks)) if rows else ()))
    return grids


def simulate(
    formula: Formula, means: Sequence[float], shape: tuple[int, int], spread: str, skewed: bool, rows: str = "",
    draws: int = DRAWS,
) -> tuple[float, float]:  # fmt: skip
    """Return the share of intervals that hold the true number, and their median width over that of an oracle.

    The oracle knows the standard deviation of the number and takes 1.96 of it to each side.
    """
    rng = np.random.default_rng([*shape, len(means), skewed, len(spread)])
    true = float(formula.shown(formula.parts(np.array(means))).min())
    found = np.array(
        [ends(summarise(draw(rng, shape, means, spread, skewed, rows), STATISTICS, formula)) for _ in range(draws)]
    )
    low, value, high = found.T
    width = float(np.median(high - low) / (2 * 1.96 * value.std()))
    return float(np.mean((low <= true) & (true <= high))), width


FORMULAS = {
    "mean": (MEAN, (2.0,)),
    "ratio": (RATIO, (3.0, 2.0)),
    "cut": (CUT, (1.5, 19.0)),
    "difference": (BELOW, (1.5, 2.0)),
    "least of three": (BELOW, (1.5, 2.0, 2.05, 3.0)),
    "ratio of gaps": (GAP_RATIO, (3.0, 1.5, 6.0, 2.0)),
}


CASES = [(name, (3, 15)) for name in FORMULAS]
CASES += [(name, shape) for name in ("mean", "ratio") for shape in [(3, 3), (1, 15), (5, 5), (2, 15)]]
WIDEST = {
    1: 1.6,
    2: 9.5,
    3: 3.5,
    5: 2.2,
}  # networks -> width over that of the oracle; t of Student's law makes most of it


@pytest.mark.parametrize(("name", "shape"), CASES)
def test_simulated_intervals_hold_the_number_and_are_not_absurdly_wide(name: str, shape: tuple[int, int]) -> None:
    """Networks, walks or both differ, and the effects of walks are normal or skewed to the right."""
    formula, means = FORMULAS[name]
    for spread, skewed in itertools.product(list(SPREADS)[:3], (False, True)):
        covered, width = simulate(formula, means, shape, spread, skewed)
        assert covered >= LEAST, (spread, skewed)
        assert width <= WIDEST[shape[0]], (spread, skewed)


@pytest.mark.parametrize(("name", "robots"), [(name, 3) for name in FORMULAS] + [("ratio", 6), ("ratio", 8)])
def test_intervals_of_methods_that_share_robots_hold_the_number(name: str, robots: int) -> None:
    """The design of section 5.2: a few robots, each on four walks of its own, with networks of every method."""
    formula, means = FORMULAS[name]
    for spread, skewed in itertools.product(SPREADS, (False, True)):
        covered, width = simulate(formula, means, (robots, 4), spread, skewed, ROBOTS)
        assert covered >= LEAST, (spread, skewed)
        assert width <= WIDEST[3], (spread, skewed)


@pytest.mark.parametrize("true", [0.1, 0.3, 0.5, 0.9])
def test_shares_and_trends_of_single_runs_are_covered(true: float, rng: np.random.Generator) -> None:
    drawn = [RunGrid((rng.random((5, 1)) < true).astype(float)) for _ in range(DRAWS)]
    held = [low <= true <= high for low, _, high in (ends(share([grid], STATISTICS)) for grid in drawn)]
    assert np.mean(held) >= LEAST
    lines = [[RunGrid(np.array([[true * k + 0.5 * rng.normal()]])) for k in range(7)] for _ in range(DRAWS)]
    assert np.mean([low <= true <= high for low, _, high in (ends(trend(own, STATISTICS)) for own in lines)]) >= LEAST


def test_a_loss_that_falls_ever_more_slowly_has_a_trend_that_a_line_through_it_would_leave_open() -> None:
    """Figure 20 (b): five sizes of the data; a closed form, as all pairs fall."""
    losses = [7.08, 3.76, 2.95, 2.81, 2.73]
    grids = [RunGrid(np.array([[loss]])) for loss in losses]
    low, value, high = ends(trend(grids, STATISTICS))
    slopes = [(losses[k] - losses[i]) / (k - i) for i, k in itertools.combinations(range(5), 2)]
    assert (value, low, high) == pytest.approx((np.median(slopes), min(slopes), max(slopes)))
    assert high < 0.0
    assert trend(grids[:4], STATISTICS).low is None  # one order in twelve has all pairs rise or all fall


@pytest.mark.parametrize("shape", [(1, 2), (3, 1), (2, 3), (5, 5)])
def test_interval_contains_the_mean_and_is_the_same_every_time(
    shape: tuple[int, int], rng: np.random.Generator
) -> None:
    runs = RunGrid(rng.normal(size=shape))
    number = summarise([runs], STATISTICS)
    low, value, high = ends(number)
    assert value == pytest.approx(runs.mean)
    assert low <= value <= high
    assert (number.networks, number.walks, number.runs) == (shape[:1], shape[1:], runs.values.size)
    assert number == summarise([runs], STATISTICS)


def test_a_single_run_has_no_interval() -> None:
    number = summarise([RunGrid(np.array([[2.5]]))], STATISTICS, unit="N m")
    assert number == Number(2.5, unit="N m", networks=(1,), walks=(1,))
    assert number.spread == ("1", "1", None, None)


def test_interval_over_walks_alone_is_students(rng: np.random.Generator) -> None:
    """The reference is the closed form of a mean of normal numbers, which may be below zero."""
    runs = rng.normal(size=(1, 15))
    low, value, high = ends(summarise([RunGrid(runs)], STATISTICS))
    reach = float(student.ppf(0.975, 14)) * runs.std(ddof=1) / sqrt(15)
    assert (low, high) == pytest.approx((value - reach, value + reach))


def test_positive_runs_have_their_interval_on_a_log_scale(rng: np.random.Generator) -> None:
    low, value, high = ends(summarise([RunGrid(rng.uniform(0.1, 9.0, (2, 2)))], STATISTICS))
    assert low > 0.0
    assert low * high == pytest.approx(value**2)


def test_interval_scales_with_the_runs(rng: np.random.Generator) -> None:
    runs = rng.uniform(1.0, 2.0, size=(3, 4))
    once, five = (summarise([RunGrid(factor * runs)], STATISTICS) for factor in (1.0, 5.0))
    assert ends(five) == pytest.approx([5.0 * end for end in ends(once)])
    assert five.std_networks == pytest.approx(5.0 * (once.std_networks or 0.0))


def test_standard_deviations_are_those_of_the_means_of_rows_and_columns(rng: np.random.Generator) -> None:
    runs = rng.uniform(1.0, 2.0, size=(3, 4))
    number = summarise([RunGrid(runs)], STATISTICS)
    assert number.std_networks == pytest.approx(runs.mean(axis=1).std(ddof=1))
    assert number.std_walks == pytest.approx(runs.mean(axis=0).std(ddof=1))
    assert summarise([RunGrid(runs[:1])], STATISTICS).std_networks is None


def test_networks_that_differ_widen_it_however_many_walks_there_are() -> None:
    low, _, high = ends(summarise([RunGrid(np.repeat([[-1.0], [1.0]], 100, axis=1))], STATISTICS))
    assert high == -low == pytest.approx(12.706, rel=1e-4)  # Student's law with one degree of freedom


@pytest.mark.parametrize("networks", [(3, 3), (1, 3), (2, 3), (1, 2)])
def test_walks_are_paired_however_many_networks_each_method_has(networks: tuple[int, int]) -> None:
    """Runs that differ from walk to walk alone give an exact ratio."""
    walks = np.array([1.0, 2.0, 4.0])
    grids = [
        RunGrid(np.tile(walks * factor, (count, 1)), f"method {count}, {factor}")
        for count, factor in zip(networks, (3.0, 1.0), strict=True)
    ]
    assert ends(summarise(grids, STATISTICS, RATIO)) == pytest.approx([3.0, 3.0, 3.0])


def test_networks_are_paired_within_a_method_and_not_between_methods() -> None:
    """The same networks on two tests have an exact ratio, networks of another method with the same errors have not."""
    runs = np.array([[1.0, 1.0], [2.0, 2.0], [3.0, 3.0]])
    own, other = RunGrid(runs, "MOB-Net"), RunGrid(runs, "FTS-e2e")
    assert ends(summarise([own, own], STATISTICS, RATIO)) == pytest.approx([1.0, 1.0, 1.0])
    low, value, high = ends(summarise([own, other], STATISTICS, RATIO))
    assert value == pytest.approx(1.0)
    assert low < value < high


def test_robots_are_paired_between_methods() -> None:
    """Errors that differ from robot to robot alone, by the same factor for both methods, have an exact ratio."""
    runs = np.array([[1.0, 1.0], [2.0, 2.0], [3.0, 3.0]])
    number = summarise([RunGrid(2.0 * runs, ROBOTS), RunGrid(runs, ROBOTS)], STATISTICS, RATIO)
    assert ends(number) == pytest.approx([2.0, 2.0, 2.0])
    assert (number.networks, number.walks) == ((3,), (2,))


def test_a_limb_with_one_network_is_no_second_one() -> None:
    """A limb with three networks and one with a single network: the single one adds nothing to what is drawn."""
    three, one = np.array([[1.0, 1.2], [2.0, 2.4], [3.0, 3.6]]), np.array([[2.0, 2.4]])
    both, alone = (
        summarise([RunGrid(grid, "MOB-Net") for grid in grids], STATISTICS) for grids in ([three, one], [three])
    )
    assert both.networks == (3, 1)
    assert both.std_networks == pytest.approx((alone.std_networks or 0.0) / 2.0)


def test_the_least_part_has_the_lowest_of_all_ends() -> None:
    grids = [RunGrid(np.array([[mean - 0.1, mean, mean + 0.3]]), str(mean)) for mean in (1.0, 3.0, 3.1)]
    first, second = (summarise([grids[0], other], STATISTICS, BELOW) for other in grids[1:])
    both = summarise(grids, STATISTICS, BELOW)
    assert (both.value, both.low) == (first.value, pytest.approx(first.low))
    assert (first.high or 0.0) <= (both.high or 0.0) <= (second.high or 0.0) + 0.1


def test_a_gap_that_may_be_closed_reaches_zero() -> None:
    walks = np.array([[-0.1, 0.0, 0.2]])
    first, second, third, fourth = (RunGrid(mean + walks * k, str(k)) for k, mean in enumerate((1.0, 1.01, 5.0, 3.0)))
    low, value, high = ends(summarise([first, second, third, fourth], STATISTICS, GAP_RATIO))
    assert low == 0.0 < value < high


def test_a_ratio_to_zero_is_no_number() -> None:
    number = summarise([RunGrid(np.ones((1, 3))), RunGrid(np.zeros((1, 3)))], STATISTICS, RATIO)
    assert (number.value, number.low, number.walks) == (None, None, (3,))


def test_walks_of_robots_vary_as_a_sum_written_by_hand() -> None:
    """Three walks of each of two robots, by the variance over n - 1, and a number whose slope on the mean is 2."""
    values = np.array([[1.0, 2.0, 6.0], [4.0, 4.0, 7.0]])
    within = ((1 - 3) ** 2 + (2 - 3) ** 2 + (6 - 3) ** 2) / 2, ((4 - 5) ** 2 + (4 - 5) ** 2 + (7 - 5) ** 2) / 2
    doubled = Formula(lambda means: 2.0 * means)
    number = summarise([RunGrid(values, ROBOTS, (101, 102))], STATISTICS, doubled)
    assert number.std_walks == pytest.approx(2.0 * sqrt((within[0] + within[1]) / 2 / 2))
    assert number.std_networks == pytest.approx(2.0 * sqrt(2.0))  # of the means 3 and 5
    alone = summarise([RunGrid(values[:, :1], ROBOTS, (101, 102))], STATISTICS, doubled)
    assert (alone.walks, alone.std_walks) == ((1,), None)


def test_slopes_are_known_at_zero_and_at_large_numbers_too() -> None:
    at = np.array([0.0, 1e-9, 2.0, 1e6])
    made = slopes_of(lambda means: np.stack([3.0 * means[0], means[1] * means[3], means[2] ** 2]), at)
    np.testing.assert_allclose(made, [[3.0, 0.0, 0.0, 0.0], [0.0, 1e6, 0.0, 1e-9], [0.0, 0.0, 4.0, 0.0]], rtol=1e-6)
