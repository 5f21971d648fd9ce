"""Lines show the numbers given, each told from the others."""

import numpy as np
import pytest
from matplotlib.axes import Axes

from experiments.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from experiments.evaluation.number.number import Number
from mobnet.core.style import COLUMN_INCH, PAGE_INCH


def lines(count: int, places: int) -> list[Line]:
    """Return made-up lines."""
    x = [1.0 + k for k in range(places)]
    return [Line(f"kind {k}", x, [Number(y + k, y + k - 0.5, y + k + 0.5) for y in x]) for k in range(count)]


def drawn_lines(axis: Axes) -> dict[str, np.ndarray]:
    """Return the values of the named lines of an axis."""
    return {str(line.get_label()): np.asarray(line.get_ydata()) for line in axis.lines if line.get_label()[0] != "_"}  # type: ignore[index]


@pytest.mark.parametrize(("columns", "width"), [(1, COLUMN_INCH), (2, PAGE_INCH)])
def test_lines_show_their_means_and_differ_without_colour(columns: int, width: float) -> None:
    drawn = lines(6, 4)
    figure = draw_lines([LinePanel("one", "x [-]", "loss [-]", drawn)] * 2, columns)
    assert figure.get_figwidth() == pytest.approx(width)
    assert figure.get_supxlabel() == "x [-]"
    assert figure.axes[0].get_ylabel() == "loss [-]"
    for axis in figure.axes:
        shown = drawn_lines(axis)
        assert list(shown) == [line.label for line in drawn]
        for own in drawn:
            np.testing.assert_array_equal(shown[own.label], own.columns[0])
        looks = {(str(line._unscaled_dash_pattern), line.get_marker()) for line in axis.lines}  # type: ignore[attr-defined]
        assert len(looks) == len(drawn)
        ends = np.concatenate([np.asarray(bars.get_segments())[:, :, 1] for bars in axis.collections])
        np.testing.assert_allclose(ends, np.concatenate([own.columns[1:].T for own in drawn]))
    assert [text.get_text() for text in figure.legends[0].get_texts()] == [line.label for line in drawn]


def test_places_are_named_where_they_are_on_a_logarithmic_axis_unless_steps_are_counted() -> None:
    axis = draw_lines([LinePanel("one", "x", "y", lines(2, 3))]).axes[0]
    assert (axis.get_xscale(), axis.get_xticks().tolist()) == ("log", [1.0, 2.0, 3.0])
    axis = draw_lines([LinePanel("one", "x", "y", lines(2, 3), logarithmic=False)]).axes[0]
    assert (axis.get_xscale(), axis.get_xticks().tolist()) == ("linear", [1.0, 2.0, 3.0])


def test_what_is_the_same_at_all_places_is_a_band_across_the_panel() -> None:
    axis = draw_lines([LinePanel("one", "x", "y", lines(1, 3), {"before": Number(4.0, 3.5, 5.0)})]).axes[0]
    assert set(drawn_lines(axis)["before"]) == {4.0}
    (band,) = axis.patches
    assert (band.get_y(), band.get_height()) == (3.5, 1.5)  # type: ignore[attr-defined]
    assert axis.get_ylim()[0] == 0.0


def test_a_value_beyond_the_axis_is_an_arrow_inside_it_and_no_value_within_is_one() -> None:
    line = Line("MOB", [1.0, 2.0, 3.0], [Number(0.5), Number(7.0), Number(-1.0)])
    axis = draw_lines([LinePanel("one", "x", "y", [line], ends=(0.0, 1.3))]).axes[0]
    arrows = {mark.get_marker(): mark for mark in axis.lines if mark.get_marker() in ("^", "v")}
    assert np.asarray(arrows["^"].get_xdata()).tolist() == [2.0]
    assert np.asarray(arrows["v"].get_xdata()).tolist() == [3.0]
    for mark in arrows.values():
        assert ((np.asarray(mark.get_ydata()) > 0.0) & (np.asarray(mark.get_ydata()) < 1.3)).all()


def test_marks_at_one_place_stand_beside_each_other_in_the_order_of_the_lines() -> None:
    axis = draw_lines([LinePanel("one", "x", "y", lines(3, 2), logarithmic=False, dodge=0.1)]).axes[0]
    np.testing.assert_allclose([np.asarray(line.get_xdata())[0] for line in axis.lines], [0.9, 1.0, 1.1])


def test_panels_share_the_axis_of_their_scale_alone() -> None:
    small, large = (Line("a", [1.0, 50.0], [Number(size), Number(2.0 * size)]) for size in (1.0, 100.0))
    panels = [
        LinePanel("one", "x", "y", [line], scale=scale) for scale, line in (("a", small), ("a", large), ("b", small))
    ]
    axes = draw_lines(panels).axes
    assert axes[0].get_ylim() == axes[1].get_ylim() != axes[2].get_ylim()
