"""Quantities: known numbers of known cells, whose means are taken first, and what leaves them as they are."""

import numpy as np
import pytest
from paper_settings import STATISTICS

from experiments.intervals.crossed import RunGrid
from experiments.intervals.quantities import QUANTITIES, Cell
from experiments.settings.claims import TAKES

EXAMPLES = {
    "value": ([3.0], 3.0),
    "ratio": ([3.0, 2.0], 1.5),
    "cut": ([1.0, 4.0], 0.75),
    "square cut": ([1.0, 4.0], 0.9375),
    "difference": ([1.0, 4.0], -3.0),
    "below": ([-5.0, -4.0, -4.75, 2.0], 0.25),
    "above": ([5.0, 1.0, 3.0], 2.0),
    "least ratio": ([6.0, 9.0, 4.0, 3.0], 1.5),
    "gap ratio": ([1.0, 2.0, 7.0, 3.0], 0.25),
    "gap difference": ([1.0, 2.0, 7.0, 3.0], -3.0),
    "trend": ([4.0, 3.0, 1.0, 0.0], -17.0 / 12.0),
    "share": ([0.75], 0.75),
}


def cells_of(means: list[float], spread: float = 0.0) -> list[Cell]:
    """Return cells of one grid with four runs around each mean."""
    offsets = spread * np.array([[-1.0, 1.0], [1.0, -1.0]])
    return [[RunGrid(mean + offsets, "MOB-Net")] for mean in means]


def number(name: str, cells: list[Cell]) -> float:
    """Return the number that a quantity makes of cells."""
    value = QUANTITIES[name](cells, STATISTICS, "-").value
    assert value is not None
    return value


def test_every_quantity_has_an_example_and_takes_cells() -> None:
    assert EXAMPLES.keys() == QUANTITIES.keys() == TAKES.keys()


@pytest.mark.parametrize("name", EXAMPLES)
def test_number_of_an_example(name: str) -> None:
    means, expected = EXAMPLES[name]
    least, step = TAKES[name]
    assert len(means) in range(least, 9, step or 9)
    assert number(name, cells_of(means, 0.01 * (name != "share"))) == pytest.approx(expected, rel=1e-3)


def test_a_cell_is_the_mean_over_its_joints_whatever_networks_they_have() -> None:
    one, three = RunGrid(np.full((1, 2), 2.0), "MOB-Net"), RunGrid(np.full((3, 2), 4.0), "MOB-Net")
    assert number("value", [[one, three]]) == pytest.approx(3.0)
    assert number("ratio", [[one, three], [one]]) == pytest.approx(1.5)
    assert number("square cut", [[one], [one, three]]) == pytest.approx(1 - 4.0 / 10.0)


@pytest.mark.parametrize("name", ["ratio", "cut", "square cut", "least ratio", "gap ratio"])
def test_numbers_without_a_unit_are_invariant_under_a_change_of_it(name: str, rng: np.random.Generator) -> None:
    means = rng.uniform(1.0, 9.0, max(TAKES[name][0], 4) if TAKES[name][1] else TAKES[name][0])
    once, often = (number(name, cells_of([factor * mean for mean in means])) for factor in (1.0, 1000.0))
    assert once == pytest.approx(often)


@pytest.mark.parametrize("name", ["difference", "gap difference", "below", "above", "trend"])
def test_differences_are_invariant_under_an_offset_that_all_share(name: str, rng: np.random.Generator) -> None:
    means = rng.uniform(1.0, 9.0, TAKES[name][0])
    once, raised = (number(name, cells_of([mean + offset for mean in means])) for offset in (0.0, 5.0))
    assert once == pytest.approx(raised)
