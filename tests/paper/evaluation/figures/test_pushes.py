"""The curves of a test share one scale, and the numbers of all methods are below them."""

from dataclasses import replace

import numpy as np
import pytest

from experiments.evaluation.compare.curves import Panel, TorqueCurve
from experiments.evaluation.figures.drawing.named_bars import NamedBar
from experiments.evaluation.figures.drawing.pushes import PushGroup, draw_hits, draw_step
from experiments.evaluation.number.number import Number
from mobnet.core.style import COLUMN_INCH, PAGE_INCH

TIME = np.linspace(-0.1, 0.2, 31)
METHODS = ("zero", "MOB", "MOB-Net")
LABELS = ("RMSE [N m]", "share of the push shown [-]", "delay of the rise [ms]")


def group(*sizes: float, number: float = 3.0) -> PushGroup:
    """Return a group of a push for each size, whose methods have a number with an interval."""
    curves = [[TorqueCurve("truth", size * np.sin(TIME)), TorqueCurve("MOB", size * np.cos(TIME))] for size in sizes]
    panels = [Panel(f"push {k}", TIME, own, {"push": TIME > 0.0}) for k, own in enumerate(curves)]
    rows = [NamedBar(name, name, Number(number, number - 1.0, number + 1.0), [number]) for name in METHODS]
    return PushGroup(panels, "numbers", rows, rows, rows, 9.0 if panels else None)


def test_a_step_is_a_column_wide_above_its_errors() -> None:
    one = group(1.0)
    figure = draw_step(one.panels, one.errors, "LL3", "RMSE")
    assert figure.get_figwidth() == pytest.approx(COLUMN_INCH)
    assert [axis.get_title(loc="left") for axis in figure.axes] == ["(a) push 0", "(b) RMSE [N m]"]
    assert not draw_step([], one.errors, "LL3", "RMSE").axes[0].lines


@pytest.mark.parametrize("count", [1, 2, 4])
def test_curves_and_numbers_are_lettered_in_order(count: int) -> None:
    figure = draw_hits(group(*range(1, count + 1)), "LL3", "paper")
    assert figure.get_figwidth() == pytest.approx(PAGE_INCH)
    titles = [axis.get_title(loc="left") for axis in figure.axes]
    assert sorted(title for title in titles if title.startswith("(")) == ["(a) push 0", "(b) numbers"]
    assert len(figure.axes) == count + 3


def test_a_page_wide_figure_is_flat_enough_for_the_paper() -> None:
    """Of as many methods as there are it needs less than a page's third, so that its type is not shrunk."""
    rows = [*group().errors, *group().shares]
    many = replace(group(*range(1, 5)), errors=rows, shares=rows, delays=rows)
    assert draw_hits(many, "LL3", "paper").get_figheight() < 8.8 / 2.54


def test_curves_share_a_scale_that_holds_them_all() -> None:
    figure = draw_hits(group(1.0, 5.0, 2.0), "LL3", "paper")
    curves = [axis for axis in figure.axes if "push" in axis.get_title(loc="left")]
    ((_, top),) = {axis.get_ylim() for axis in curves}
    assert len(curves) == 3
    assert top >= 5.0
    assert [axis.get_ylabel() for axis in curves] == ["hip pitch\n(LL3) [N m]", "", ""]


def test_rows_of_methods_are_named_once_and_what_a_perfect_estimate_has_is_marked() -> None:
    figure = draw_hits(group(1.0), "LL3", "paper")
    by_label = {axis.get_xlabel(): axis for axis in figure.axes}
    errors, shares, delays = (by_label[label] for label in LABELS)
    assert [text.get_text() for text in errors.get_yticklabels()] == ["no estimate", "MOB", "MOB-Net"]
    for axis, ideal in ((shares, 1.0), (delays, 9.0)):
        assert axis.get_ylim() == errors.get_ylim()
        assert not axis.yaxis.get_tick_params()["labelleft"]
        assert ideal in [np.asarray(line.get_xdata())[0] for line in axis.lines]


def test_a_test_without_pushes_has_no_curves() -> None:
    figure = draw_hits(PushGroup([], "numbers", [], [], [], None), "LL3", "paper")
    assert len(figure.axes) == 4
    assert [len(axis.lines) for axis in figure.axes if "LL3" in axis.get_ylabel()] == [0]
