"""Errors around pushes are means over runs, their average that of the pushes, their increase that over calm walking."""

from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest

from experiments.evaluation.measure.estimates.pushes import INCREASE, push_metrics, push_numbers
from experiments.evaluation.measure.estimates.run_errors import ERROR
from experiments.evaluation.number.frames import read_scores, rows_of
from experiments.evaluation.number.scored import AVERAGE
from experiments.settings.evaluation import Evaluation
from experiments.settings.settings import Settings

MEANS = {"MOB": 20.0, "MOB-Net": 4.0}
WritePushScores = Callable[..., Path]


@pytest.fixture
def measure(settings: Settings, evaluation: Evaluation) -> Callable[..., pd.DataFrame]:
    """Return a function of (title of a test, scores) that measures its pushes."""
    figure, printed = evaluation.figure_10, settings.published.tables["figure_10"]

    def numbers(title: str, scores: pd.DataFrame) -> pd.DataFrame:
        return push_numbers(scores, settings.layout, figure, figure.tests[title], printed, evaluation.statistics)

    return numbers


@pytest.fixture
def errors(measure: Callable[..., pd.DataFrame], write_push_scores: WritePushScores) -> pd.DataFrame:
    """Errors of two pushes on the knee, of MEANS and a tenth more, where walking has one N m less than MEANS."""
    paths = [write_push_scores(name, MEANS) for name in ("knee_swing", "walk_test")]
    return rows_of(measure("swing knee", read_scores(*paths)), measure=ERROR)


def test_average_is_that_of_the_pushes_and_increase_is_over_walking(errors: pd.DataFrame) -> None:
    """A closed form of made-up errors."""
    for method, mean in MEANS.items():
        own = rows_of(errors, method=method)
        assert own["push"].tolist() == ["1", "2", AVERAGE, INCREASE]
        expected = [mean, 1.1 * mean, 1.05 * mean, 0.05 * mean + 1.0]
        assert own["value"].tolist() == pytest.approx(expected, rel=1e-5)
        assert own["networks"].iloc[0] == ("1" if method == "MOB" else "2")


def test_intervals_hold_their_numbers_and_only_the_average_has_a_printed_one(errors: pd.DataFrame) -> None:
    assert (errors["low"] < errors["value"]).all()
    assert (errors["value"] < errors["high"]).all()
    printed = errors.dropna(subset="published")
    assert printed[["method", "push", "published"]].to_numpy().tolist() == [["MOB-Net", AVERAGE, 6.576]]


def test_pushes_are_counted_in_the_scores(
    write_push_scores: WritePushScores, measure: Callable[..., pd.DataFrame]
) -> None:
    paths = [write_push_scores(name, MEANS, pushes) for name, pushes in (("knee_swing", 12), ("knee_support", 0))]
    scores = read_scores(*paths)
    assert push_metrics(scores, "knee_swing") == [f"rmse_push_{k}" for k in range(1, 13)]
    assert measure("support knee", scores).empty
