"""Intervals: around the mean, empty for one run, as wide as theory says, the same every time."""

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.evaluation.number.intervals import summarise
from mobnet.evaluation.number.number import Number
from mobnet.settings.evaluation import Statistics

Summarise = Callable[..., Number]


@pytest.fixture
def of() -> Summarise:
    """Summarise grids of runs with few draws."""
    return partial(summarise, statistics=Statistics(confidence=0.95, bootstrap_draws=200), seed=0)


@pytest.fixture
def ratio(of: Summarise) -> Summarise:
    """Summarise the ratio of two grids."""
    return partial(of, combine=lambda means: means[0] / means[1])


def ends(number: Number) -> Sequence[float]:
    """Return the lower end, the number and the upper end, none of which is missing."""
    found = [number.low, number.value, number.high]
    assert None not in found
    return [float(each or 0.0) for each in found]


@pytest.mark.parametrize("shape", [(1, 2), (3, 1), (2, 3), (5, 5)])
def test_interval_contains_the_mean_and_stays_within_the_runs(
    shape: tuple[int, int], of: Summarise, rng: np.random.Generator
) -> None:
    runs = rng.normal(size=shape)
    number = of([runs])
    low, value, high = ends(number)
    assert value == pytest.approx(runs.mean())
    assert runs.min() - 1e-12 <= low <= value <= high <= runs.max() + 1e-12
    assert number.runs == runs.size
    assert number == of([runs])  # the same every time


def test_a_single_run_has_no_interval(of: Summarise) -> None:
    assert of([np.array([[2.5]])]) == Number(2.5, None, None, 1)


def test_interval_scales_and_shifts_with_the_runs(of: Summarise, rng: np.random.Generator) -> None:
    runs = rng.normal(size=(3, 4))
    assert ends(of([5.0 * runs + 2.0])) == pytest.approx(5 * np.array(ends(of([runs]))) + 2)


def test_interval_has_the_width_of_the_normal_law(rng: np.random.Generator) -> None:
    """The reference is the normal law's closed form."""
    runs = rng.normal(size=(1, 400))
    low, _, high = ends(summarise([runs], Statistics(confidence=0.95, bootstrap_draws=4000), 0))
    assert high - low == pytest.approx(2 * 1.96 * runs.std() / 20, rel=0.06)


def test_networks_that_differ_widen_it_however_many_tests_there_are(of: Summarise) -> None:
    assert ends(of([np.repeat([[1.0], [3.0]], 100, axis=1)])) == pytest.approx([1.0, 2.0, 3.0])


def test_ratio_of_a_grid_and_its_multiple_is_exact_since_draws_are_shared(
    ratio: Summarise, rng: np.random.Generator
) -> None:
    runs = rng.uniform(1.0, 2.0, size=(3, 3))
    assert ends(ratio([2 * runs, runs])) == pytest.approx([2.0, 2.0, 2.0])


def test_a_method_without_networks_stands_for_all(ratio: Summarise, rng: np.random.Generator) -> None:
    alone, many = rng.uniform(1.0, 2.0, (1, 3)), rng.uniform(1.0, 2.0, (2, 3))
    one, other = (ratio([grid, many]) for grid in (alone, np.tile(alone, (2, 1))))
    assert (*ends(one), one.runs) == pytest.approx((*ends(other), 6))


@pytest.mark.parametrize("networks", [(2, 3), (1, 2), (3, 3)])
def test_networks_of_unlike_number_are_drawn_apart_and_tests_together(
    networks: tuple[int, int], ratio: Summarise
) -> None:
    """Runs that differ from test to test alone give an exact ratio, however many networks each method has."""
    tests = np.array([1.0, 2.0, 4.0])
    grids = [np.tile(tests * factor, (count, 1)) for count, factor in zip(networks, (3.0, 1.0), strict=True)]
    assert ends(ratio(grids)) == pytest.approx([3.0, 3.0, 3.0])


def test_unlike_networks_widen_a_ratio_that_like_ones_leave_exact(ratio: Summarise) -> None:
    runs = np.array([[1.0], [2.0], [3.0]])
    assert ends(ratio([runs, runs])) == pytest.approx([1.0, 1.0, 1.0])
    low, _, high = ends(ratio([runs, runs[:2]]))
    assert low < 4 / 3 < high


def test_runs_on_other_tests_do_not_fit(of: Summarise) -> None:
    with pytest.raises(DataError, match=r"\(2, 3\), \(2, 4\)"):
        of([np.ones((2, 3)), np.ones((2, 4))])
