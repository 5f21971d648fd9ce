"""Figures 6 and 10 show every push of a recording from its start, beside errors of all runs."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mobnet.evaluation.figures.figure_06 import figure_06
from mobnet.evaluation.figures.figure_10 import figure_10
from mobnet.evaluation.measure.pushes import read_pushes

Walk = Callable[..., dict[str, Any]]
MEANS = {"MOB": 20.0, "MOB-Net": 4.0}


@pytest.fixture
def entries(walk: Walk) -> list[dict[str, Any]]:
    """Two methods on one made-up walk of four pushed swings."""
    return [walk(-15.0, method="MOB"), walk(2.0)]


def read(path: Path) -> list[dict[str, str]]:
    """Return the rows of a CSV file."""
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_every_push_has_a_panel_that_starts_before_it(entries: list[dict[str, Any]], config: dict[str, Any]) -> None:
    panels = read_pushes(config, config["evaluation"]["figure_06"], entries, "step {} on LL3")
    assert [panel.title for panel in panels] == [f"step {k} on LL3" for k in range(1, 5)]
    for panel in panels:
        assert (panel.time[0], panel.time[-1]) == pytest.approx((-0.1, 0.19))
        np.testing.assert_array_equal(panel.flags["push"], (panel.time > -0.005) & (panel.time < 0.095))
        truth, *estimates = panel.curves
        assert [curve.label for curve in estimates] == ["MOB", "MOB-Net"]
        assert np.mean(estimates[1].values - truth.values) == pytest.approx(2.0, rel=1e-4)


def test_figure_06_shows_the_first_push_and_errors_beside_the_printed_ones(
    tmp_path: Path, entries: list[dict[str, Any]], config: dict[str, Any], write_push_scores: Callable[..., Path]
) -> None:
    figure_06(config, entries, write_push_scores("hip_pitch_step", MEANS), tmp_path)
    assert (tmp_path / "figure_06.pdf").read_bytes().startswith(b"%PDF")
    assert {row["panel"] for row in read(tmp_path / "figure_06.csv")} == {"step 1 on LL3"}
    bars = [
        (row["method"], float(row["rmse_nm"]), float(row["published"])) for row in read(tmp_path / "figure_06_bars.csv")
    ]
    assert bars == [("MOB", 20.0, 37.05), ("MOB-Net", 4.0, 3.53)]


def test_figure_10_shows_both_tests(
    tmp_path: Path, entries: list[dict[str, Any]], config: dict[str, Any], write_push_scores: Callable[..., Path]
) -> None:
    names = ("knee_swing", "knee_support", "walk_test")
    scores = {name: write_push_scores(name, MEANS, 4) for name in names}
    figure_10(config, {"swing knee": entries, "support knee": entries}, scores, tmp_path)
    panels = dict.fromkeys(row["panel"] for row in read(tmp_path / "figure_10.csv"))
    assert list(panels) == [f"{title} {k}" for title in ("swing knee", "support knee") for k in range(1, 5)]
    bars = read(tmp_path / "figure_10_bars.csv")
    assert {row["scenario"] for row in bars} == {"knee_swing", "knee_support"}
    assert {row["push"] for row in bars} == {"1", "2", "3", "4", "avg", "increase"}


def test_a_recording_too_short_for_pushes_gives_an_empty_figure(
    tmp_path: Path, walk: Walk, config: dict[str, Any], write_push_scores: Callable[..., Path]
) -> None:
    config["evaluation"]["figure_10"]["tests"] = {
        "swing knee": config["evaluation"]["figure_10"]["tests"]["swing knee"]
    }
    entry = walk(2.0, calm=True)
    scores = {name: write_push_scores(name, MEANS, 0) for name in ("knee_swing", "walk_test")}
    figure_10(config, {"swing knee": [entry]}, scores, tmp_path)
    assert (tmp_path / "figure_10.pdf").read_bytes().startswith(b"%PDF")
    assert read(tmp_path / "figure_10_bars.csv") == []
