"""Figures 6 and 10 show every push of a recording from its start, beside errors of all runs."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from csv_files import check_golden, read_table

from mobnet.core.joints import JointLayout
from mobnet.evaluation.figures.paper.figure_06 import figure_06
from mobnet.evaluation.figures.paper.figure_10 import figure_10
from mobnet.evaluation.measure.estimates.pushes import read_pushes
from mobnet.plan.runs import Run
from mobnet.settings.evaluation import Evaluation, Figure06, Figure10
from mobnet.settings.settings import Settings

Walk = Callable[..., Run]
Draw = Callable[..., None]
TESTS = ("hip_pitch_step", "knee_swing", "knee_support", "walk_test")


@pytest.fixture
def runs(walk: Walk) -> list[Run]:
    """Two methods on one made-up walk of four pushed swings."""
    return [walk(-15.0, method="MOB"), walk(1.5)]


@pytest.fixture
def scores(write_push_scores: Callable[..., Path]) -> list[Path]:
    """Scores of two pushes of each test: the two methods come nearer to each other from test to test."""
    return [write_push_scores(name, {"MOB": 20.0 - k, "MOB-Net": 3.0 + k}) for k, name in enumerate(TESTS)]


@pytest.fixture
def draw(settings: Settings, evaluation: Evaluation, tmp_path: Path) -> Draw:
    """Return a function of (figure, its section, runs, scores) that writes the figure."""

    def write(figure: Callable[..., None], section: Figure06 | Figure10, runs: object, scores: list[Path]) -> None:
        printed, statistics = settings.published.tables[figure.__name__], evaluation.statistics
        figure(section, printed, settings.layout, statistics, runs, scores, tmp_path)

    return write


def test_every_push_has_a_panel_that_starts_before_it(
    runs: list[Run], layout: JointLayout, evaluation: Evaluation
) -> None:
    panels = read_pushes(layout, evaluation.figure_06, runs, "step {} on LL3")
    assert [panel.title for panel in panels] == [f"step {k} on LL3" for k in range(1, 5)]
    for panel in panels:
        assert (panel.time[0], panel.time[-1]) == pytest.approx((-0.1, 0.19))
        np.testing.assert_array_equal(panel.flags["push"], (panel.time > -0.005) & (panel.time < 0.095))
        truth, *estimates = panel.curves
        assert [curve.label for curve in estimates] == ["MOB", "MOB-Net"]
        assert np.mean(estimates[1].values - truth.values) == pytest.approx(1.5, rel=1e-4)


def test_figure_06_shows_the_first_push_and_errors_beside_the_printed_ones(
    tmp_path: Path, runs: list[Run], evaluation: Evaluation, draw: Draw, scores: list[Path]
) -> None:
    draw(figure_06, evaluation.figure_06, runs, scores)
    assert (tmp_path / "figure_06.pdf").read_bytes().startswith(b"%PDF")
    assert {row.panel for row in read_table(tmp_path / "figure_06.csv")} == {"step 1 on LL3"}
    bars = [(row.method, row.rmse_nm, row.published) for row in read_table(tmp_path / "figure_06_bars.csv")]
    assert bars == [("MOB", 20.0, 37.05), ("MOB-Net", 3.0, 3.53)]
    check_golden(tmp_path / "figure_06.csv", tmp_path / "figure_06_bars.csv")


def test_figure_10_shows_both_tests(
    tmp_path: Path, runs: list[Run], evaluation: Evaluation, draw: Draw, scores: list[Path]
) -> None:
    titles = ("swing knee", "support knee")
    draw(figure_10, evaluation.figure_10, dict.fromkeys(titles, runs), scores)
    panels = dict.fromkeys(row.panel for row in read_table(tmp_path / "figure_10.csv"))
    assert list(panels) == [f"{title} {k}" for title in titles for k in range(1, 5)]
    bars = read_table(tmp_path / "figure_10_bars.csv")
    assert {row.scenario for row in bars} == {"knee_swing", "knee_support"}
    assert {row.push for row in bars} == {1, 2, "avg", "increase"}
    check_golden(tmp_path / "figure_10.csv", tmp_path / "figure_10_bars.csv")


def test_a_recording_too_short_for_pushes_gives_an_empty_figure(
    tmp_path: Path, walk: Walk, evaluation: Evaluation, draw: Draw, write_push_scores: Callable[..., Path]
) -> None:
    tests = {"swing knee": evaluation.figure_10.tests["swing knee"]}
    scores = [write_push_scores(name, {"MOB": 20.0, "MOB-Net": 4.0}, 0) for name in ("knee_swing", "walk_test")]
    calm = {"swing knee": [walk(2.0, calm=True)]}
    draw(figure_10, evaluation.figure_10.model_copy(update={"tests": tests}), calm, scores)
    assert (tmp_path / "figure_10.pdf").read_bytes().startswith(b"%PDF")
    assert read_table(tmp_path / "figure_10_bars.csv") == []
