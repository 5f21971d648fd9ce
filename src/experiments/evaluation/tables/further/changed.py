"""Table of robots that networks do not know: errors, and what a check of the free swings says of them."""

from collections.abc import Sequence
from pathlib import Path

from experiments.evaluation.measure.estimates.changed import FLAGGED, FREE, KNOWN
from experiments.evaluation.number.grid import read_lookup
from experiments.evaluation.tables.rows import ViewColumn, average, by_limb, measured, share_percent
from experiments.settings.measures import Changed
from experiments.settings.runs import Statistics
from mobnet.core.joints import JointLayout
from mobnet.settings.networks import Learning

ERROR = "rmse"


def changed(
    settings: Changed,
    learning: Learning,
    layout: JointLayout,
    statistics: Statistics,
    scores: Sequence[Path],
    table_dir: Path,
) -> None:
    """Write changed.csv, with every joint and intervals, and changed.tex and .md: means over the joints of a limb."""
    lookup = read_lookup(scores, statistics)
    interval = f"{learning.calibration_share:.0%}"
    rows = measured(lookup, layout, list(settings.tests.items()), [ERROR, KNOWN, FREE, FLAGGED])
    below = f"windows below {settings.least_share:.0%} [%]"
    columns = [
        ViewColumn("RMSE [N m]", average(ERROR)),
        ViewColumn(f"errors in {interval} [%]", average(KNOWN), text=share_percent),
        ViewColumn(f"free swings in {interval} [%]", average(FREE), text=share_percent),
        ViewColumn(below, average(FLAGGED), text=share_percent),
    ]
    rows.write(table_dir / "changed", by_limb("Robot", columns))
