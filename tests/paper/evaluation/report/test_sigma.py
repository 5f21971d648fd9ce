"""Table and figure of the standard deviations in parts of a walk."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden, markdown_cells, read_table

from experiments.evaluation.report.sigma import sigma
from experiments.settings.evaluation import Evaluation
from experiments.settings.runs import LimbRuns
from experiments.settings.settings import Settings

LIKE = LimbRuns(scenario="walk_test", level="all_uncertainty", methods=("MOB-Net", "FTS-e2e"), limbs=("LL",))
UNLIKE = LimbRuns(scenario="knee_swing", level="all_uncertainty", methods=("MOB-Net",), limbs=("LL",))
ALIKE = {
    "std": (2.0, "N m"), "cover": (0.6, "-"), "cover_swing": (0.7, "-"), "rmse": (3.0, "N m"),
    "excursion": (150.0, "ms"),
    **{f"std_part_{k}": (0.5 * k, "N m") for k in range(1, 5)},
    **{f"rmse_part_{k}": (0.6 * k, "N m") for k in range(1, 5)},
    **{f"cover_part_{k}": (0.5 + 0.05 * k, "-") for k in range(1, 5)},
    "acf_10ms": (0.8, "-"), "acf_100ms": (-0.1, "-"),
}  # fmt: skip
OTHER = {"std": (2.0, "N m"), "std_pushed": (6.0, "N m"), "rmse_pushed": (12.0, "N m"), "cover_pushed": (0.3, "-")}


@pytest.fixture
def made(tmp_path: Path, settings: Settings, evaluation: Evaluation, write_measured: Callable[..., list[Path]]) -> Path:
    """Table and figure of two tests, one unlike the training data."""
    tests, against = {"walking": LIKE, "knee hit": UNLIKE}, {"knee hit": "walking"}
    section = evaluation.sigma.model_copy(update={"tests": tests, "against": against, "parts": 4, "lags_ms": (10, 100)})
    scores = [*write_measured([LIKE], ALIKE), *write_measured([UNLIKE], OTHER)]
    sigma(section, settings.learning, settings.layout, evaluation.statistics, scores, tmp_path,
          tmp_path / "figures")  # fmt: skip
    return tmp_path


def test_shares_are_in_percent_and_what_rises_is_told_as_a_factor(made: Path) -> None:
    lines = markdown_cells(made / "sigma.csv")
    assert lines[0] == [
        "Test", "Limb", "Method", "68% all", "swing", "touch-down", "stance", "stuck", "moving", "pushed",
        "excursion [ms]", "sigma, times", "error, times",
    ]  # fmt: skip
    assert lines[2] == ["walking", "LL", "MOB-Net", "60.0", "70.0", *["-"] * 5, "150", "", ""]
    assert lines[4] == ["knee hit", "LL", "MOB-Net", "-", *["-"] * 5, "30.0", "-", "3.00", "4.00"]
    check_golden(made / "sigma.csv")


def test_figure_shows_the_tests_that_are_like_the_training_data(made: Path) -> None:
    rows = read_table(made / "figures/sigma.csv")
    assert {row.test for row in rows} == {"walking"}
    assert {(row.panel, row.method) for row in rows} == {
        (panel, method) for panel in ("coverage", "error over sigma", "autocorrelation") for method in LIKE.methods
    }
    own = [row for row in rows if (row.panel, row.method) == ("error over sigma", "MOB-Net")]
    assert [row.x for row in own] == pytest.approx([0.5, 1.0, 1.5, 2.0])
    assert [row.value for row in own] == pytest.approx([0.6, 1.2, 1.8, 2.4])
    assert (made / "figures/sigma.png").read_bytes().startswith(b"\x89PNG")
    check_golden((made / "figures/sigma.csv").rename(made / "sigma_courses.csv"))
