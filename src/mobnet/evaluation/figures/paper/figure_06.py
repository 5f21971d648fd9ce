"""Figure 6: estimates around a step of torque on a swinging hip, and their errors in the windows that are scored."""

from collections.abc import Sequence
from pathlib import Path

from mobnet.core.joints import JointLayout
from mobnet.evaluation.compare.rmse import PUSHED
from mobnet.evaluation.figures.drawing.pushes import PushGroup, save_pushes
from mobnet.evaluation.measure.estimates.pushes import ALL, PushErrors, read_pushes, wanted_of
from mobnet.evaluation.number.grid import number_of
from mobnet.evaluation.number.number import published_value
from mobnet.evaluation.number.rows import read_scores
from mobnet.plan.runs import Run
from mobnet.settings.evaluation import Figure06, Statistics
from mobnet.settings.published import PublishedTable


def figure_06(
    settings: Figure06, published: PublishedTable, layout: JointLayout, statistics: Statistics,
    runs: Sequence[Run], scores: Sequence[Path], figure_dir: Path,
) -> None:  # fmt: skip
    """Write Figure 6, a step of torque on a swinging hip [N m]: curves around the first, errors in all windows.

    The runs are one of each method, all of one recording.
    """
    joint, rows = settings.joint, read_scores(*scores)
    errors: PushErrors = {}
    for method in settings.methods:
        wanted = wanted_of(layout, settings, method, joint, PUSHED)
        printed = published_value(published, settings.level, method, joint)
        errors[method] = {ALL: number_of(rows, [wanted], statistics, published=printed)}
    panels = read_pushes(layout, settings, runs, f"step {{}} on {joint}")[:1]
    group = PushGroup(settings.scenario, panels, errors, "error around the steps")
    save_pushes([group], joint, figure_dir / "figure_06")
