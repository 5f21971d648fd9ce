"""Figures 7 and 12, a hand that is loaded or pushed: joints of the upper body and of the base, and errors by method."""

from collections.abc import Sequence
from pathlib import Path

from experiments.evaluation.compare.curves import compared, read_curves, without_zero
from experiments.evaluation.figures.drawing.compared import bars_of, draw_columns, save_compared
from experiments.evaluation.figures.drawing.named_bars import PAPER_LABEL
from experiments.evaluation.measure.estimates.run_errors import error_rows, joint_errors
from experiments.evaluation.number.grid import read_lookup
from experiments.plan.runs import Run
from experiments.settings.figures import HandFigure
from experiments.settings.fleet import Fleet
from experiments.settings.published import PublishedTable
from experiments.settings.runs import Statistics
from mobnet.core.columns import PUSHED
from mobnet.core.joints import JointLayout


def hand_figure(
    settings: HandFigure,
    name: str,
    layout: JointLayout,
    fleet: Fleet,
    statistics: Statistics,
    published: PublishedTable,
    runs: Sequence[Run],
    scores: Sequence[Path],
    figure_dir: Path,
) -> None:
    """Write a figure as PDF, SVG, PNG and CSV: external torque of joints [N m], force on the base [N], and errors.

    The runs are one of each method, all of one recording; the bars are errors over all recordings.
    """
    curves = read_curves(layout, without_zero(runs), settings.joints, {settings.called: PUSHED})
    start, end = (round(time_s * curves.rate_hz) for time_s in (settings.start_s, settings.end_s))
    rows = slice(start, end, settings.every)
    units = [layout.unit(joint) for joint in settings.joints]
    pairs = [
        compared(curves.panel(f"{joint} [{unit}]", joint, rows, band=True), settings.called)
        for joint, unit in zip(settings.joints, units, strict=True)
    ]
    errors = joint_errors(
        read_lookup(scores, statistics), layout, settings, settings.joints, settings.metric, published, settings.place
    )
    drawn = {joint: pair.rmse for joint, pair in zip(settings.joints, pairs, strict=True)}
    bars = [bars_of(errors[joint], drawn[joint]) for joint in settings.joints]
    figure = draw_columns(pairs, bars, units, settings.errors_of, "time [s]", PAPER_LABEL[settings.level == fleet.name])
    written = error_rows(settings, settings.metric, errors, drawn)
    save_compared(figure, figure_dir / name, [pair.torque for pair in pairs], written)
