"""Runs are found by what they are, never by their place in the file."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from experiments.evaluation.number.grid import Wanted, number_of, run_grid
from experiments.records.scores import Score
from experiments.settings.fleet import FIRST_SEED
from experiments.settings.settings import Settings
from mobnet.core.errors import DataError

WANTED = Wanted("forward_walk", "LL", "all_uncertainty", "MOB-Net", "avg")
Scores = Callable[..., list[Score]]


def test_grid_has_networks_as_rows_and_tests_as_columns(make_scores: Scores) -> None:
    grid = run_grid(make_scores(2, 3), WANTED).values
    assert grid.shape == (2, 3)
    assert np.all(np.diff(grid, axis=0) > 0)
    assert np.all(np.diff(grid, axis=1) > 0)


def test_robots_are_the_rows_of_every_method_and_networks_those_of_one(make_scores: Scores) -> None:
    scores = make_scores(3, 2)
    robots = [replace(row, network_seed=FIRST_SEED + row.network_seed) for row in scores]
    both = WANTED, replace(WANTED, method="FTS-e2e")
    networks, paired = ([run_grid(rows, each) for each in both] for rows in (scores, robots))
    assert [(grid.rows, grid.robots) for grid in networks] == [("MOB-Net", ()), ("FTS-e2e", ())]
    assert [grid.robots for grid in paired] == [(101, 102, 103)] * 2


def test_robots_have_walks_of_their_own_and_equally_many(make_scores: Scores) -> None:
    """As test seeds of theirs say, which no two robots share."""
    scores = make_scores(3, 2)
    own = [
        replace(row, network_seed=FIRST_SEED + row.network_seed, test_seed=1000 * row.network_seed + row.test_seed)
        for row in scores
    ]
    grid = run_grid(own, WANTED)
    np.testing.assert_array_equal(grid.values, run_grid(scores, WANTED).values)
    assert grid.has_own_walks
    with pytest.raises(DataError, match="5 rows"):
        run_grid([row for row in own if row != WANTED.rows(own)[0]], WANTED)


def test_order_of_rows_does_not_matter(make_scores: Scores, rng: np.random.Generator) -> None:
    scores = make_scores()
    shuffled = [scores[i] for i in rng.permutation(len(scores))]
    np.testing.assert_array_equal(run_grid(shuffled, WANTED).values, run_grid(scores, WANTED).values)


def test_a_missing_run_is_refused(make_scores: Scores) -> None:
    scores = make_scores()
    scores.remove(WANTED.rows(scores)[0])
    with pytest.raises(DataError, match=r"5 rows for .*'MOB-Net'.*networks \[0, 1\] on tests \[1, 2, 3\]"):
        run_grid(scores, WANTED)


def test_a_run_scored_twice_is_refused(make_scores: Scores) -> None:
    scores = make_scores()
    with pytest.raises(DataError, match="7 rows"):
        run_grid([*scores, WANTED.rows(scores)[0]], WANTED)


def test_an_unknown_method_is_named(make_scores: Scores) -> None:
    with pytest.raises(DataError, match=r"no row for .*'MOB-Fantasy'"):
        run_grid(make_scores(), replace(WANTED, method="MOB-Fantasy"))


def test_a_number_is_the_mean_over_runs_in_the_unit_of_its_metric(make_scores: Scores, settings: Settings) -> None:
    statistics, scores = settings.evaluation.statistics, make_scores()
    number = number_of(scores, [WANTED], statistics, published=1.31)
    assert (number.value, number.runs, number.unit, number.published) == (pytest.approx(1.5), 6, "N m", 1.31)
    assert number_of(scores, [replace(WANTED, metric="roughness")], statistics).unit == "N m/s"
