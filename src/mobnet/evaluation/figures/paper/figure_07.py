"""Figure 7: upper body and base while a load hangs on a hand."""

from collections.abc import Sequence
from pathlib import Path

from mobnet.core.joints import JointLayout
from mobnet.evaluation.figures.drawing.hand import draw_hand
from mobnet.plan.runs import Run
from mobnet.settings.evaluation import HandFigure


def figure_07(settings: HandFigure, layout: JointLayout, runs: Sequence[Run], figure_dir: Path) -> None:
    """Write Figure 7 of the runs of each method on one recording."""
    draw_hand(settings, layout, runs, figure_dir / "figure_07")
