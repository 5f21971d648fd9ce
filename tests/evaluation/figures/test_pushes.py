"""A group's curves share one scale and its bars stand below them; one group is a column wide, more are two."""

import numpy as np
import pytest

from mobnet.evaluation.compare.curves import Panel, TorqueCurve
from mobnet.evaluation.figures.drawing.pushes import PushGroup, draw_pushes
from mobnet.evaluation.figures.style import COLUMN_INCH, PAGE_INCH
from mobnet.evaluation.measure.estimates.pushes import AVERAGE, INCREASE
from mobnet.evaluation.number.number import Number

TIME = np.linspace(-0.1, 0.2, 31)
ERRORS = {"MOB": {"avg": Number(3.0, 2.0, 4.0)}}


def group(*sizes: float) -> PushGroup:
    """Return a group of a push for each size."""
    curves = [[TorqueCurve("truth", size * np.sin(TIME)), TorqueCurve("MOB", size * np.cos(TIME))] for size in sizes]
    panels = [Panel(f"push {k}", TIME, own, {"push": TIME > 0.0}) for k, own in enumerate(curves)]
    return PushGroup("test", panels, ERRORS, "errors")


@pytest.mark.parametrize(
    ("groups", "across", "width"), [([group(1.0)], 1, COLUMN_INCH), ([group(1.0, 2.0)] * 2, 2, PAGE_INCH)]
)
def test_curves_and_bars_are_lettered_in_order(groups: list[PushGroup], across: int, width: float) -> None:
    figure = draw_pushes(groups, "LL3", across)
    assert figure.get_figwidth() == pytest.approx(width)
    titles = [axis.get_title(loc="left") for axis in figure.axes]
    assert (
        sorted(title[:3] for title in titles if title.startswith("("))
        == ["(a)", "(b)", "(c)", "(d)"][: 2 * len(groups)]
    )
    assert sum("errors" in title for title in titles) == len(groups)


def test_curves_of_a_group_share_a_scale_that_holds_them_all() -> None:
    figure = draw_pushes([group(1.0, 5.0, 2.0), group(1.0)], "LL3", across=2)
    shown = [axis for axis in figure.axes if axis.get_visible()]
    curves = [axis for axis in shown if "push" in axis.get_title(loc="left")]
    assert len(curves) == 4
    scales = {axis.get_ylim() for axis in curves}
    assert len(scales) == 2
    assert max(top for _, top in scales) >= 5.0
    assert {axis.get_ylabel() for axis in shown} == {"LL3 torque [N m]", "RMSE [N m]", ""}
    assert {axis.get_xlabel() for axis in shown} == {"time from push [s]", ""}


def test_a_group_without_pushes_is_empty() -> None:
    empty = PushGroup("test", [], {}, "errors")
    figure = draw_pushes([empty, empty], "LL3", across=2)
    assert [bool(axis.lines) for axis in figure.axes if axis.get_visible()] == [False, False]


def test_bars_are_a_push_each_and_tell_average_and_increase() -> None:
    pushes = {"1": Number(2.0, 1.0, 3.0), AVERAGE: Number(2.0, 1.5, 2.5, published=6.5), INCREASE: Number(-1.0)}
    bars = PushGroup("test", [], {"MOB": pushes}, "errors").bars()
    assert bars.groups == ["1", AVERAGE]
    assert bars.bars == {"MOB": [pushes["1"], pushes[AVERAGE]]}
    assert bars.notes == {"MOB": ["", "2.0 (\N{MINUS SIGN}1.0)"]}


def test_upright_notes_end_below_the_title_also_above_the_highest_bar() -> None:
    """A push of each test, as at the smoke scale."""
    errors = {name: {AVERAGE: Number(19.0 + k), INCREASE: Number(-11.0)} for k, name in enumerate(("MOB", "MOB-Net"))}
    figure = draw_pushes([PushGroup("test", group(1.0).panels, errors, "errors")] * 2, "LL3", 2, 90)
    figure.draw_without_rendering()
    notes = [(text, axis) for axis in figure.axes for text in axis.texts if text.get_text()]
    assert [text.get_text() for text, _ in notes] == [f"{k}.0 (\N{MINUS SIGN}11.0)" for k in (19, 20)] * 2
    assert all(text.get_window_extent().y1 <= axis.bbox.y1 for text, axis in notes)
