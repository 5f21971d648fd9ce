"""Figures 7 and 12, a hand that is loaded or pushed: curves of joints of the upper body and of the base."""

from collections.abc import Sequence
from pathlib import Path

from mobnet.core.columns import PUSHED
from mobnet.core.joints import JointLayout
from mobnet.evaluation.compare.curves import read_curves
from mobnet.evaluation.figures.drawing.curves import draw_panels, table_of
from mobnet.evaluation.figures.style import save_figure
from mobnet.plan.runs import Run
from mobnet.settings.evaluation import HandFigure

SIDE_BY_SIDE = 2


def hand_figure(settings: HandFigure, name: str, layout: JointLayout, runs: Sequence[Run], figure_dir: Path) -> None:
    """Write a figure as PDF, SVG, PNG and CSV: external torque of joints [N m], force on the base [N].

    The runs are one of each method, all of one recording.
    """
    curves = read_curves(layout, runs, settings.joints, {"push": PUSHED})
    start, end = (round(time_s * curves.rate_hz) for time_s in (settings.start_s, settings.end_s))
    rows = slice(start, end, settings.every)
    panels = [curves.panel(f"{joint} [{layout.unit(joint)}]", joint, rows, band=True) for joint in settings.joints]
    figure = draw_panels(panels, "time [s]", "external torque or force", SIDE_BY_SIDE)
    save_figure(figure, figure_dir / name, *table_of(panels))
