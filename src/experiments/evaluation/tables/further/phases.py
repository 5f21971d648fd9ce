"""Table of errors in parts of a walk: by phase of the leg's gait, and of joints that are stuck or move."""

from collections.abc import Sequence
from pathlib import Path

from experiments.evaluation.compare.masks import MOVING, STUCK
from experiments.evaluation.compare.scene import STANCE, SWINGING, TOUCH_DOWN
from experiments.evaluation.number.frames import read_scores
from experiments.evaluation.number.scored import asked_of, numbers_of
from experiments.evaluation.tables.look import ShownColumn, average, by_limb, write_look
from experiments.settings.measures import Phases
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import METHODS
from mobnet.core.joints import JointLayout

WHOLE = "rmse"
PARTS = {SWINGING: "swing", TOUCH_DOWN: "touch-down", STANCE: "stance", STUCK: "stuck", MOVING: "moving"}


def phases(
    settings: Phases, layout: JointLayout, statistics: Statistics, scores: Sequence[Path], table_dir: Path
) -> None:
    """Write phases.csv, with every joint and intervals, and phases.tex and .md: RMSE [N m] in parts of a walk."""
    tests = [(test.scenario.replace("_", " "), test) for test in settings.tests]
    shown = {WHOLE: "all", **{f"{WHOLE}_{part}": head for part, head in PARTS.items()}}
    rows = numbers_of(read_scores(*scores), asked_of(tests, list(shown), layout), statistics)
    columns = [ShownColumn(head, average(metric)) for metric, head in shown.items()]
    write_look(table_dir / "phases", rows, METHODS, by_limb("Test", columns), rows[rows["value"].notna()])
