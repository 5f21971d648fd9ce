"""Figure 8: uncertainty torque of the joints of a leg over one gait cycle, and what a network predicts of it."""

from collections.abc import Sequence
from pathlib import Path

from mobnet.core.joints import JointLayout
from mobnet.evaluation.compare.curves import read_cycle
from mobnet.evaluation.compare.rmse import rmse
from mobnet.evaluation.figures.drawing.curves import draw_leg, table_of
from mobnet.evaluation.figures.style import save_figure
from mobnet.plan.runs import Run
from mobnet.settings.evaluation import GaitFigure


def figure_08(settings: GaitFigure, start_s: float, layout: JointLayout, runs: Sequence[Run], figure_dir: Path) -> None:
    """Write Figure 8, uncertainty torque of a leg over one gait cycle [N m]: the target and what a network predicts.

    There is one run; the error in a panel's title is that over the whole recording, as in the paper.
    """
    curves, rows = read_cycle(layout, runs, layout.limb(settings.limb), start_s)
    (estimate,) = curves.estimates.values()
    errors = rmse(estimate, curves.truth, curves.spans).tolist()
    panels = [
        curves.uncertainty_panel(f"{joint}, RMSE {error:.2f} N m", joint, rows, zero=rows.start)
        for joint, error in zip(curves.joints, errors, strict=True)
    ]
    save_figure(draw_leg(panels, "uncertainty torque [N m]"), figure_dir / "figure_08", *table_of(panels))
