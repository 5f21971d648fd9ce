"""Table and figure of the standard deviations' calibration: made together, because they are measured together."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd

from experiments.evaluation.figures.further.reliability import nominal_points, reliability
from experiments.evaluation.measure.learning.calibration import held_out, in_tests
from experiments.evaluation.tables.further.calibration_table import trust_table
from experiments.plan.runs import Run
from experiments.settings.measures import CalibrationTable, Coverage
from experiments.settings.runs import Statistics
from mobnet.core.joints import JointLayout
from mobnet.settings.networks import Learning


def calibration(
    settings: CalibrationTable,
    learning: Learning,
    coverage: Coverage,
    layout: JointLayout,
    statistics: Statistics,
    folders: Mapping[str, Sequence[Path]],
    runs: Sequence[Sequence[Run]],
    table_dir: Path,
    figure_dir: Path,
) -> None:
    """Write calibration.csv, .tex and .md, and the reliability diagram as calibration.pdf, .png and .csv.

    `folders` are the trained networks by the level that they learned at, `runs` those of each test of `settings`.
    """
    levels = learning.calibration_levels
    points = nominal_points(settings.points)
    shares = list(dict.fromkeys([*levels, *points]))  # a point that is a level is measured once
    tested = in_tests(layout, coverage, settings.tests, runs, shares)
    measures = pd.concat([held_out(layout, folders, levels), tested], ignore_index=True)
    trust_table(settings, learning, statistics, measures, table_dir)
    reliability(settings, tested, points, figure_dir)
