"""Table of robots that networks do not know: errors, and what a check of the free swings says of them."""

from collections.abc import Sequence
from pathlib import Path

from experiments.evaluation.measure.estimates.changed import FLAGGED, FREE, KNOWN
from experiments.evaluation.number.frames import read_scores
from experiments.evaluation.number.scored import asked_of, numbers_of
from experiments.evaluation.tables.look import ShownColumn, average, by_limb, percent, write_look
from experiments.settings.measures import Changed
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import METHODS
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
    asked = asked_of(settings.tests.items(), [ERROR, KNOWN, FREE, FLAGGED], layout)
    rows = numbers_of(read_scores(*scores), asked, statistics)
    interval = f"{learning.calibration_share:.0%}"
    below = f"windows below {settings.least_share:.0%} [%]"
    columns = [
        ShownColumn("RMSE [N m]", average(ERROR)),
        ShownColumn(f"errors in {interval} [%]", average(KNOWN), text=percent),
        ShownColumn(f"free swings in {interval} [%]", average(FREE), text=percent),
        ShownColumn(below, average(FLAGGED), text=percent),
    ]
    write_look(table_dir / "changed", rows, METHODS, by_limb("Robot", columns), rows[rows["value"].notna()])
