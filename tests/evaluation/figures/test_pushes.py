"""A group's curves share one scale, its numbers stand below them, and numbers of groups share theirs."""

import numpy as np
import pytest

from experiments.evaluation.compare.curves import Panel, TorqueCurve
from experiments.evaluation.figures.drawing.named_bars import NamedBar
from experiments.evaluation.figures.drawing.pushes import PushGroup, draw_hits, draw_step
from experiments.evaluation.number.number import Number
from mobnet.core.style import COLUMN_INCH, PAGE_INCH

TIME = np.linspace(-0.1, 0.2, 31)
METHODS = ("zero", "MOB", "MOB-Net")


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


@pytest.mark.parametrize("groups", [[group(1.0)], [group(1.0, 2.0), group(1.0)], [group(*range(1, 5))] * 2])
def test_curves_and_numbers_are_lettered_in_order(groups: list[PushGroup]) -> None:
    figure = draw_hits(groups, "LL3", "paper")
    assert figure.get_figwidth() == pytest.approx(PAGE_INCH)
    titles = [axis.get_title(loc="left") for axis in figure.axes]
    lettered = sorted(title for title in titles if title.startswith("("))
    expected = [text for k in range(len(groups)) for text in (f"({'ac'[k]}) push 0", f"({'bd'[k]}) numbers")]
    assert lettered == expected
    assert len(figure.axes) == sum(len(one.panels) + 3 for one in groups)


def test_curves_of_a_group_share_a_scale_that_holds_them_all() -> None:
    figure = draw_hits([group(1.0, 5.0, 2.0), group(1.0)], "LL3", "paper")
    curves = [axis for axis in figure.axes if "push" in axis.get_title(loc="left")]
    assert len(curves) == 4
    scales = {axis.get_ylim() for axis in curves}
    assert len(scales) == 2
    assert max(top for _, top in scales) >= 5.0
    assert [axis.get_ylabel() for axis in curves] == ["LL3 [N m]", "", "", "LL3 [N m]"]


def test_numbers_of_one_kind_share_a_scale_that_holds_them_all() -> None:
    figure = draw_hits([group(1.0), group(1.0, number=30.0)], "LL3", "paper")
    labels = ("RMSE [N m]", "share of the push shown [-]", "delay of the rise [ms]")
    for label in labels:
        limits = {axis.get_xlim() for axis in figure.axes if axis.get_xlabel() == label}
        ((low, high),) = limits
        assert low < 3.0 < 31.0 < high


def test_a_group_without_pushes_has_no_curves() -> None:
    empty = PushGroup([], "numbers", [], [], [], None)
    figure = draw_hits([empty, empty], "LL3", "paper")
    assert len(figure.axes) == 8
    assert [len(axis.lines) for axis in figure.axes if axis.get_ylabel() == "LL3 [N m]"] == [0, 0]
