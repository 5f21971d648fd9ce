"""A method looks the same in every figure, and no two of a figure look alike."""

import pytest

from mobnet.evaluation.figures.style import CYCLE, LOOKS, looks


def test_methods_differ_in_colour_and_without_it() -> None:
    for kind in (LOOKS.values(), CYCLE):
        assert len({look.colour for look in kind}) == len(kind)
    methods = [look for name, look in LOOKS.items() if name not in ("truth", "target")]
    for kind in (methods, CYCLE):
        assert len({look.hatch for look in kind}) == len({look.marker for look in kind}) == len(kind)


@pytest.mark.parametrize("others", [[], ["a"], ["MOB", "a", "b"], [f"kind {k}" for k in range(6)]])
def test_a_method_keeps_its_look_beside_whatever_else_is_drawn(others: list[str]) -> None:
    found = looks([*others, "MOB-Net"])
    assert found["MOB-Net"] == LOOKS["MOB-Net"]
    assert len({look.colour for look in found.values()}) == len(found)


def test_more_than_there_are_looks_begin_anew() -> None:
    assert looks(str(k) for k in range(9))["7"] == CYCLE[0]
