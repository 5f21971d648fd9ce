"""Table of robots that networks do not know: errors, and what a check of the free swings says of them."""

from collections.abc import Sequence
from pathlib import Path

from mobnet.core.columns import METHODS
from mobnet.core.joints import JointLayout
from mobnet.evaluation.measure.estimates.changed import FLAGGED, FREE, KNOWN
from mobnet.evaluation.number.lookup import read_lookup
from mobnet.evaluation.tables.layout import Table, in_blocks, measured_rows, percent, write_table
from mobnet.settings.evaluation import Changed, Statistics
from mobnet.settings.networks import Learning

ERROR = "rmse"
SHARES = (KNOWN, FREE, FLAGGED)


def changed(
    settings: Changed, learning: Learning, layout: JointLayout, statistics: Statistics, scores: Sequence[Path],
    table_dir: Path,
) -> None:  # fmt: skip
    """Write changed.csv, with every joint and intervals, and changed.tex and .md: means over the joints of a limb."""
    lookup = read_lookup(scores, statistics)
    tests = settings.tests.items()
    records = [row for _, test in tests for row in measured_rows(lookup, layout, test, test.limbs, [ERROR, *SHARES])]
    blocks = [
        (
            [title, limb],
            [
                [method, lookup.average(test, method, limb, ERROR).text(),
                 *(percent(lookup.average(test, method, limb, metric)) for metric in SHARES)]
                for method in test.methods
            ],
        )
        for title, test in tests
        for limb in test.limbs
    ]  # fmt: skip
    interval = f"{learning.calibration_share:.0%}"
    header = [
        "Robot", "Limb", "Method", "RMSE [N m]", f"errors in {interval} [%]", f"free swings in {interval} [%]",
        f"windows below {settings.least_share:.0%} [%]",
    ]  # fmt: skip
    write_table(table_dir / "changed", Table(METHODS, records, header, in_blocks(blocks), left=3))
