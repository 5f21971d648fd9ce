"""Table of robots that networks do not know: errors, and what a check of the free swings says of them."""

from collections.abc import Sequence
from pathlib import Path

from experiments.evaluation.measure.estimates.changed import FLAGGED, FREE, KNOWN
from experiments.evaluation.number.lookup import read_lookup
from experiments.evaluation.tables.layout import percent, write_measured
from experiments.settings.measures import Changed
from experiments.settings.runs import LimbRuns, Statistics
from mobnet.core.joints import JointLayout
from mobnet.settings.networks import Learning

ERROR = "rmse"
SHARES = (KNOWN, FREE, FLAGGED)


def changed(
    settings: Changed, learning: Learning, layout: JointLayout, statistics: Statistics, scores: Sequence[Path],
    table_dir: Path,
) -> None:  # fmt: skip
    """Write changed.csv, with every joint and intervals, and changed.tex and .md: means over the joints of a limb."""
    lookup = read_lookup(scores, statistics)
    interval = f"{learning.calibration_share:.0%}"

    def lines_of(test: LimbRuns, limb: str) -> list[list[str]]:
        lines = []
        for method in test.methods:
            error = lookup.average(test, method, limb, ERROR)
            shares = [lookup.average(test, method, limb, metric) for metric in SHARES]
            lines.append([method, error.text(), *map(percent, shares)])
        return lines

    header = [
        "Robot", "Limb", "Method", "RMSE [N m]", f"errors in {interval} [%]", f"free swings in {interval} [%]",
        f"windows below {settings.least_share:.0%} [%]",
    ]  # fmt: skip
    tests = list(settings.tests.items())
    write_measured(table_dir / "changed", lookup, layout, tests, [ERROR, *SHARES], header, lines_of)
