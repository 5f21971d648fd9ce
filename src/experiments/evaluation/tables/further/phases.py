"""Table of errors in parts of a walk: by phase of the leg's gait, and of joints that are stuck or move."""

from collections.abc import Sequence
from pathlib import Path

from experiments.evaluation.compare.masks import MOVING, STUCK
from experiments.evaluation.compare.scene import STANCE, SWINGING, TOUCH_DOWN
from experiments.evaluation.number.lookup import read_lookup
from experiments.evaluation.tables.layout import write_measured
from experiments.settings.measures import Phases
from experiments.settings.runs import LimbRuns, Statistics
from mobnet.core.joints import JointLayout

WHOLE = "rmse"
PARTS = {SWINGING: "swing", TOUCH_DOWN: "touch-down", STANCE: "stance", STUCK: "stuck", MOVING: "moving"}


def phases(
    settings: Phases, layout: JointLayout, statistics: Statistics, scores: Sequence[Path],
    table_dir: Path,
) -> None:  # fmt: skip
    """Write phases.csv, with every joint and intervals, and phases.tex and .md: RMSE [N m] in parts of a walk."""
    lookup = read_lookup(scores, statistics)
    metrics = [WHOLE, *(f"{WHOLE}_{part}" for part in PARTS)]

    def lines_of(test: LimbRuns, limb: str) -> list[list[str]]:
        lines = []
        for name in test.methods:
            errors = [lookup.average(test, name, limb, metric) for metric in metrics]
            lines.append([name, *(error.text() for error in errors)])
        return lines

    tests = [(test.scenario.replace("_", " "), test) for test in settings.tests]
    header = ["Test", "Limb", "Method", "all", *PARTS.values()]
    write_measured(table_dir / "phases", lookup, layout, tests, metrics, header, lines_of)
