"""A method looks the same in every figure, and no two of a figure look alike."""

from itertools import combinations

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from experiments.evaluation.figures.style import KINDS, LOOKS, PALETTE, Look, apart, legend, looks
from experiments.settings.settings import Settings
from mobnet.core.style import PAGE_INCH, STYLE


def unlike(found: list[Look]) -> bool:
    """Return whether any two differ in colour, and without it in hatch, marker, and dash or width of their lines."""
    ways = [lambda look: look.colour, lambda look: look.hatch, lambda look: look.marker]
    ways += [lambda look: (str(look.dash), look.width)]
    return all(way(one) != way(two) for one, two in combinations(found, 2) for way in ways)


def lightness(colour: str) -> float:
    """Return CIE's L* of a colour, 0 to 100."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(colour)]
    y = float(np.dot([0.2126, 0.7152, 0.0722], linear))
    return 116.0 * y ** (1 / 3) - 16.0


def test_our_networks_the_formula_and_the_truth_are_solid_and_other_baselines_are_not() -> None:
    solid = {name for name, look in LOOKS.items() if look.dash == "-"} - set(KINDS)
    assert solid == {"MOB-Net", "MOB-Net-Single", "MOB-fric-load", "MOB-fric-dahl", "truth", "target"}


@pytest.mark.parametrize(("one", "two"), [("MOB", "MOB-fric"), ("MOB-Net", "MOB-fric-dahl"), ("MOB-Net", "MOB")])
def test_methods_side_by_side_differ_in_lightness_and_width(one: str, two: str) -> None:
    lights, widths = (
        [getter(LOOKS[name]) for name in (one, two)]
        for getter in (lambda look: lightness(look.colour), lambda look: look.width)
    )
    assert abs(lights[0] - lights[1]) > 8.0
    assert abs(widths[0] - widths[1]) >= 0.4


def test_methods_of_one_figure_differ_in_colour_and_without_it(settings: Settings) -> None:
    whole = settings.evaluation
    varied = (whole.figure_20.parameters, whole.figure_20.samples)
    figures = [
        *whole.figure_05.panels.values(),
        *(figure.methods for figure in (whole.figure_06, whole.figure_07, whole.figure_08, whole.figure_09)),
        *(test.methods for test in (*whole.figure_10.tests.values(), *whole.drift.tests.values(), whole.bode)),
        *(whole.figure_17.best, whole.figure_18.methods, *(settings.sweeps[key].of for key in varied)),
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


def test_names_of_lines_are_moved_apart_and_stay_below_the_top() -> None:
    assert apart([0.2, 0.9], 0.1, 1.0) == [0.2, 0.9]
    assert apart([1.0, 0.98, 0.2], 0.1, 1.0) == pytest.approx([1.0, 0.9, 0.2])
    assert apart([0.5, 0.5], 0.1, 1.0) == pytest.approx([0.5, 0.6])
    assert apart([], 0.1, 1.0) == []
