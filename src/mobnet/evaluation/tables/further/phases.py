"""Table of errors in parts of a walk: by phase of the leg's gait, and of joints that are stuck or move."""

from collections.abc import Sequence
from pathlib import Path

from mobnet.core.columns import METHODS
from mobnet.core.joints import JointLayout
from mobnet.evaluation.compare.masks import MOVING, STUCK
from mobnet.evaluation.compare.scene import STANCE, SWINGING, TOUCH_DOWN
from mobnet.evaluation.number.lookup import read_lookup
from mobnet.evaluation.tables.layout import Table, in_blocks, measured_rows, write_table
from mobnet.settings.evaluation import Phases, Statistics

WHOLE = "rmse"
PARTS = {SWINGING: "swing", TOUCH_DOWN: "touch-down", STANCE: "stance", STUCK: "stuck", MOVING: "moving"}


def phases(
    settings: Phases, layout: JointLayout, statistics: Statistics, scores: Sequence[Path],
    table_dir: Path,
) -> None:  # fmt: skip
    """Write phases.csv, with every joint and intervals, and phases.tex and .md: RMSE [N m] in parts of a walk."""
    lookup = read_lookup(scores, statistics)
    metrics = [WHOLE, *(f"{WHOLE}_{part}" for part in PARTS)]
    records = [row for test in settings.tests for row in measured_rows(lookup, layout, test, test.limbs, metrics)]
    blocks = [
        (
            [test.scenario.replace("_", " "), limb],
            [[name, *(lookup.average(test, name, limb, metric).text() for metric in metrics)] for name in test.methods],
        )
        for test in settings.tests
        for limb in test.limbs
    ]
    header = ["Test", "Limb", "Method", "all", *PARTS.values()]
    write_table(table_dir / "phases", Table(METHODS, records, header, in_blocks(blocks), left=3))
