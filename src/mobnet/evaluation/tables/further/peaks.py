"""Table of pushes: how high an estimate rises over the true peak, and how late."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from mobnet.core.joints import JointLayout
from mobnet.evaluation.measure.estimates.peaks import DELAY, OBSERVER, PEAK
from mobnet.evaluation.number.lookup import Lookup, read_lookup
from mobnet.evaluation.number.number import Number
from mobnet.evaluation.tables.layout import write_measured
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
    share, tests = f"{statistics.confidence:.0%}", [(test.scenario.replace("_", " "), test) for test in settings.tests]
    header = ["Push", "Limb", "Method", "Peak ratio", share, "Delay [ms]", share]
    write_measured(table_dir / "peaks", lookup, layout, tests, metrics, header, partial(lines_of, lookup))


def lines_of(lookup: Lookup, test: LimbRuns, limb: str) -> list[list[str]]:
    """Return a line of texts for each method, below one of the observer's low-pass alone."""
    first = test.methods[0]
    rows = [(REFERENCE, [lookup.average(test, first, limb, name + OBSERVER) for name in (PEAK, DELAY)])]
    rows += [(method, [lookup.average(test, method, limb, name) for name in (PEAK, DELAY)]) for method in test.methods]
    return [[name, *texts_of(peak, 2), *texts_of(delay, 1)] for name, (peak, delay) in rows]


def texts_of(number: Number, digits: int) -> tuple[str, str]:
    """Return a number and its interval as text with fixed digits."""
    return number.text(digits), number.interval(digits)
