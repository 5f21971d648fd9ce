"""Figure 5: one gait cycle of one joint, by uncertainty level and method."""

from collections.abc import Sequence
from pathlib import Path

from mobnet.core.joints import JointLayout
from mobnet.evaluation.compare.curves import Panel, read_cycle
from mobnet.evaluation.figures.drawing.curves import FROM_LIFT_OFF, draw_panels, table_of
from mobnet.evaluation.figures.style import save_figure
from mobnet.plan.runs import Run
from mobnet.settings.evaluation import Figure05


def figure_05(settings: Figure05, start_s: float, layout: JointLayout, runs: Sequence[Run], figure_dir: Path) -> None:
    """Write Figure 5, one gait cycle of one joint [N m], a panel for each run, as PDF, SVG, PNG and CSV."""
    panels = [read_panel(layout, run, settings.joint, start_s) for run in runs]
    figure = draw_panels(panels, FROM_LIFT_OFF, f"external torque of {settings.joint} [N m]", one_scale=True)
    save_figure(figure, figure_dir / "figure_05", *table_of(panels))


def read_panel(layout: JointLayout, run: Run, joint: str, start_s: float) -> Panel:
    """Return one panel [N m] of Figure 5: the first whole gait cycle after the start [s]."""
    curves, rows = read_cycle(layout, [run], [joint], start_s)
    return curves.panel(f"{run.method}, {run.level.replace('_', ' ')}", joint, rows, zero=rows.start)
