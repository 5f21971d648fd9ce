"""Quantities: known numbers, equality where cells are equal, the same number draw by draw."""

import numpy as np
import pytest

from mobnet.evaluation.number.quantities import QUANTITIES
from mobnet.settings.claims import TAKES

EXAMPLES = {
    "value": ([3.0], 3.0),
    "ratio": ([3.0, 2.0], 1.5),
    "cut": ([1.0, 4.0], 0.75),
    "difference": ([1.0, 4.0], -3.0),
    "below": ([-5.0, -4.0, -4.75, 2.0], 0.25),
    "above": ([5.0, 1.0, 3.0], 2.0),
    "falls": ([4.0, 3.0, 1.0, 2.0], 4 / 6),
    "least ratio": ([6.0, 9.0, 4.0, 3.0], 1.5),
    "gap ratio": ([1.0, 2.0, 7.0, 3.0], 0.25),
}


def test_every_quantity_has_an_example_and_takes_cells() -> None:
    assert EXAMPLES.keys() == QUANTITIES.keys() == TAKES.keys()


@pytest.mark.parametrize("name", EXAMPLES)
def test_number_of_an_example_whether_alone_or_among_draws(name: str) -> None:
    means, number = EXAMPLES[name]
    quantity, (least, step) = QUANTITIES[name], TAKES[name]
    assert len(means) in range(least, 9, step or 9)
    assert quantity.made(np.array(means)) == pytest.approx(number)
    np.testing.assert_allclose(quantity.made(np.tile(np.array(means)[:, None], 5)), np.full(5, number))


@pytest.mark.parametrize("name", [name for name, quantity in QUANTITIES.items() if quantity.equality is not None])
def test_equal_cells_give_equality(name: str) -> None:
    """Identity: cells that are alike give what counts as equality."""
    quantity = QUANTITIES[name]
    means = np.full(TAKES[name][0], 2.0)
    if name == "gap ratio":
        means[::2] += 1.0
    assert quantity.made(means) == pytest.approx(quantity.equality)


def test_falls_is_one_for_a_falling_row_and_minus_one_for_a_rising_one() -> None:
    """The order of the cells decides, not their size."""
    row = np.arange(7.0)
    assert QUANTITIES["falls"].made(-row) == 1.0
    assert QUANTITIES["falls"].made(row) == -1.0


@pytest.mark.parametrize("name", ["ratio", "cut", "least ratio", "gap ratio", "falls"])
def test_numbers_without_a_unit_are_invariant_under_a_change_of_it(name: str, rng: np.random.Generator) -> None:
    means = rng.uniform(1.0, 9.0, max(TAKES[name][0], 4) if TAKES[name][1] else TAKES[name][0])
    assert QUANTITIES[name].made(1000.0 * means) == pytest.approx(QUANTITIES[name].made(means))


@pytest.mark.parametrize("name", ["difference", "below", "above"])
def test_differences_are_invariant_under_an_offset_that_all_share(name: str, rng: np.random.Generator) -> None:
    means = rng.uniform(1.0, 9.0, TAKES[name][0])
    assert QUANTITIES[name].made(means + 5.0) == pytest.approx(QUANTITIES[name].made(means))
