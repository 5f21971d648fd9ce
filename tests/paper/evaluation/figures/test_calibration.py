"""The reliability plot draws observed minus nominal coverage, and names the curves that leave the band."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from csv_files import read_table
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from experiments.evaluation.figures.further.reliability import (
    WITHIN,
    CoverageCurve,
    curve_rows,
    curves_of,
    draw_reliability,
    reliability,
)
from experiments.evaluation.figures.style import LOOKS
from experiments.evaluation.measure.learning.calibration import CoverageGrid
from experiments.settings.settings import Settings

NOMINAL = np.array([0.25, 0.5, 0.75])


def curve(case: str, limb: str, method: str = "A") -> CoverageCurve:
    """A made-up curve: 10 points too low as learned, a point too high scaled."""
    return CoverageCurve(case, method, limb, limb, NOMINAL, NOMINAL - 0.1, NOMINAL + 0.01)


def grid(test: str, limb: str, pushed: str = "", method: str = "MOB-Net") -> CoverageGrid:
    """A made-up grid of three nominal points behind two levels of the table, likelihood and CRPS."""
    values = np.tile([0.5, 0.68, 0.2, 0.5, 0.8, -1.0, 1.0], (1, 1, 2, 1))
    return CoverageGrid(test, "robots", pushed, method, limb, "N m", values)


def drawn_in(axis: Axes) -> list[Line2D]:
    """Return the lines of curves in a panel."""
    return [line for line in axis.lines if len(np.asarray(line.get_xdata())) == len(NOMINAL)]


def test_lines_are_observed_minus_nominal_in_points_as_learned_and_scaled() -> None:
    learned, scaled = draw_reliability([curve("walk", "LL")], 0.05).axes
    np.testing.assert_allclose(np.asarray(drawn_in(learned)[0].get_ydata()), -10.0)
    np.testing.assert_allclose(np.asarray(drawn_in(scaled)[0].get_ydata()), 1.0)
    low, high = scaled.get_ylim()
    assert low < -10.0
    assert high > 1.0  # all is seen
    (band,) = scaled.patches
    assert (band.get_y(), band.get_height()) == (-5.0, 10.0)  # type: ignore[attr-defined]


def test_a_scaled_curve_that_leaves_the_band_has_its_methods_colour_and_a_name_and_others_are_grey() -> None:
    far = replace(curve("hit", "RA", "MOB-Net"), after=NOMINAL - 0.2)
    other = replace(curve("hit", "LL", "FTS-e2e"), after=NOMINAL - 0.21)
    learned, scaled = draw_reliability([curve("walk", "LL", "MOB-Net"), far, other], 0.05).axes
    for axis in (learned, scaled):
        colours = [line.get_color() for line in drawn_in(axis)]
        assert colours == [WITHIN["color"], LOOKS["MOB-Net"].colour, LOOKS["FTS-e2e"].colour]
    assert not learned.texts
    places = {text.get_text(): text.xy[1] for text in scaled.texts}  # type: ignore[attr-defined]
    assert set(places) == {"RA, hit", "LL, hit"}
    assert places["RA, hit"] - places["LL, hit"] == pytest.approx(4.5)  # a point apart, they would overlap


def test_limbs_are_drawn_with_the_name_of_their_case_and_the_neck_is_not(settings: Settings, tmp_path: Path) -> None:
    section = settings.evaluation.calibration
    grids = [
        grid("walk_test", "LL"),
        grid("motion_test", "N"),
        grid("motion_test", "LA"),
        grid("hand_wrench", "RA", "RA2"),
        grid("knee_swing", "LL", "LL3", "FTS-e2e"),
    ]
    curves = curves_of(grids, section, 2, NOMINAL.tolist())
    assert "N" not in section.drawn
    texts = [one.text for one in curves]
    assert texts == [
        "LL, in distribution", "N, in distribution", "LA, in distribution",
        f"RA, {section.names['hand_wrench']}", f"LL, {section.names['knee_swing']}",
    ]  # fmt: skip
    np.testing.assert_allclose(curves[0].after, [0.2, 0.5, 0.8])
    reliability(section, grids, 2, NOMINAL.tolist(), tmp_path)
    rows = read_table(tmp_path / "calibration.csv")
    assert {row.limb for row in rows} == {"LL", "N", "LA", "RA"}


def test_plotted_numbers_are_told_as_learned_and_scaled() -> None:
    rows = list(curve_rows([curve("walk", "LL")]))
    assert rows[1] == ("walk", "A", "LL", 0.5, pytest.approx(0.4), pytest.approx(0.51))
    assert len(rows) == len(NOMINAL)
