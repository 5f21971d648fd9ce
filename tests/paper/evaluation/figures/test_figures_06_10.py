"""Figures 6 and 10 show every push of a recording from its start, beside errors of all runs."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from called import call
from csv_files import check_golden, read_table, write_rows

from experiments.evaluation.figures.paper.figure_06 import figure_06
from experiments.evaluation.figures.paper.figure_10 import figure_10
from experiments.evaluation.measure.estimates.pushes import read_pushes
from experiments.plan.runs import Run
from experiments.records.scores import Score
from experiments.settings.evaluation import Evaluation
from experiments.settings.figures import Figure06, Figure10
from experiments.settings.settings import Settings
from mobnet.core.joints import JointLayout
from mobnet.core.rows import read_rows

Walk = Callable[..., Run]
Draw = Callable[..., None]
TESTS = ("hip_pitch_step", "knee_swing", "knee_support", "walk_test")
STEP = "30 N m on LL3 in the swing"


@pytest.fixture
def runs(walk: Walk) -> list[Run]:
    """Two methods on one made-up walk of four pushed swings."""
    return [walk(-15.0, method="MOB"), walk(1.5, std=0.5)]


@pytest.fixture
def scores(write_push_scores: Callable[..., Path]) -> list[Path]:
    """Scores of two pushes of each test: the two methods come nearer to each other from test to test."""
    return [write_push_scores(name, {"MOB": 20.0 - k, "MOB-Net": 3.0 + k}) for k, name in enumerate(TESTS)]


@pytest.fixture
def draw(settings: Settings, evaluation: Evaluation, tmp_path: Path) -> Draw:
    """Return a function of (figure, its section, runs, scores) that writes the figure."""

    def write(figure: Callable[..., None], section: Figure06 | Figure10, runs: object, scores: list[Path]) -> None:
        printed, statistics = settings.published.tables[figure.__name__], evaluation.statistics
        own = {"settings": section, "published": printed, "runs": runs, "scores": scores, "figure_dir": tmp_path}
        shared = {"layout": settings.layout, "statistics": statistics, **dict(settings)}
        call(figure, {**shared, **own})

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
        assert estimates[1].std is None


def test_figure_06_shows_the_first_push_and_errors_beside_the_printed_ones(
    tmp_path: Path, runs: list[Run], evaluation: Evaluation, draw: Draw, scores: list[Path]
) -> None:
    draw(figure_06, evaluation.figure_06, runs, scores)
    assert (tmp_path / "figure_06.pdf").read_bytes().startswith(b"%PDF")
    assert {row.panel for row in read_table(tmp_path / "figure_06.csv")} == {STEP}
    bars = read_table(tmp_path / "figure_06_bars.csv")
    assert [(row.method, row.value, row.published) for row in bars] == [("MOB", 20.0, 37.05), ("MOB-Net", 3.0, 3.53)]
    assert [row.rmse_drawn for row in bars] == pytest.approx([15.0, 1.5], rel=1e-4)
    check_golden(tmp_path / "figure_06.csv", tmp_path / "figure_06_bars.csv")


def test_figure_10_shows_both_tests(
    tmp_path: Path, runs: list[Run], evaluation: Evaluation, draw: Draw, scores: list[Path]
) -> None:
    titles = ("swing knee", "support knee")
    draw(figure_10, evaluation.figure_10, dict.fromkeys(titles, runs), scores)
    for picture, title in zip(("figure_10", "figure_10_support"), titles, strict=True):
        rows = read_table(tmp_path / f"{picture}.csv")
        assert list(dict.fromkeys(row.panel for row in rows)) == [f"{title} {k}" for k in range(1, 5)]
        assert "MOB" not in vars(rows[0])  # its curve is not drawn
        assert {vars(row)["MOB-Net std"] for row in rows} == {0.5}
    bars = read_table(tmp_path / "figure_10_bars.csv")
    assert {row.scenario for row in bars} == {"knee_swing", "knee_support"}
    assert {(row.push, row.measure) for row in bars} == {
        *((push, "rmse") for push in (1, 2, "avg", "increase")),
        *(("avg", measure) for measure in ("push_share", "rise_delay", "rise_delay_observer")),
    }
    check_golden(*(tmp_path / f"figure_10{part}.csv" for part in ("", "_support", "_bars")))


def test_figure_10_has_the_share_and_the_delay_that_were_measured(
    tmp_path: Path, runs: list[Run], evaluation: Evaluation, draw: Draw, scores: list[Path]
) -> None:
    made = {"push_share": (0.6, "-"), "rise_delay": (20.0, "ms"), "rise_delay_observer": (9.0, "ms")}
    rows = [row for path in scores for row in read_rows(path, Score)]
    runs_of = {(row.scenario, row.level, row.method, row.network_seed, row.test_seed) for row in rows}
    measured = [
        Score(*run, "LL", "LL3", metric, value, unit)
        for run in sorted(runs_of)
        for metric, (value, unit) in made.items()
    ]
    write_rows(tmp_path / "all.csv", [*rows, *measured])
    draw(figure_10, evaluation.figure_10, dict.fromkeys(evaluation.figure_10.tests, runs), [tmp_path / "all.csv"])
    found = {row.measure: (row.value, row.unit) for row in read_table(tmp_path / "figure_10_bars.csv")}
    assert {name: found[name] for name in made} == made


def test_a_recording_too_short_for_pushes_gives_an_empty_figure(
    tmp_path: Path, walk: Walk, evaluation: Evaluation, draw: Draw, write_push_scores: Callable[..., Path]
) -> None:
    tests = {"swing knee": evaluation.figure_10.tests["swing knee"]}
    scores = [write_push_scores(name, {"MOB": 20.0, "MOB-Net": 4.0}, 0) for name in ("knee_swing", "walk_test")]
    calm = {"swing knee": [walk(2.0, calm=True)]}
    draw(figure_10, evaluation.figure_10.model_copy(update={"tests": tests}), calm, scores)
    assert (tmp_path / "figure_10.pdf").read_bytes().startswith(b"%PDF")
    assert read_table(tmp_path / "figure_10_bars.csv") == []
    step = write_push_scores("hip_pitch_step", {"MOB": 20.0, "MOB-Net": 4.0}, 0)
    draw(figure_06, evaluation.figure_06, calm["swing knee"], [step])
    assert [row.value for row in read_table(tmp_path / "figure_06_bars.csv")] == [None, None]
