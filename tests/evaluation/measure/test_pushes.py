"""Errors around pushes are means over runs, their average that of the pushes, their increase that over calm walking."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mobnet.evaluation.figures.drawing.pushes import bar_panel
from mobnet.evaluation.measure.pushes import AVERAGE, INCREASE, PushError, collision_errors, push_metrics
from mobnet.evaluation.number.rows import Score, read_rows

MEANS = {"MOB": 20.0, "MOB-Net": 4.0}
WritePushScores = Callable[..., Path]


@pytest.fixture
def errors(config: dict[str, Any], write_push_scores: WritePushScores) -> list[PushError]:
    """Errors of two pushes on the knee, of MEANS and a tenth more, where walking has one N m less than MEANS."""
    rows = [row for name in ("knee_swing", "walk_test") for row in read_rows(write_push_scores(name, MEANS), Score)]
    settings = config["evaluation"]["figure_10"]
    return collision_errors(config, settings, settings["tests"]["swing knee"], rows)


def test_average_is_that_of_the_pushes_and_increase_is_over_walking(errors: list[PushError]) -> None:
    """A closed form of made-up errors."""
    for method, mean in MEANS.items():
        own = {error.push: error for error in errors if error.method == method}
        assert list(own) == ["1", "2", AVERAGE, INCREASE]
        values = [own[push].rmse_nm for push in own]
        assert values == pytest.approx([mean, 1.1 * mean, 1.05 * mean, 0.05 * mean + 1.0], rel=1e-5)
        assert own["1"].runs == (2 if method == "MOB" else 4)


def test_intervals_hold_their_numbers(errors: list[PushError]) -> None:
    for error in errors:
        assert error.low is not None
        assert error.high is not None
        assert error.low < error.rmse_nm < error.high


def test_only_the_average_has_a_printed_number(errors: list[PushError]) -> None:
    assert [(e.method, e.push, e.published) for e in errors if e.published] == [("MOB-Net", AVERAGE, 6.576)]


def test_panel_has_a_bar_a_push_and_tells_average_and_increase(errors: list[PushError]) -> None:
    panel = bar_panel("a", errors)
    assert panel.groups == ["1", "2", AVERAGE]
    np.testing.assert_allclose(panel.heights["MOB"], [20.0, 22.0, 21.0], rtol=1e-5)
    assert panel.spans["MOB"].shape == (2, 3)
    assert panel.notes == {"MOB": ["", "", "21.0 (+2.0)"], "MOB-Net": ["", "", "4.2 (+1.2)"]}
    np.testing.assert_array_equal(np.isnan(panel.published["MOB-Net"]), [True, True, False])


def test_a_fall_is_written_with_a_minus() -> None:
    rows = [
        PushError("t", "MOB", push, 1, value, None, None, None) for push, value in ((AVERAGE, 2.0), (INCREASE, -1.0))
    ]
    assert bar_panel("a", rows).notes == {"MOB": ["2.0 (\N{MINUS SIGN}1.0)"]}


def test_pushes_are_counted_in_the_scores(write_push_scores: WritePushScores, config: dict[str, Any]) -> None:
    rows = [
        row
        for name, pushes in (("knee_swing", 12), ("knee_support", 0))
        for row in read_rows(write_push_scores(name, MEANS, pushes), Score)
    ]
    assert push_metrics(rows, "knee_swing") == [f"rmse_push_{k}" for k in range(1, 13)]
    settings = config["evaluation"]["figure_10"]
    assert collision_errors(config, settings, settings["tests"]["support knee"], rows) == []
