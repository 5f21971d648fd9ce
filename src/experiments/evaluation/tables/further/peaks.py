"""Table of pushes: how much of them an estimate shows, and how late."""

from collections.abc import Sequence
from pathlib import Path

from experiments.evaluation.measure.estimates.peaks import BOUND, DELAY, OBSERVER, SHARE
from experiments.evaluation.number.grid import Lookup, read_lookup
from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.layout import Table, in_blocks, write_table
from experiments.evaluation.tables.rows import measured
from experiments.settings.measures import Peaks
from experiments.settings.runs import LimbRuns, Statistics
from mobnet.core.columns import METHODS
from mobnet.core.joints import JointLayout

REFERENCE = "low-pass of (11)"  # what a residual without any error would show


def peaks(
    settings: Peaks, layout: JointLayout, statistics: Statistics, scores: Sequence[Path], table_dir: Path
) -> None:
    """Write peaks.csv, with every joint, and peaks.tex and .md: share [-] and delay [ms] of pushes by method.

    A number is the mean over walks and networks of that of a walk; in the texts also the mean over the joints of a limb
    that the pushes turn. A delay is a lower bound, ">", where any of them ends with its window.
    """
    lookup = read_lookup(scores, statistics)
    tests = [(test.scenario.replace("_", " "), test) for test in settings.tests]
    confidence = f"{statistics.confidence:.0%}"
    header = ["Push", "Limb", "Method", "Share", confidence, "Delay [ms]", confidence]
    rows = measured(lookup, layout, tests, [SHARE, DELAY, DELAY + OBSERVER, BOUND])
    blocks: list[tuple[list[str], list[list[str]]]] = []
    for title, test in tests:
        blocks += [([title, limb], lines_of(lookup, test, limb)) for limb in test.limbs]
    write_table(table_dir / "peaks", Table(METHODS, rows.records, header, in_blocks(blocks), left=3))


def lines_of(lookup: Lookup, test: LimbRuns, limb: str) -> list[list[str]]:
    """Return a line of texts for each method, below one of the observer's low-pass alone, which has all of a push."""
    lines = [[REFERENCE, "1", "", *texts_of(lookup.average(test, test.methods[0], limb, DELAY + OBSERVER), 1)]]
    for method in test.methods:
        share, delay, bound = (lookup.average(test, method, limb, name) for name in (SHARE, DELAY, BOUND))
        late, ends = texts_of(delay, 1)
        lines.append([method, *texts_of(share, 2), f">{late}" if bound.value else late, ends])
    return lines


def texts_of(number: Number, digits: int) -> tuple[str, str]:
    """Return a number and its interval as text with fixed digits."""
    return number.text(digits), number.interval(digits)
