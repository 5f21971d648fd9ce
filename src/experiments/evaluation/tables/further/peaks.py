"""Table of pushes: how much of them an estimate shows, and how late."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from experiments.evaluation.measure.estimates.peaks import BOUND, DELAY, OBSERVER, SHARE
from experiments.evaluation.number.frames import read_scores, records_of, rows_of
from experiments.evaluation.number.number import interval_text, is_missing, number_text
from experiments.evaluation.number.scored import AVERAGE, asked_of, numbers_of
from experiments.evaluation.tables.layout import Table, in_blocks, write_table
from experiments.settings.measures import Peaks
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import METHODS
from mobnet.core.joints import JointLayout

REFERENCE = "low-pass of (11)"  # what a residual without any error would show


def peaks(
    settings: Peaks, layout: JointLayout, statistics: Statistics, scores: Sequence[Path], table_dir: Path
) -> None:
    """Write peaks.csv, with every joint, and peaks.tex and .md: share [-] and delay [ms] of pushes by method.

    A number is the mean over walks and networks of that of a walk; in the texts also the mean over the joints of a limb
    that the pushes turn. A delay is a lower bound, ">", where any of them ends with its window.
    """
    tests = [(test.scenario.replace("_", " "), test) for test in settings.tests]
    asked = asked_of(tests, [SHARE, DELAY, DELAY + OBSERVER, BOUND], layout)
    rows = numbers_of(read_scores(*scores), asked, statistics)
    averages = rows_of(rows, joint=AVERAGE)
    blocks: list[tuple[list[str], list[list[str]]]] = []
    for title, test in tests:
        blocks += [([title, limb], lines_of(rows_of(averages, title=title, limb=limb))) for limb in test.limbs]
    confidence = f"{statistics.confidence:.0%}"
    header = ["Push", "Limb", "Method", "Share", confidence, "Delay [ms]", confidence]
    records = records_of(rows[rows["value"].notna()], METHODS)
    write_table(table_dir / "peaks", Table(METHODS, records, header, in_blocks(blocks), left=3))


def lines_of(averages: pd.DataFrame) -> list[list[str]]:
    """Return a line of texts for each method, below one of the observer's low-pass alone, which has all of a push."""
    lines: list[list[str]] = []
    for method, of_method in averages.groupby("method", sort=False):
        numbers = dict(of_method.set_index("metric").iterrows())
        if not lines:
            lines.append([REFERENCE, "1", "", *texts_of(numbers[DELAY + OBSERVER], 1)])
        late, ends = texts_of(numbers[DELAY], 1)
        bound = numbers[BOUND]["value"]
        is_bound = not is_missing(bound) and bound > 0
        share = texts_of(numbers[SHARE], 2)
        lines.append([str(method), *share, f">{late}" if is_bound else late, ends])
    return lines


def texts_of(number: pd.Series, digits: int) -> tuple[str, str]:
    """Return a number and its interval as text with fixed digits."""
    return number_text(number["value"], digits), interval_text(number["low"], number["high"], digits)
