"""Figures show the arrays given, and equal arrays give equal files."""

from pathlib import Path

import numpy as np
import pytest

from mobnet.evaluation.figures import COLUMN_INCH, Panel, curve_rows, draw_gait_cycle, save_figure


@pytest.fixture
def panels() -> list[Panel]:
    """Four panels of a made-up cycle of 1.4 s."""
    time = np.arange(140) / 100.0
    truth = 40.0 * np.sin(4.5 * time)
    methods = (("MOB", 1.0), ("MOB", 15.0), ("MOB-Net", 1.5), ("FTS-e2e", 2.5))
    return [Panel(f"{m}, {i}", m, time, time < 0.7, truth, truth + e) for i, (m, e) in enumerate(methods)]


def test_each_panel_draws_its_own_arrays(panels: list[Panel]) -> None:
    figure = draw_gait_cycle(panels, "LL3")
    assert len(figure.axes) == len(panels)
    for axis, panel in zip(figure.axes, panels, strict=True):
        drawn = {line.get_label(): np.asarray(line.get_ydata()) for line in axis.lines}
        np.testing.assert_array_equal(drawn["truth"], panel.truth)
        np.testing.assert_array_equal(drawn[panel.method], panel.estimate)


def test_panels_share_one_scale_and_the_axes_name_their_units(panels: list[Panel]) -> None:
    figure = draw_gait_cycle(panels, "LL3")
    assert len({axis.get_ylim() for axis in figure.axes}) == 1
    assert "[s]" in figure.axes[-1].get_xlabel()
    assert "LL3 [N m]" in figure.get_supylabel()
    assert figure.get_figwidth() == pytest.approx(COLUMN_INCH)


def test_equal_arrays_give_equal_files_without_dates(tmp_path: Path, panels: list[Panel]) -> None:
    for name in ("a", "b"):
        save_figure(draw_gait_cycle(panels, "LL3"), tmp_path / name)
    for suffix in (".pdf", ".png"):
        one, two = ((tmp_path / name).with_suffix(suffix).read_bytes() for name in ("a", "b"))
        assert one == two
    assert b"CreationDate" not in (tmp_path / "a.pdf").read_bytes()
    assert b"/FontFile2" in (tmp_path / "a.pdf").read_bytes()


def test_plotted_numbers_are_those_drawn_in_order(panels: list[Panel]) -> None:
    rows = curve_rows(panels)
    assert len(rows) == 4 * 140
    assert rows[140] == (panels[1].title, 0.0, 1, panels[1].truth[0], panels[1].estimate[0])
