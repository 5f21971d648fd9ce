"""Bars have their method's name and number, zero may leave the axis, and the paper's numbers stand beside them."""

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from experiments.evaluation.figures.drawing.named_bars import DRAWN_LABEL, NamedBar, draw_named_bars, draw_named_dots
from experiments.evaluation.figures.style import LOOKS
from experiments.evaluation.number.number import Number

BARS = [
    NamedBar("zero", "zero", Number(20.0)),
    NamedBar("MOB, noise", "MOB", Number(9.0, 8.5, 9.5), [8.0, 11.0]),
    NamedBar("MOB-Net", "MOB-Net", Number(2.0, 1.5, 2.5, published=12.0), [3.0]),
    NamedBar("FTS-e2e", "FTS-e2e", Number(None)),
]


@pytest.fixture
def axis() -> Axes:
    """An empty panel."""
    return Figure().subplots()


def texts_of(axis: Axes) -> list[str]:
    """Return what is written into an axis."""
    return [text.get_text() for text in axis.texts]


def test_bars_have_lengths_names_and_the_colours_of_their_methods(axis: Axes) -> None:
    draw_named_bars(axis, BARS, "N m")
    assert [patch.get_width() for patch in axis.patches[:3]] == [20.0, 9.0, 2.0]
    assert [patch.get_facecolor() for patch in axis.patches] == [to_rgba(LOOKS[bar.method].colour) for bar in BARS]
    assert [label.get_text() for label in axis.get_yticklabels()] == ["no estimate", *(bar.name for bar in BARS[1:])]
    low, high = axis.get_ylim()
    assert low > high  # the first is on top
    assert (texts_of(axis), axis.get_xlabel()) == (["20.0", "9.00", "2.00", "\N{MINUS SIGN}"], "RMSE [N m]")


def test_numbers_stand_at_the_end_of_their_rows_right_of_all_that_is_drawn(axis: Axes) -> None:
    draw_named_bars(axis, BARS, "N m")
    axis.figure.draw_without_rendering()  # type: ignore[union-attr]
    for text in axis.texts:
        assert axis.transAxes.inverted().transform(text.get_window_extent())[1][0] == pytest.approx(1.0, abs=0.02)
        assert axis.transData.inverted().transform(text.get_window_extent())[0][0] > 20.0  # the longest bar's end


def test_marks_and_the_papers_numbers_stand_at_their_bars(axis: Axes) -> None:
    draw_named_bars(axis, BARS, "N m", source="paper (robot)")
    found = {str(line.get_label()): np.array(line.get_xydata()) for line in axis.lines}
    np.testing.assert_array_equal(found[DRAWN_LABEL], [[8.0, 1.0], [11.0, 1.0], [3.0, 2.0]])
    printed = found["paper (robot)"]
    np.testing.assert_array_equal(printed[np.isfinite(printed[:, 0])], [[12.0, 2.0]])


@pytest.mark.parametrize(("size", "cut"), [(25.0, False), (900.0, True)])
def test_zero_is_cut_where_it_would_flatten_all_others(axis: Axes, size: float, cut: bool) -> None:
    draw_named_bars(axis, [NamedBar("zero", "zero", Number(size)), *BARS[1:]], "N")
    assert bool(axis.get_xlim()[1] < size) is cut
    assert axis.get_xlim()[1] > 12.0
    assert texts_of(axis)[0] == ("900 \N{RIGHTWARDS ARROW}" if cut else "25.0")


def test_dots_have_intervals_numbers_and_a_line_to_compare_with(axis: Axes) -> None:
    rows = [NamedBar("MOB", "MOB", Number(-2.5, -4.0, 1.0)), NamedBar("zero", "zero", Number(None))]
    draw_named_dots(axis, rows, "delay [ms]", 9.0)
    assert texts_of(axis) == ["\N{MINUS SIGN}2.50"]
    (segment,) = np.concatenate([bars.get_segments() for bars in axis.collections])
    np.testing.assert_allclose(segment, [[-4.0, 0.0], [1.0, 0.0]])
    line = axis.lines[0]
    assert (list(line.get_xdata()), axis.get_xlabel()) == ([9.0, 9.0], "delay [ms]")
    low, high = axis.get_xlim()
    assert low < -4.0 < 9.0 < high


@pytest.mark.parametrize("draw", [draw_named_bars, lambda axis, rows, unit: draw_named_dots(axis, rows, unit, None)])
def test_without_rows_there_is_an_empty_panel(axis: Axes, draw) -> None:
    draw(axis, [], "N m")
    assert texts_of(axis) == []
