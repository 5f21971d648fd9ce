"""Figure 10: pushes on the knee of a leg in the air and on the ground, and the error of each."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from mobnet.core.joints import JointLayout
from mobnet.evaluation.figures.drawing.pushes import PushGroup, save_pushes
from mobnet.evaluation.measure.estimates.pushes import collision_errors, read_pushes
from mobnet.evaluation.number.rows import read_scores
from mobnet.plan.runs import Run
from mobnet.settings.evaluation import Figure10, Statistics
from mobnet.settings.published import PublishedTable

ROBOT = "paper (robot)"  # name of numbers that the paper measured on its robot


def figure_10(
    settings: Figure10, published: PublishedTable, layout: JointLayout, statistics: Statistics,
    runs: Mapping[str, Sequence[Run]], scores: Sequence[Path], figure_dir: Path,
) -> None:  # fmt: skip
    """Write Figure 10, pushes on the knee of a leg in the air and on the ground [N m]: curves and errors of each.

    The title of a test leads to its runs, one of each method and all of one recording.
    """
    rows, groups = read_scores(*scores), list[PushGroup]()
    for title, test in settings.tests.items():
        errors = collision_errors(layout, settings, test, published, rows, statistics)
        panels = read_pushes(layout, settings, runs[title], f"{title} {{}}")
        groups.append(PushGroup(test.scenario, panels, errors, f"{title}: error by push", ROBOT))
    save_pushes(groups, settings.joint, figure_dir / "figure_10")
