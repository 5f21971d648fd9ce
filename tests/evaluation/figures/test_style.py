"""A method looks the same in every figure, and no two of a figure look alike."""

from itertools import combinations

import matplotlib as mpl
import pytest
from matplotlib.figure import Figure

from mobnet.evaluation.figures.style import LOOKS, PAGE_INCH, PALETTE, STYLE, Look, legend, looks
from mobnet.settings.settings import Settings


def unlike(found: list[Look]) -> bool:
    """Return whether any two differ in colour, and in dash, hatch and marker without it."""
    keys = ("colour", "dash", "hatch", "marker")
    return all(getattr(one, key) != getattr(two, key) for one, two in combinations(found, 2) for key in keys)


def test_methods_of_one_figure_differ_in_colour_and_without_it(settings: Settings) -> None:
    whole = settings.evaluation
    varied = (whole.figure_20.parameters, whole.figure_20.samples)
    figures = [
        *whole.figure_05.panels.values(),
        *(figure.methods for figure in (whole.figure_06, whole.figure_07, whole.figure_08, whole.figure_09)),
        *(test.methods for test in (*whole.figure_10.tests.values(), *whole.drift.tests.values(), whole.bode)),
        *(whole.figure_17.methods, whole.figure_18.methods, *(settings.sweeps[key].of for key in varied)),
    ]
    assert unlike(list(PALETTE))
    for methods in figures:
        assert unlike([LOOKS[method] for method in dict.fromkeys(methods)])


@pytest.mark.parametrize("others", [[], ["a"], ["MOB", "a", "b"], [f"kind {k}" for k in range(6)]])
def test_a_method_keeps_its_look_beside_whatever_else_is_drawn(others: list[str]) -> None:
    found = looks([*others, "MOB-Net"])
    assert found["MOB-Net"] == LOOKS["MOB-Net"]
    assert unlike(list(found.values()))


def test_more_than_there_are_looks_begin_anew() -> None:
    assert looks(str(k) for k in range(len(PALETTE) + 1))[str(len(PALETTE))] == PALETTE[0]


@pytest.mark.parametrize(("entries", "rows"), [(1, 1), (4, 1), (9, 2), (30, 6)])
def test_a_legend_takes_as_many_rows_as_its_figure_is_wide(entries: int, rows: int) -> None:
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(PAGE_INCH, 4.0), layout="constrained")
        axis = figure.subplots()
        for k in range(entries):
            axis.plot([0, 1], label=f"robot_walk_plain {k}")
        legend(figure, [axis])
    figure.draw_without_rendering()
    (key,) = figure.legends
    assert key.get_window_extent().width <= figure.bbox.width
    assert [text.get_text() for text in key.get_texts()] == [f"robot_walk_plain {k}" for k in range(entries)]
    assert len({round(text.get_window_extent().y0) for text in key.get_texts()}) == rows
