"""Equations of the note on the walking controller are cited beside the code that has them."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
NOTE = ROOT / "docs" / "notes" / "0019-walking-controller.md"
CODE = [*(ROOT / "src/mobnet/control").glob("*.py"), ROOT / "src/mobnet/simulation/start.py"]


def test_every_equation_of_the_note_is_cited_in_the_code_and_no_other() -> None:
    """A range such as (W2) to (W4) cites all that lie in it; a module's docstring, which names such a range, none."""
    numbers = [int(number) for number in re.findall(r"^ {4}.*\(W(\d+)\)$", NOTE.read_text(), flags=re.MULTILINE)]
    assert numbers == list(range(1, len(numbers) + 1))
    cited: set[int] = set()
    for path in CODE:
        for first, last in re.findall(r"\(W(\d+)\)(?: to \(W(\d+)\))?", path.read_text().split('"""', 2)[2]):
            cited |= set(range(int(first), int(last or first) + 1))
    assert cited == set(numbers)
