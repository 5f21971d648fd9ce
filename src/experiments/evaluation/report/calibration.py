"""Table and figure of the standard deviations' calibration: made together, because they are measured together."""

from collections.abc import Mapping, Sequence
from pathlib import Path

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
    grids = in_tests(layout, coverage, settings.tests, runs, [*levels, *points])
    held = held_out(layout, folders, levels)
    trust_table(settings, learning, statistics, [*held, *grids], table_dir)
    reliability(settings, grids, len(levels), points, figure_dir)
