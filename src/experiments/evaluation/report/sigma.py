"""Table and figure of the standard deviations in parts of a walk: both are made from the same scores."""

from collections.abc import Sequence
from pathlib import Path

from experiments.evaluation.figures.further.sigma_courses import sigma_figure
from experiments.evaluation.number.frames import read_scores
from experiments.evaluation.tables.further.sigma_table import sigma_table
from experiments.settings.measures import Sigma
from experiments.settings.runs import Statistics
from mobnet.core.joints import JointLayout
from mobnet.settings.networks import Learning


def sigma(
    settings: Sigma,
    learning: Learning,
    layout: JointLayout,
    statistics: Statistics,
    scores: Sequence[Path],
    table_dir: Path,
    figure_dir: Path,
) -> None:
    """Write sigma.csv, .tex and .md, and sigma.pdf, .png and .csv."""
    read = read_scores(*scores)
    share = learning.calibration_share
    sigma_table(settings, layout, read, statistics, share, table_dir)
    sigma_figure(settings, read, statistics, share, figure_dir)
