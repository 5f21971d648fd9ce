"""Equations of the note on collision detection are cited beside the code that has them."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
NOTE = ROOT / "docs" / "notes" / "0036-detection.md"
ROOMS = ("detection", "evaluation/measure")


def test_every_equation_of_the_note_is_cited_in_the_code_and_no_other():
    numbers = [int(number) for number in re.findall(r"^ {4}.*\(D(\d+)\)$", NOTE.read_text(), flags=re.MULTILINE)]
    assert numbers == list(range(1, len(numbers) + 1))
    files = [path for room in ROOMS for path in (ROOT / "src/mobnet" / room).rglob("*.py")]
    cited = {int(number) for path in files for number in re.findall(r"\(D(\d+)\)", path.read_text())}
    assert cited == set(numbers)
