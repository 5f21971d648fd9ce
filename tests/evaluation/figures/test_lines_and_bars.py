"""Lines and bars show the numbers given, each told from the others."""

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from mobnet.evaluation.figures.drawing.bars import BarPanel, draw_bar_panel, draw_bars
from mobnet.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from mobnet.evaluation.figures.style import COLUMN_INCH, LOOKS
from mobnet.evaluation.number.number import Number

BARS = {
    "MOB": [Number(9.0, 8.5, 9.5), Number(7.0, 6.5, 7.5)],
    "MOB-Net": [Number(2.0, 1.5, 2.5), Number(3.0, 2.5, 3.5)],
}


def lines(count: int, places: int) -> list[Line]:
    """Return made-up lines."""
    x = [1.0 + k for k in range(places)]
    return [Line(f"kind {k}", x, [Number(-y - k, -y - k - 0.5, -y - k + 0.5) for y in x]) for k in range(count)]


@pytest.mark.parametrize("sizes", [False, True])
def test_lines_show_their_means_and_differ_without_colour(sizes: bool) -> None:
    drawn = lines(6, 4)
    figure = draw_lines([LinePanel("one", "x [-]", "loss [-]", drawn, sizes)] * 2)
    assert figure.get_figwidth() == pytest.approx(COLUMN_INCH)
    for axis in figure.axes:
        assert (axis.get_xlabel(), axis.get_ylabel()) == ("x [-]", "loss [-]")
        shown = [line for line in axis.lines if len(line.get_xdata()) == 4 and line.get_linestyle() != "None"]
        for line, own in zip(shown, drawn, strict=True):
            np.testing.assert_array_equal(np.asarray(line.get_ydata()), own.columns[0])
        looks = {(str(line._unscaled_dash_pattern), line.get_marker()) for line in shown}  # type: ignore[attr-defined]
        assert len(looks) == len(drawn)
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [line.label for line in drawn]


def test_sizes_are_marked_where_they_are_on_a_logarithmic_axis() -> None:
    axis = draw_lines([LinePanel("one", "x", "y", lines(2, 3), sizes=True)]).axes[0]
    assert axis.get_xscale() == "log"
    assert axis.get_xticks().tolist() == [1.0, 2.0, 3.0]


def test_bars_have_their_heights_and_intervals_on_one_scale() -> None:
    heights = {"a": [1.0, 2.0], "b": [3.0, 4.0]}
    wide = {name: [Number(height, height - 0.5, height + 0.25) for height in own] for name, own in heights.items()}
    low = {name: [Number(height / 2) for height in own] for name, own in heights.items()}
    figure = draw_bars([BarPanel("ID", ["W", "RA"], wide), BarPanel("OOD", ["W", "RA"], low)], "RMSE [N m]")
    first, second = figure.axes
    assert first.get_ylim() == second.get_ylim()
    assert [patch.get_height() for patch in first.patches] == [1.0, 2.0, 3.0, 4.0]
    ends = np.concatenate([np.asarray(bars.get_segments())[:, :, 1] for bars in first.collections])
    np.testing.assert_allclose(ends, [[0.5, 1.25], [1.5, 2.25], [2.5, 3.25], [3.5, 4.25]])
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["a", "b"]


def test_a_run_that_leaps_flattens_no_line() -> None:
    calm, leaping = lines(2, 3)
    leaping = Line("b", leaping.x, [Number(number.value, number.low, 1e6) for number in leaping.numbers])
    low, high = draw_lines([LinePanel("one", "x", "y", [calm, leaping])]).axes[0].get_ylim()
    means = np.concatenate([calm.columns[0], leaping.columns[0]])
    assert low < means.min() < means.max() < high < 100


@pytest.fixture
def axis() -> Axes:
    """An empty panel."""
    return Figure().subplots()


def test_bars_have_heights_and_the_colours_of_their_methods(axis: Axes) -> None:
    draw_bar_panel(axis, BarPanel("a", ["1", "2"], BARS))
    assert [patch.get_height() for patch in axis.patches] == [9.0, 7.0, 2.0, 3.0]
    for bars, method in zip(axis.containers[1::2], BARS, strict=True):
        assert {patch.get_facecolor() for patch in bars} == {to_rgba(LOOKS[method].colour)}


def test_without_bars_there_is_an_empty_panel(axis: Axes) -> None:
    draw_bar_panel(axis, BarPanel("a", [], {}))
    assert not axis.patches


def test_panels_of_one_unit_have_one_scale_and_sizes_with_zero_a_linear_axis() -> None:
    small, large = (Line("a", [0.0, 50.0], [Number(size), Number(2.0 * size)]) for size in (1.0, 100.0))
    labels = {"loss [-]": small, "other loss [-]": large, "RMSE [N m]": large}
    axes = draw_lines([LinePanel("one", "x [-]", label, [line], sizes=True) for label, line in labels.items()]).axes
    assert axes[0].get_ylim() == axes[1].get_ylim() != axes[2].get_ylim()
    assert {axis.get_xscale() for axis in axes} == {"linear"}
