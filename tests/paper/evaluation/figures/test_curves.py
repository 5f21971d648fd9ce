"""Panels show the arrays given, errors stand on a scale of their own, and equal arrays give equal files."""

import csv
import re
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from experiments.evaluation.compare.curves import ZERO, Curves, Panel, TorqueCurve, compared
from experiments.evaluation.figures.drawing.compared import (
    bars_of,
    draw_columns,
    draw_leg,
    draw_relative_columns,
    draw_stack,
)
from experiments.evaluation.figures.drawing.curves import draw_panel, held, table_of
from experiments.evaluation.figures.style import UNDATED, save_figure, shortened, with_stable_names
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import write_csv
from mobnet.core.style import COLUMN_INCH, PAGE_INCH

TIME = np.arange(140) / 100.0
TRUTH = 40.0 * np.sin(4.5 * TIME)
SWING = {"swing": TIME < 0.7, "push": (TIME > 0.2) & (TIME < 0.3)}
ERRORS = {"MOB": 15.0, "FTS-e2e": 2.5, "MOB-Net": 1.5}
NUMBERS = {name: Number(error, error - 0.5, error + 0.5) for name, error in {ZERO: 28.0, **ERRORS}.items()}


@pytest.fixture
def panels() -> list[Panel]:
    """Four panels of a made-up cycle of 1.4 s."""
    methods = (("MOB", 1.0), ("MOB", 15.0), ("MOB-Net", 1.5), ("FTS-e2e", 2.5))
    return [
        Panel(f"{m}, {i}", TIME, [TorqueCurve("truth", TRUTH), TorqueCurve(m, TRUTH + e)], SWING)
        for i, (m, e) in enumerate(methods)
    ]


@pytest.fixture
def panel() -> Panel:
    """A panel of three methods, of which one has a standard deviation."""
    std = np.linspace(1.0, 2.0, len(TIME))
    curves = [TorqueCurve(name, TRUTH + error, std if name == "MOB-Net" else None) for name, error in ERRORS.items()]
    return Panel("LL3", TIME, [TorqueCurve("truth", TRUTH), *curves], SWING)


@pytest.fixture
def axis() -> Axes:
    """An empty panel."""
    return Figure().subplots()


def drawn_in(axis: Axes) -> dict[str, np.ndarray]:
    """Return the named lines of an axis."""
    lines = {str(line.get_label()): np.asarray(line.get_ydata()) for line in axis.lines}
    return {label: values for label, values in lines.items() if not label.startswith("_")}


def test_a_panel_draws_its_own_arrays(axis: Axes, panel: Panel) -> None:
    draw_panel(axis, panel)
    drawn = drawn_in(axis)
    assert list(drawn) == [curve.label for curve in panel.curves]
    for curve in panel.curves:
        np.testing.assert_array_equal(drawn[curve.label], curve.values)


def test_a_flag_is_marked_where_it_holds_and_not_named_where_it_never_does(axis: Axes, panels: list[Panel]) -> None:
    draw_panel(axis, panels[0])
    marks = {mark.get_label(): mark.get_paths() for mark in axis.collections}
    assert list(marks) == ["swing", "push"]
    for name, flags in SWING.items():
        (path,) = marks[name]
        assert (path.vertices[:, 0].min(), path.vertices[:, 0].max()) == (TIME[flags][0], TIME[flags][-1])
    other = axis.figure.add_subplot()
    draw_panel(other, Panel("none", TIME, panels[0].curves, {"swing": TIME < 0.0}))
    assert not other.collections


def test_a_flag_may_hold_several_times_and_at_both_ends() -> None:
    assert held(np.array([1, 1, 0, 0, 1, 0, 1])) == [(0, 1), (4, 4), (6, 6)]
    assert held(np.zeros(3)) == []


def test_a_band_is_a_standard_deviation_wide_on_both_sides(axis: Axes, panel: Panel) -> None:
    draw_panel(axis, panel)
    (band,) = [one for one in axis.collections if "std" in str(one.get_label())]
    assert band.get_label() == "\N{PLUS-MINUS SIGN} 1 std of MOB-Net"
    edges, ours = band.get_paths()[0].vertices, panel.curves[-1]
    for side in (-1, 1):
        expected = np.stack([TIME, ours.values + side * np.asarray(ours.std)], axis=1)
        assert {tuple(row) for row in expected.tolist()} <= {tuple(row) for row in np.asarray(edges).tolist()}


def test_errors_are_what_estimates_are_off_the_truth_and_zero_errs_by_all_of_it(panel: Panel) -> None:
    pair = compared(panel)
    for curve in pair.error.curves:
        np.testing.assert_allclose(curve.values, ERRORS[curve.label])
    assert pair.rmse == pytest.approx({ZERO: np.sqrt(np.mean(TRUTH**2)), **ERRORS})
    assert compared(panel, "push").rmse[ZERO] == pytest.approx(np.sqrt(np.mean(TRUTH[SWING["push"]] ** 2)))
    calm = Panel("", TIME, panel.curves, {"push": np.zeros(len(TIME), dtype=bool)})
    assert compared(calm, "push").rmse == {}


def test_errors_have_an_axis_of_their_own_with_one_and_two_standard_deviations(panel: Panel) -> None:
    figure = draw_columns(
        [compared(panel)], [bars_of(NUMBERS, {})], ["N m"], ["FTS-e2e", "MOB-Net"], "time [s]", "paper"
    )
    torque, error, below = figure.axes
    assert list(drawn_in(torque)) == ["truth", *ERRORS]
    assert list(drawn_in(error)) == ["FTS-e2e", "MOB-Net"]
    assert error.get_ylim() == pytest.approx((-1.25 * ERRORS["MOB-Net"], 1.25 * ERRORS["MOB-Net"]))
    bands = {str(one.get_label()): one.get_paths()[0].vertices[:, 1] for one in error.collections}
    for times in (1, 2):
        edges = bands[f"\N{PLUS-MINUS SIGN} {times} std of MOB-Net"]
        assert (edges.min(), edges.max()) == (-2.0 * times, 2.0 * times)
    assert [text.get_text() for text in below.get_yticklabels()] == ["no estimate", *list(NUMBERS)[1:]]
    assert (torque.get_ylabel(), error.get_ylabel()) == ("torque [N m]", "error [N m]")


def test_a_method_far_off_the_others_is_cut_by_the_axis_of_torque(panel: Panel) -> None:
    far = Panel("LL3", TIME, [panel.curves[0], TorqueCurve("MOB", TRUTH + 500.0), *panel.curves[2:]], {})
    figure = draw_columns([compared(far)], [bars_of(NUMBERS, {})], ["N m"], ["MOB-Net"], "time [s]", "paper")
    low, high = figure.axes[0].get_ylim()
    assert low < TRUTH.min() < TRUTH.max() + 1.5 < high < 100.0


def test_errors_of_limbs_are_shares_on_one_scale_with_a_line_at_one(panel: Panel) -> None:
    shares = [bars_of({"MOB": Number(size), "MOB-Net": Number(0.02)}, {}) for size in (0.5, 2.0)]
    figure = draw_relative_columns(
        [compared(panel)] * 2, shares, ["N m", "N"], ["MOB-Net"], "time [s]", ["W", "V1 to V3"]
    )
    first, second = figure.axes[-2:]
    assert first.get_xlim() == second.get_xlim()
    assert first.get_xlim()[1] > 2.0
    assert [text.get_text() for text in first.texts] == ["0.50", "0.020"]
    assert second.get_xlabel() == "relative RMSE of V1 to V3 [-]"
    assert [list(line.get_xdata()) for line in second.lines][-1] == [1.0, 1.0]


def test_a_low_pass_smooths_all_curves_from_their_first_values_on() -> None:
    steps = np.repeat([1.0, 3.0], 500)[:, None]
    curves = Curves(("LL3",), steps, steps, {"MOB": steps + 1.0}, {"MOB": None}, {}, (), 1000.0)
    smooth = curves.low_passed(15.0)
    assert smooth.truth[499, 0] == pytest.approx(1.0)
    after = round(1000.0 / (2.0 * np.pi * 15.0))  # a time constant after the step
    assert smooth.truth[499 + after, 0] == pytest.approx(3.0 - 2.0 * np.exp(-1.0), rel=0.02)
    np.testing.assert_allclose(smooth.estimates["MOB"], smooth.truth + 1.0)
    assert smooth.stds == {"MOB": None}


def test_joints_of_two_units_have_labels_of_their_own(panel: Panel) -> None:
    pairs = [compared(panel)] * 2
    figure = draw_columns(pairs, [bars_of(NUMBERS, {})] * 2, ["N m", "N"], ["MOB-Net"], "time [s]", "paper")
    labels = [axis.get_ylabel() for axis in figure.axes]
    assert labels == ["torque [N m]", "force [N]", "error [N m]", "error [N]", "", ""]
    assert [axis.get_xlabel() for axis in figure.axes[-2:]] == ["RMSE [N m]", "RMSE [N]"]


def test_levels_are_a_column_wide_and_joints_a_page(panel: Panel, panels: list[Panel]) -> None:
    stack = draw_stack([compared(panels[0]), compared(panel)], bars_of(NUMBERS, {}), ["MOB-Net"], "RMSE", "LL3")
    leg = draw_leg([compared(panel)] * 6)
    assert (stack.get_figwidth(), leg.get_figwidth()) == (pytest.approx(COLUMN_INCH), pytest.approx(PAGE_INCH))
    assert (len(stack.axes), len(leg.axes)) == (5, 12)
    titles = [axis.get_title(loc="left") for axis in stack.axes]
    assert titles == ["(a) MOB, 0", "", "(b) LL3", "", "(c) RMSE"]
    assert list(drawn_in(stack.axes[1])) == ["MOB"]  # the only one there is


def test_nothing_drawn_is_twice_in_the_legend(panel: Panel) -> None:
    (legend,) = draw_leg([compared(panel)] * 6).legends
    names = [text.get_text() for text in legend.get_texts()]
    assert sorted(name for name in names if "std" not in name) == [
        "FTS-e2e",
        "MOB",
        "MOB-Net",
        "push",
        "swing",
        "truth",
    ]
    assert len(names) == 8


def test_equal_arrays_give_equal_files_without_dates(tmp_path: Path, panel: Panel) -> None:
    for name in ("a", "b"):
        save_figure(draw_leg([compared(panel)] * 3), tmp_path / name, *table_of([panel]))
    for suffix in UNDATED:
        one, two = ((tmp_path / name).with_suffix(suffix).read_bytes() for name in ("a", "b"))
        assert one == two
    assert b"CreationDate" not in (tmp_path / "a.pdf").read_bytes()
    assert b"<dc:date>" not in (tmp_path / "a.svg").read_bytes()
    assert b"/FontFile2" in (tmp_path / "a.pdf").read_bytes()


def test_a_drawing_loses_digits_of_its_paths_alone() -> None:
    svg = '<path d="M 1.23456 -7.891 L 10 0.5" style="stroke-width: 0.8125"/><g transform="scale(0.0655)"/>'
    assert shortened(svg) == svg.replace("1.23456", "1.23").replace("7.891", "7.89")


def test_clip_paths_are_named_by_what_is_drawn_and_not_by_the_last_digits_of_their_corners() -> None:
    svg = '<g clip-path="url(#p{0})"/><clipPath id="p{0}"><i x="{2}"/></clipPath><g clip-path="url(#p{1})"/><i id="p"/>'
    one = with_stable_names(svg.format("0123456789", "abcdefabcd", 1.5))
    assert with_stable_names(svg.format("abcdefabcd", "0000000000", 1.5)) == one
    names = re.findall(r"clip-[0-9a-f]{8}-\d", one)
    assert names == [names[0], names[0], f"{names[0][:-1]}1"]
    assert '<i id="p"/>' in one
    assert names[0] not in with_stable_names(svg.format("0123456789", "abcdefabcd", 2.5))


def test_every_text_is_six_points_high_or_more_and_lies_on_the_page(panel: Panel) -> None:
    figures = [
        draw_columns([compared(panel)] * 4, [bars_of(NUMBERS, {})] * 4, ["N m"] * 4, ["MOB-Net"], "time [s]", "paper"),
        draw_stack([compared(panel)] * 2, bars_of(NUMBERS, {}), ["MOB-Net"], "RMSE", "LL3"),
        draw_leg([compared(panel)] * 6),
    ]
    for figure in figures:
        with mpl.rc_context({"savefig.dpi": 100}):
            figure.draw_without_rendering()
        texts = [text for text in figure.findobj(mpl.text.Text) if text.get_text() and text.get_visible()]
        assert min(text.get_fontsize() for text in texts) >= 6.0
        (key,) = figure.legends
        box = key.get_window_extent()
        assert 0.0 <= box.x0 < box.x1 <= figure.bbox.width


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
