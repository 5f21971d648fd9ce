"""Figure 9: external torque of the joints of a leg over one gait cycle, by method."""

from collections.abc import Sequence
from pathlib import Path

from mobnet.core.joints import JointLayout
from mobnet.evaluation.compare.curves import read_cycle
from mobnet.evaluation.figures.drawing.curves import draw_leg, table_of
from mobnet.evaluation.figures.style import save_figure
from mobnet.plan.runs import Run
from mobnet.settings.evaluation import GaitFigure


def figure_09(settings: GaitFigure, start_s: float, layout: JointLayout, runs: Sequence[Run], figure_dir: Path) -> None:
    """Write Figure 9, external torque of a leg over one gait cycle [N m] by method, from runs of one recording."""
    curves, rows = read_cycle(layout, runs, layout.limb(settings.limb), start_s)
    panels = [curves.panel(joint, joint, rows, zero=rows.start) for joint in curves.joints]
    save_figure(draw_leg(panels, "external torque [N m]"), figure_dir / "figure_09", *table_of(panels))
