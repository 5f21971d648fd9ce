"""Intervals: around the mean, empty for one run, as wide as theory says, the same every time."""

from typing import Any

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.evaluation.number.intervals import summarise


@pytest.mark.parametrize("shape", [(1, 2), (3, 1), (2, 3), (5, 5)])
def test_interval_contains_the_mean_and_stays_within_the_runs(
    shape: tuple[int, int], config: dict[str, Any], rng: np.random.Generator
) -> None:
    runs = rng.normal(size=shape)
    summary = summarise([runs], config)
    assert summary.value == pytest.approx(runs.mean())
    assert summary.low is not None
    assert summary.high is not None
    assert runs.min() - 1e-12 <= summary.low <= summary.value <= summary.high <= runs.max() + 1e-12
    assert summary.runs == runs.size


def test_a_single_run_has_no_interval(config: dict[str, Any]) -> None:
    summary = summarise([np.array([[2.5]])], config)
    assert (summary.value, summary.low, summary.high, summary.runs) == (2.5, None, None, 1)


def test_interval_scales_and_shifts_with_the_runs(config: dict[str, Any], rng: np.random.Generator) -> None:
    runs = rng.normal(size=(3, 4))
    one, other = summarise([runs], config), summarise([5.0 * runs + 2.0], config)
    ends = np.array([one.value, one.low, one.high], dtype=float)
    assert [other.value, other.low, other.high] == pytest.approx(5 * ends + 2)


def test_same_seed_same_interval(config: dict[str, Any], rng: np.random.Generator) -> None:
    runs = rng.normal(size=(2, 3))
    assert summarise([runs], config) == summarise([runs], config)


def test_interval_has_the_width_of_the_normal_law(config: dict[str, Any], rng: np.random.Generator) -> None:
    """The reference is the normal law's closed form."""
    runs = rng.normal(size=(1, 400))
    config["evaluation"]["bootstrap_draws"] = 4000
    summary = summarise([runs], config)
    assert summary.low is not None
    assert summary.high is not None
    assert summary.high - summary.low == pytest.approx(2 * 1.96 * runs.std() / 20, rel=0.06)


def test_networks_that_differ_widen_it_however_many_tests_there_are(config: dict[str, Any]) -> None:
    runs = np.repeat([[1.0], [3.0]], 100, axis=1)
    summary = summarise([runs], config)
    assert (summary.low, summary.high) == pytest.approx((1.0, 3.0))


def test_ratio_of_a_grid_and_its_multiple_is_exact_since_draws_are_shared(
    config: dict[str, Any], rng: np.random.Generator
) -> None:
    runs = rng.uniform(1.0, 2.0, size=(3, 3))
    summary = summarise([2 * runs, runs], config, lambda means: means[0] / means[1])
    assert (summary.value, summary.low, summary.high) == pytest.approx((2.0, 2.0, 2.0))


def test_a_method_without_networks_stands_for_all(config: dict[str, Any], rng: np.random.Generator) -> None:
    alone, many = rng.uniform(1.0, 2.0, (1, 3)), rng.uniform(1.0, 2.0, (2, 3))
    one, other = (summarise([grid, many], config, lambda m: m[0] / m[1]) for grid in (alone, np.tile(alone, (2, 1))))
    assert (one.value, one.low, one.high, one.runs) == pytest.approx((other.value, other.low, other.high, 6))


@pytest.mark.parametrize("networks", [(2, 3), (1, 2), (3, 3)])
def test_networks_of_unlike_number_are_drawn_apart_and_tests_together(
    networks: tuple[int, int], config: dict[str, Any]
) -> None:
    """Runs that differ from test to test alone give an exact ratio, however many networks each method has."""
    tests = np.array([1.0, 2.0, 4.0])
    grids = [np.tile(tests * factor, (count, 1)) for count, factor in zip(networks, (3.0, 1.0), strict=True)]
    summary = summarise(grids, config, lambda means: means[0] / means[1])
    assert (summary.value, summary.low, summary.high) == pytest.approx((3.0, 3.0, 3.0))


def test_unlike_networks_widen_a_ratio_that_like_ones_leave_exact(config: dict[str, Any]) -> None:
    runs = np.array([[1.0], [2.0], [3.0]])
    like = summarise([runs, runs], config, lambda means: means[0] / means[1])
    unlike = summarise([runs, runs[:2]], config, lambda means: means[0] / means[1])
    assert like.low == like.high == pytest.approx(1.0)
    assert unlike.low is not None
    assert unlike.high is not None
    assert unlike.low < 4 / 3 < unlike.high


def test_runs_on_other_tests_do_not_fit(config: dict[str, Any]) -> None:
    with pytest.raises(DataError, match=r"\(2, 3\), \(2, 4\)"):
        summarise([np.ones((2, 3)), np.ones((2, 4))], config)
