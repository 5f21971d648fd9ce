"""Equations of the notes that derive them are cited beside the code that has them."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
NOTES = ROOT / "docs" / "notes"
SOURCE = ROOT / "src"


@pytest.mark.parametrize(("note", "letter", "code"), [
    ("walking", "W", ["mobnet/control/*.py", "mobnet/simulation/start.py"]),
    ("observer", "O", ["mobnet/estimation/**/*.py", "mobnet/kernel/*.py", "experiments/jobs/*.py"]),
    ("networks", "N", ["mobnet/learning/**/*.py"]),
    ("detection", "D", ["mobnet/detection/**/*.py", "experiments/jobs/*.py", "experiments/evaluation/**/*.py"]),
])  # fmt: skip
def test_every_equation_of_a_note_is_cited_in_the_code_and_no_other(note, letter, code):
    """A range such as (W2) to (W4) cites all that lie in it; a module's docstring, which names such a range, none."""
    text = (NOTES / f"{note}.md").read_text()
    numbers = [int(number) for number in re.findall(rf"^ {{4}}.*\({letter}(\d+)\)$", text, flags=re.MULTILINE)]
    assert numbers == list(range(1, len(numbers) + 1))
    cited = set()
    for path in (path for pattern in code for path in SOURCE.glob(pattern)):
        body = path.read_text().split('"""', 2)[2]
        for first, last in re.findall(rf"\({letter}(\d+)\)(?: to \({letter}(\d+)\))?", body):
            cited |= set(range(int(first), int(last or first) + 1))
    assert cited == set(numbers)
