"""Errors around pushes are means over runs, their average that of the pushes, their increase that over calm walking."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from experiments.evaluation.measure.estimates.pushes import (
    AVERAGE,
    INCREASE,
    PushErrors,
    collision_errors,
    push_metrics,
)
from experiments.evaluation.number.grid import Lookup, read_lookup
from experiments.settings.evaluation import Evaluation
from experiments.settings.settings import Settings

MEANS = {"MOB": 20.0, "MOB-Net": 4.0}
WritePushScores = Callable[..., Path]


@pytest.fixture
def measure(settings: Settings, evaluation: Evaluation) -> Callable[..., PushErrors]:
    """Return a function of (title of a test, scores) that measures its errors."""
    figure, printed = evaluation.figure_10, settings.published.tables["figure_10"]

    def errors_of(title: str, rows: Lookup) -> PushErrors:
        return collision_errors(settings.layout, figure, figure.tests[title], printed, rows)

    return errors_of


@pytest.fixture
def errors(
    evaluation: Evaluation, measure: Callable[..., PushErrors], write_push_scores: WritePushScores
) -> PushErrors:
    """Errors of two pushes on the knee, of MEANS and a tenth more, where walking has one N m less than MEANS."""
    paths = [write_push_scores(name, MEANS) for name in ("knee_swing", "walk_test")]
    return measure("swing knee", read_lookup(paths, evaluation.statistics))


def test_average_is_that_of_the_pushes_and_increase_is_over_walking(errors: PushErrors) -> None:
    """A closed form of made-up errors."""
    for method, mean in MEANS.items():
        assert list(errors[method]) == ["1", "2", AVERAGE, INCREASE]
        values = [error.value for error in errors[method].values()]
        assert values == pytest.approx([mean, 1.1 * mean, 1.05 * mean, 0.05 * mean + 1.0], rel=1e-5)
        assert errors[method]["1"].runs == (2 if method == "MOB" else 4)


def test_intervals_hold_their_numbers_and_only_the_average_has_a_printed_one(errors: PushErrors) -> None:
    for method, own in errors.items():
        for push, error in own.items():
            value, low, high = np.array(error.with_ends, dtype=float)
            assert low < value < high
            assert error.published == (6.576 if (method, push) == ("MOB-Net", AVERAGE) else None)


def test_pushes_are_counted_in_the_scores(
    evaluation: Evaluation, write_push_scores: WritePushScores, measure: Callable[..., PushErrors]
) -> None:
    paths = [write_push_scores(name, MEANS, pushes) for name, pushes in (("knee_swing", 12), ("knee_support", 0))]
    rows = read_lookup(paths, evaluation.statistics)
    assert push_metrics(rows, "knee_swing") == [f"rmse_push_{k}" for k in range(1, 13)]
    assert measure("support knee", rows) == {}
