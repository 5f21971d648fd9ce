"""Intervals stand alone: the example of docs/intervals.md prints what the page says, and its package needs no other."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from experiments.intervals.bounds import Bounds, verdict_on
from experiments.intervals.number import Number

PAGE = Path(__file__).parents[3] / "docs" / "intervals.md"
PRINTED = re.compile(r"^It prints `(.*)`", flags=re.MULTILINE)
NEEDED = """
import sys
print(*sorted(name for name in sys.modules if name.startswith(("mobnet", "experiments.", "pydantic"))), sep=chr(10))
"""


def test_the_example_prints_what_the_page_says_and_needs_its_package_alone() -> None:
    text = PAGE.read_text(encoding="utf-8")
    (code,) = re.findall(r"^```python\n(.*?)^```$", text, flags=re.DOTALL | re.MULTILINE)
    done = subprocess.run([sys.executable, "-c", code + NEEDED], capture_output=True, text=True, check=True)
    printed, *modules = done.stdout.splitlines()
    assert [printed] == PRINTED.findall(text)
    assert {".".join(name.split(".")[:2]) for name in modules} == {"experiments.intervals"}


@pytest.mark.parametrize(
    ("bounds", "verdict"),
    [
        ((1.0, 2.0), "inside"),
        ((None, 2.0), "inside"),
        ((1.3, None), "open"),
        ((1.9, 3.0), "outside"),
        ((None, 1.1), "outside"),
        ((None, None), "inside"),
    ],
)
def test_a_verdict_follows_from_the_interval_alone(bounds: Bounds, verdict: str) -> None:
    assert verdict_on(Number(1.5, 1.2, 1.8), bounds) == verdict
    assert verdict_on(Number(1.5), bounds) == "open"
