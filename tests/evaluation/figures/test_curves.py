"""Figures show the arrays given, and equal arrays give equal files."""

import csv
from pathlib import Path

import numpy as np
import pytest

from mobnet.evaluation.compare.curves import Panel, TorqueCurve
from mobnet.evaluation.figures.drawing.curves import draw_panels, table_of
from mobnet.evaluation.figures.style import COLUMN_INCH, PAGE_INCH, UNDATED, save_figure
from mobnet.evaluation.number.files import write_csv

TIME = np.arange(140) / 100.0
TRUTH = 40.0 * np.sin(4.5 * TIME)
SWING = {"swing": TIME < 0.7, "push": (TIME > 0.2) & (TIME < 0.3)}


@pytest.fixture
def panels() -> list[Panel]:
    """Four panels of a made-up cycle of 1.4 s."""
    methods = (("MOB", 1.0), ("MOB", 15.0), ("MOB-Net", 1.5), ("FTS-e2e", 2.5))
    return [
        Panel(f"{m}, {i}", TIME, [TorqueCurve("truth", TRUTH), TorqueCurve(m, TRUTH + e)], SWING)
        for i, (m, e) in enumerate(methods)
    ]


def test_each_panel_draws_its_own_arrays(panels: list[Panel]) -> None:
    figure = draw_panels(panels, "time [s]", "torque [N m]")
    assert len(figure.axes) == len(panels)
    for axis, panel in zip(figure.axes, panels, strict=True):
        drawn = {line.get_label(): np.asarray(line.get_ydata()) for line in axis.lines}
        assert list(drawn) == [curve.label for curve in panel.curves]
        for curve in panel.curves:
            np.testing.assert_array_equal(drawn[curve.label], curve.values)


def test_a_flag_is_marked_where_it_holds_and_not_named_where_it_never_does(panels: list[Panel]) -> None:
    never = Panel("none", TIME, panels[0].curves, {"swing": TIME < 0.0})
    figure = draw_panels([panels[0], never], "time [s]", "torque [N m]")
    marks = {mark.get_label(): mark.get_paths() for mark in figure.axes[0].collections}
    assert list(marks) == ["swing", "push"]
    for name, flags in SWING.items():
        (path,) = marks[name]
        assert (path.vertices[:, 0].min(), path.vertices[:, 0].max()) == (TIME[flags][0], TIME[flags][-1])
    assert not figure.axes[1].collections


def test_a_band_is_a_standard_deviation_wide_on_both_sides() -> None:
    std = np.linspace(1.0, 2.0, len(TIME))
    panel = Panel("band", TIME, [TorqueCurve("MOB-Net", TRUTH, std)], {})
    (band,) = draw_panels([panel], "time [s]", "torque [N m]").axes[0].collections
    edges = band.get_paths()[0].vertices
    for side in (-1, 1):
        expected = np.stack([TIME, TRUTH + side * std], axis=1)
        assert {tuple(row) for row in expected.tolist()} <= {tuple(row) for row in np.asarray(edges).tolist()}


@pytest.mark.parametrize("one_scale", [True, False])
def test_scales_are_one_where_wanted_and_the_axes_name_their_units(panels: list[Panel], one_scale: bool) -> None:
    wider = Panel("wide", TIME, [TorqueCurve("truth", 10.0 * TRUTH)], {})
    figure = draw_panels([*panels, wider], "time [s]", "torque of LL3 [N m]", one_scale=one_scale)
    assert (len({axis.get_ylim() for axis in figure.axes}) == 1) is one_scale
    assert (figure.get_supxlabel(), figure.get_supylabel()) == ("time [s]", "torque of LL3 [N m]")


@pytest.mark.parametrize(("columns", "width"), [(1, COLUMN_INCH), (2, PAGE_INCH), (3, PAGE_INCH)])
def test_panels_side_by_side_take_two_columns_and_leave_spare_places_empty(
    panels: list[Panel], columns: int, width: float
) -> None:
    figure = draw_panels(panels, "time [s]", "torque [N m]", columns)
    assert figure.get_figwidth() == pytest.approx(width)
    assert sum(axis.get_visible() for axis in figure.axes) == len(panels)


def test_nothing_drawn_is_twice_in_the_legend(panels: list[Panel]) -> None:
    (legend,) = draw_panels(panels, "time [s]", "torque [N m]").legends
    names = [text.get_text() for text in legend.get_texts()]
    assert sorted(names) == ["FTS-e2e", "MOB", "MOB-Net", "push", "swing", "truth"]


def test_equal_arrays_give_equal_files_without_dates(tmp_path: Path, panels: list[Panel]) -> None:
    for name in ("a", "b"):
        save_figure(draw_panels(panels, "time [s]", "torque [N m]"), tmp_path / name, *table_of(panels))
    for suffix in UNDATED:
        one, two = ((tmp_path / name).with_suffix(suffix).read_bytes() for name in ("a", "b"))
        assert one == two
    assert b"CreationDate" not in (tmp_path / "a.pdf").read_bytes()
    assert b"<dc:date>" not in (tmp_path / "a.svg").read_bytes()
    assert b"/FontFile2" in (tmp_path / "a.pdf").read_bytes()


def test_written_numbers_are_those_drawn_and_a_missing_curve_is_empty(tmp_path: Path, panels: list[Panel]) -> None:
    write_csv(tmp_path / "a.csv", *table_of(panels))
    with (tmp_path / "a.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 4 * 140
    assert list(rows[0]) == ["panel", "time_s", "swing", "push", "truth", "MOB", "MOB-Net", "FTS-e2e"]
    row, at = rows[2 * 140 + 25], 25
    assert (row["panel"], row["swing"], row["push"], row["MOB"]) == ("MOB-Net, 2", "1", "1", "")
    numbers = [float(row[name]) for name in ("time_s", "truth", "MOB-Net")]
    assert numbers == pytest.approx([TIME[at], TRUTH[at], TRUTH[at] + 1.5], rel=1e-5)
