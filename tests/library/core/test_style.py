"""A figure that is laid out has its panels at the same places in every process."""

import random
from pathlib import Path

import kiwisolver
import pytest
from matplotlib.figure import Figure

from mobnet.core.style import settle

ROOT = Path(__file__).parents[3]
HEIGHTS = (1.15, 0.85, 0.6)


def panels_of(settled: bool) -> tuple[tuple[float, ...], ...]:
    """Lay out a figure of many panels; return their places."""
    figure = Figure(figsize=(7.0, 4.0), layout="constrained")
    for axis in figure.subplots(3, 4, height_ratios=HEIGHTS).ravel():
        axis.set_title("a panel", fontsize=7)
    if settled:
        settle(figure)
    figure.draw_without_rendering()
    return tuple(tuple(axis.get_position().bounds) for axis in figure.axes)


def test_panels_are_at_the_same_places_wherever_the_solver_has_its_variables(monkeypatch: pytest.MonkeyPatch) -> None:
    """Kiwisolver adds up in the order of its variables' addresses, which all that a process drew before changes."""
    variables = [kiwisolver.Variable("") for _ in range(2000)]
    places = {True: set(), False: set()}
    for seed in range(40):
        if seed >= 3 and len(places[False]) > 1:
            break  # an order of the addresses may well give the same sums, forty orders do not
        for settled, found in places.items():
            random.Random(seed).shuffle(variables)
            free = iter(variables)
            monkeypatch.setattr(kiwisolver, "Variable", lambda _, free=free: next(free))
            found.add(panels_of(settled))
    assert len(places[True]) == 1
    assert len(places[False]) > 1  # else nothing was tested: the last digits do depend on it


def test_whoever_saves_a_figure_settles_its_layout_first() -> None:
    saving = [text for path in (ROOT / "src").rglob("*.py") if ".savefig(" in (text := path.read_text())]
    assert len(saving) >= 3
    assert all(text.index("settle(figure)") < text.index(".savefig(") for text in saving)
