"""The reliability plot draws observed less nominal coverage, a panel for each part of the body, a colour for a case."""

from pathlib import Path

import numpy as np
import pytest
from csv_files import read_table

from experiments.evaluation.figures.further.reliability import (
    CoverageCurve,
    ReliabilityPanel,
    curve_rows,
    curves_of,
    draw_reliability,
    panels_of,
    reliability,
)
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


def test_lines_are_observed_less_nominal_in_points_as_learned_pale_and_scaled_full() -> None:
    figure = draw_reliability([ReliabilityPanel("legs", [curve("walk", "LL")])], 0.05)
    axis = figure.axes[0]
    pale, full = (line for line in axis.lines if len(np.asarray(line.get_xdata())) == len(NOMINAL))
    np.testing.assert_allclose(np.asarray(pale.get_ydata()), -10.0)
    np.testing.assert_allclose(np.asarray(full.get_ydata()), 1.0)
    assert (pale.get_alpha() or 1.0) < (full.get_alpha() or 1.0) == 1.0
    low, high = axis.get_ylim()
    assert (low, high) == (-high, high)
    (band,) = axis.patches
    assert (band.get_y(), band.get_height()) == (-5.0, 10.0)  # type: ignore[attr-defined]


def test_a_case_has_one_colour_in_every_panel_and_two_limbs_differ_in_width() -> None:
    panels = [
        ReliabilityPanel("legs", [curve("walk", "LL"), curve("walk", "RL"), curve("hit", "LL")]),
        ReliabilityPanel("waist", [curve("hit", "W")]),
    ]
    figure = draw_reliability(panels, 0.05)
    first, second = (
        [line for line in axis.lines if len(np.asarray(line.get_xdata())) == 3] for axis in figure.axes[:2]
    )
    assert first[0].get_color() == first[2].get_color() != first[4].get_color() == second[0].get_color()
    assert first[0].get_linewidth() > first[2].get_linewidth()
    key = figure.axes[2].get_legend()
    assert key is not None
    assert [text.get_text() for text in key.get_texts()][:2] == ["walk", "hit"]


def test_limbs_stand_in_the_panel_of_their_part_and_the_neck_in_none(settings: Settings, tmp_path: Path) -> None:
    section = settings.evaluation.calibration
    grids = [
        grid("walk_test", "LL"),
        grid("motion_test", "N"),
        grid("motion_test", "LA"),
        grid("hand_wrench", "RA", "RA2"),
        grid("knee_swing", "LL", "LL3", "FTS-e2e"),
    ]
    curves = curves_of(grids, section, 2, NOMINAL.tolist())
    panels = panels_of(curves, section)
    assert [panel.title for panel in panels] == ["legs (LL), MOB-Net", "legs (LL), FTS-e2e", "arms (LA, RA), MOB-Net"]
    assert [one.case for one in panels[2].curves] == ["in distribution", section.names["hand_wrench"]]
    np.testing.assert_allclose(curves[0].after, [0.2, 0.5, 0.8])
    reliability(section, grids, 2, NOMINAL.tolist(), tmp_path)
    rows = read_table(tmp_path / "calibration.csv")
    assert {row.limb for row in rows} == {"LL", "N", "LA", "RA"}


def test_plotted_numbers_are_told_as_learned_and_scaled() -> None:
    rows = list(curve_rows([curve("walk", "LL")]))
    assert rows[1] == ("walk", "A", "LL", 0.5, pytest.approx(0.4), pytest.approx(0.51))
    assert len(rows) == len(NOMINAL)
