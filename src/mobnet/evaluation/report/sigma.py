"""Table and figure of the standard deviations in parts of a walk: both are made from the same scores."""

from collections.abc import Sequence
from pathlib import Path

from mobnet.core.joints import JointLayout
from mobnet.evaluation.figures.further.sigma_courses import sigma_figure
from mobnet.evaluation.number.lookup import read_lookup
from mobnet.evaluation.tables.further.sigma_table import sigma_table
from mobnet.settings.measures import Sigma
from mobnet.settings.networks import Learning
from mobnet.settings.runs import Statistics


def sigma(
    settings: Sigma, learning: Learning, layout: JointLayout, statistics: Statistics,
    scores: Sequence[Path], table_dir: Path, figure_dir: Path,
) -> None:  # fmt: skip
    """Write sigma.csv, .tex and .md, and sigma.pdf, .png and .csv."""
    lookup, share = read_lookup(scores, statistics), learning.calibration_share
    sigma_table(settings, layout, lookup, share, table_dir)
    sigma_figure(settings, lookup, share, figure_dir)
