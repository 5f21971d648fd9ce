"""Table of pushes: how high an estimate rises over the true peak, and how late."""

from collections.abc import Sequence
from pathlib import Path

from mobnet.core.columns import METHODS
from mobnet.core.joints import JointLayout
from mobnet.evaluation.measure.estimates.peaks import DELAY, OBSERVER, PEAK
from mobnet.evaluation.number.lookup import Lookup, read_lookup
from mobnet.evaluation.number.number import Number
from mobnet.evaluation.tables.layout import Line, Table, in_blocks, measured_rows, write_table
from mobnet.settings.evaluation import LimbRuns, Peaks, Statistics

REFERENCE = "low-pass of (11)"  # what a residual without any error would show


def peaks(
    settings: Peaks, layout: JointLayout, statistics: Statistics, scores: Sequence[Path], table_dir: Path
) -> None:
    """Write peaks.csv, with every joint, and peaks.tex and .md: peak ratio [-] and delay [ms] under pushes by method.

    A number is the mean over walks and networks of the median over the pushes of a walk; in the texts also the mean
    over the joints of a limb that the pushes turn.
    """
    lookup = read_lookup(scores, statistics)
    metrics = [name + suffix for suffix in ("", OBSERVER) for name in (PEAK, DELAY)]
    records = [row for test in settings.tests for row in measured_rows(lookup, layout, test, test.limbs, metrics)]
    blocks = [(labels_of(test, limb), lines_of(lookup, test, limb)) for test in settings.tests for limb in test.limbs]
    share = f"{statistics.confidence:.0%}"
    header = ["Push", "Limb", "Method", "Peak ratio", share, "Delay [ms]", share]
    lines: list[Line] = in_blocks(blocks)
    write_table(table_dir / "peaks", Table(METHODS, records, header, lines, left=3))


def labels_of(test: LimbRuns, limb: str) -> list[str]:
    """Return the leading cells of a test and a limb."""
    return [test.scenario.replace("_", " "), limb]


def lines_of(lookup: Lookup, test: LimbRuns, limb: str) -> list[list[str]]:
    """Return a line of texts for each method, below one of the observer's low-pass alone."""
    first = test.methods[0]
    rows = [(REFERENCE, [lookup.average(test, first, limb, name + OBSERVER) for name in (PEAK, DELAY)])]
    rows += [(method, [lookup.average(test, method, limb, name) for name in (PEAK, DELAY)]) for method in test.methods]
    return [[name, *texts_of(peak, 2), *texts_of(delay, 1)] for name, (peak, delay) in rows]


def texts_of(number: Number, digits: int) -> tuple[str, str]:
    """Return a number and its interval as text with fixed digits."""
    return number.text(digits), number.interval(digits)
