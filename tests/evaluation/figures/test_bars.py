"""Bars have their heights, the paper's numbers stand at their bars, and notes have room above them."""

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mobnet.evaluation.figures.drawing.bars import BarPanel, draw_bar_panel
from mobnet.evaluation.figures.style import LOOKS
from mobnet.evaluation.number.number import Number

BARS = {
    "MOB": [Number(9.0, 8.5, 9.5), Number(7.0, 6.5, 7.5)],
    "MOB-Net": [Number(2.0, 1.5, 2.5), Number(3.0, 2.5, 3.5, published=12.0)],
}


@pytest.fixture
def axis() -> Axes:
    """An empty panel."""
    return Figure().subplots()


def test_bars_have_heights_and_the_colours_of_their_methods(axis: Axes) -> None:
    draw_bar_panel(axis, BarPanel("a", ["1", "2"], BARS))
    assert [patch.get_height() for patch in axis.patches] == [9.0, 7.0, 2.0, 3.0]
    for bars, method in zip(axis.containers[1::2], BARS, strict=True):
        assert {patch.get_facecolor() for patch in bars} == {_rgba(LOOKS[method].colour)}


def test_the_papers_numbers_stand_within_the_bars_that_have_one(axis: Axes) -> None:
    draw_bar_panel(axis, BarPanel("a", ["1", "2"], BARS, "paper (robot)"))
    (marks,) = [line for line in axis.lines if line.get_label() == "paper (robot)"]
    x, y = np.asarray(marks.get_xdata()), np.asarray(marks.get_ydata())
    assert np.isnan(y[0])
    assert y[1] == 12.0
    bar = axis.patches[3]
    assert bar.get_x() < x[1] < bar.get_x() + bar.get_width()


@pytest.mark.parametrize(("angle", "tops"), [(0, [9.5, 7.5, 2.5, 12.0]), (90, [9.5, 12.0, 9.5, 12.0])])
def test_notes_stand_above_their_bars_or_upright_above_the_group(axis: Axes, angle: int, tops: list[float]) -> None:
    notes = {"MOB": ["a", "b"], "MOB-Net": ["c", "d"]}
    draw_bar_panel(axis, BarPanel("a", ["1", "2"], BARS, notes=notes), angle)
    assert [text.get_text() for text in axis.texts] == ["a", "b", "c", "d"]
    assert [text.xy[1] for text in axis.texts] == tops  # type: ignore[attr-defined]
    assert axis.get_ylim()[1] > 12.0


def test_without_bars_there_is_an_empty_panel(axis: Axes) -> None:
    draw_bar_panel(axis, BarPanel("a", [], {}))
    assert not axis.patches


def _rgba(colour: str) -> tuple[float, ...]:
    """Return a colour as Matplotlib stores it."""
    return (*(int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)), 1.0)
