"""Curves become points of a drawing and ticks at round values."""

import pytest

from experiments.evaluation.report.charts import GRID, Chart, line_chart, share, span, ticks


def places(chart: Chart, name: str) -> list[tuple[int, ...]]:
    """Return a curve's points as numbers."""
    return [tuple(map(int, pair.split(","))) for pair in chart.lines[name].split()]


def test_a_curve_fills_the_drawing_with_y_downwards() -> None:
    chart = line_chart("loss", "loss [-]", [1, 2, 3], {"a": [5.0, 1.0, 3.0]}, marked=2)
    assert places(chart, "a") == [(0, 0), (GRID // 2, GRID), (GRID, GRID // 2)]
    assert chart.marked == GRID // 2


def test_curves_share_one_axis() -> None:
    chart = line_chart("loss", "loss [-]", [1, 2], {"low": [0.0, 1.0], "high": [3.0, 4.0]}, marked=1)
    assert places(chart, "low")[0][1] == GRID
    assert places(chart, "high")[1][1] == 0
    assert places(chart, "low")[1][1] - places(chart, "high")[0][1] == GRID // 2


def test_a_single_point_is_a_dash_in_the_middle() -> None:
    (left, right) = places(line_chart("loss", "loss [-]", [7], {"a": [-3.0]}, marked=7), "a")
    assert left[1] == right[1] == GRID // 2
    assert left[0] < GRID // 2 < right[0]


@pytest.mark.parametrize("value", [-3.0, 0.0, 0.005])
def test_equal_values_are_drawn_in_the_middle(value: float) -> None:
    assert share(value, span([value, value])) == pytest.approx(0.5)


@pytest.mark.parametrize("ends", [(-5.8, -1.9), (0.5, 2000.0), (5e-5, 5e-3)])
def test_ticks_lie_inside_and_read_as_their_place(ends: tuple[float, float]) -> None:
    marks = ticks(ends)
    assert 2 <= len(marks) <= 7
    for mark in marks:
        assert 0.0 <= mark.place <= 1.0
        assert float(mark.text) == pytest.approx(ends[0] + mark.place * (ends[1] - ends[0]), rel=1e-3, abs=1e-9)


@pytest.mark.parametrize("last", [1, 2, 3, 20, 200])
def test_epochs_are_marked_by_whole_numbers(last: int) -> None:
    chart = line_chart("loss", "loss [-]", range(1, last + 1), {"a": list(range(last))}, marked=1)
    assert chart.x_ticks
    assert all(mark.text.isdigit() for mark in chart.x_ticks)
