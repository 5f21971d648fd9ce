"""Runs are found by what they are, never by their place in the file."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from experiments.evaluation.number.frames import SCORES, frame_of, rows_of
from experiments.evaluation.number.scored import CELL, numbers_of, run_grid
from experiments.intervals.crossed import RunGrid
from experiments.records.scores import Score
from experiments.settings.fleet import FIRST_SEED
from experiments.settings.settings import Settings
from mobnet.core.errors import DataError

ASKED = {
    "scenario": "forward_walk", "limb": "LL", "level": "all_uncertainty", "method": "MOB-Net", "joint": "avg",
    "metric": "rmse",
}  # fmt: skip
Scores = Callable[..., list[Score]]


def runs_in(scores: Sequence[Score], **changes: str) -> pd.DataFrame:
    """Return the rows of the runs of a number."""
    return rows_of(frame_of(scores, SCORES), **{**ASKED, **changes})


def grid_of(scores: Sequence[Score], **changes: str) -> RunGrid:
    """Return the runs of a number."""
    return run_grid(runs_in(scores, **changes))


def first_run(scores: Sequence[Score]) -> Score:
    """Return the row of the first run of the number."""
    return next(row for row in scores if all(getattr(row, name) == value for name, value in ASKED.items()))


def asked_for(**changes: str) -> pd.DataFrame:
    """Return a number as a table asks for it."""
    return pd.DataFrame([{**ASKED, **changes}], columns=CELL)


def test_grid_has_networks_as_rows_and_tests_as_columns(make_scores: Scores) -> None:
    grid = grid_of(make_scores(2, 3)).values
    assert grid.shape == (2, 3)
    assert np.all(np.diff(grid, axis=0) > 0)
    assert np.all(np.diff(grid, axis=1) > 0)


def test_robots_are_the_rows_of_every_method_and_networks_those_of_one(make_scores: Scores) -> None:
    scores = make_scores(3, 2)
    robots = [replace(row, network_seed=FIRST_SEED + row.network_seed) for row in scores]
    both = "MOB-Net", "FTS-e2e"
    networks, paired = ([grid_of(rows, method=each) for each in both] for rows in (scores, robots))
    assert [(grid.rows, grid.robots) for grid in networks] == [("MOB-Net", ()), ("FTS-e2e", ())]
    assert [grid.robots for grid in paired] == [(101, 102, 103)] * 2


def test_robots_have_walks_of_their_own_and_equally_many(make_scores: Scores) -> None:
    """As test seeds of theirs say, which no two robots share."""
    scores = make_scores(3, 2)
    own = [
        replace(row, network_seed=FIRST_SEED + row.network_seed, test_seed=1000 * row.network_seed + row.test_seed)
        for row in scores
    ]
    grid = grid_of(own)
    np.testing.assert_array_equal(grid.values, grid_of(scores).values)
    assert grid.has_own_walks
    with pytest.raises(DataError, match="5 rows"):
        grid_of([row for row in own if row != first_run(own)])


def test_order_of_rows_does_not_matter(make_scores: Scores, rng: np.random.Generator) -> None:
    scores = make_scores()
    shuffled = [scores[i] for i in rng.permutation(len(scores))]
    np.testing.assert_array_equal(grid_of(shuffled).values, grid_of(scores).values)


def test_a_missing_run_is_refused(make_scores: Scores) -> None:
    scores = make_scores()
    scores.remove(first_run(scores))
    with pytest.raises(DataError, match=r"5 rows for .*'MOB-Net'.*networks \[0, 1\] on tests \[1, 2, 3\]"):
        grid_of(scores)


def test_a_run_scored_twice_is_refused(make_scores: Scores) -> None:
    scores = make_scores()
    with pytest.raises(DataError, match="7 rows"):
        grid_of([*scores, first_run(scores)])


def test_an_unknown_method_is_named_where_its_run_may_not_lack(make_scores: Scores, settings: Settings) -> None:
    scores, statistics = frame_of(make_scores(), SCORES), settings.evaluation.statistics
    asked = asked_for(method="MOB-Fantasy")
    with pytest.raises(DataError, match=r"no row for .*'MOB-Fantasy'"):
        numbers_of(scores, asked, statistics, may_lack=False)
    assert np.isnan(numbers_of(scores, asked, statistics)["value"].astype(float)).all()


def test_a_number_is_the_mean_over_runs_in_the_unit_of_its_metric(make_scores: Scores, settings: Settings) -> None:
    scores, statistics = frame_of(make_scores(), SCORES), settings.evaluation.statistics
    asked = pd.concat([asked_for(), asked_for(metric="roughness")])
    row, other = numbers_of(scores, asked, statistics).to_dict("records")
    assert (row["value"], row["count"], row["unit"]) == (pytest.approx(1.5), 6, "N m")
    assert other["unit"] == "N m/s"
