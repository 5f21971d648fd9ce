"""The menus of the documentation follow from its index."""

import pytest

from experiments.site.contents import menus, sections
from mobnet.core.errors import DataError

INDEX = """# Index

## Start
| [README](../README.md) | first |
| [start](start.md) | then |
| [start](start.md) | again |

## Explain
Text with a [link](other.md).

### Observer, and friction
| [observer](notes/observer.md) | one |

### Walking
| [walking](notes/walking.md) | two |

## Results
| [results](results) | a folder |
"""


def test_documents_stand_in_the_order_of_the_index_and_the_first_page_in_no_menu() -> None:
    found = sections(INDEX)
    assert list(found) == ["Start", "Explain", "Results"]
    assert found["Start"].documents == ("docs/start.md",)
    assert found["Results"].documents == ("docs/results/README.md",)
    assert found["Explain"].documents == ()


def test_a_group_is_a_page_with_its_table_and_its_documents() -> None:
    first, second = sections(INDEX)["Explain"].groups
    assert (first.path, second.path) == ("docs/observer-and-friction.md", "docs/walking.md")
    assert first.page.startswith("# Observer, and friction\n")
    assert "| [observer](notes/observer.md) | one |" in first.page
    assert "/docs/notes/observer\n" in first.page
    assert "notes/walking" not in first.page


def test_menus_have_made_pages_behind_documents_and_before_groups() -> None:
    start, explain, results = menus(INDEX, {"Start": ("made.md",)})
    assert start.splitlines()[1:] == [":hidden:", ":caption: Start", "", "/docs/start", "/made", "```"]
    assert "/docs/observer-and-friction\n/docs/walking\n" in explain
    assert "/docs/results/README\n" in results


@pytest.mark.parametrize(("index", "added", "message"), [
    ("# Index\n", {}, "no section is found"),
    (INDEX, {"Reference": ("x.md",)}, "section 'Reference' is missing; it has Start, Explain, Results"),
])  # fmt: skip
def test_an_index_without_a_section_is_told(index, added, message) -> None:
    with pytest.raises(DataError, match=message):
        list(menus(index, added))
