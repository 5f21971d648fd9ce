"""Table of errors in parts of a walk: by phase of the leg's gait, and of joints that are stuck or move."""

from collections.abc import Sequence
from pathlib import Path

from experiments.evaluation.compare.masks import MOVING, STUCK
from experiments.evaluation.compare.scene import STANCE, SWINGING, TOUCH_DOWN
from experiments.evaluation.number.grid import read_lookup
from experiments.evaluation.tables.rows import ViewColumn, average, by_limb, measured
from experiments.settings.measures import Phases
from experiments.settings.runs import Statistics
from mobnet.core.joints import JointLayout

WHOLE = "rmse"
PARTS = {SWINGING: "swing", TOUCH_DOWN: "touch-down", STANCE: "stance", STUCK: "stuck", MOVING: "moving"}


def phases(
    settings: Phases, layout: JointLayout, statistics: Statistics, scores: Sequence[Path], table_dir: Path
) -> None:
    """Write phases.csv, with every joint and intervals, and phases.tex and .md: RMSE [N m] in parts of a walk."""
    lookup = read_lookup(scores, statistics)
    tests = [(test.scenario.replace("_", " "), test) for test in settings.tests]
    shown = {WHOLE: "all", **{f"{WHOLE}_{part}": head for part, head in PARTS.items()}}
    rows = measured(lookup, layout, tests, list(shown))
    columns = [ViewColumn(head, average(metric)) for metric, head in shown.items()]
    rows.write(table_dir / "phases", by_limb("Test", columns))
