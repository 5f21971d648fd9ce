"""Figure 8: uncertainty torque of the joints of a leg over one gait cycle, what a network predicts, and its errors."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from experiments.evaluation.compare.curves import Compared, compared, read_cycle
from experiments.evaluation.figures.drawing.compared import draw_leg, save_compared, with_drawn
from experiments.evaluation.number.frames import read_scores
from experiments.evaluation.number.laws import numbers_by
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.scored import joint_errors
from experiments.plan.runs import Run
from experiments.settings.figures import Figure08
from experiments.settings.published import PublishedTable
from experiments.settings.runs import Statistics
from mobnet.core.joints import JointLayout


def figure_08(
    settings: Figure08,
    start_s: float,
    layout: JointLayout,
    statistics: Statistics,
    published: PublishedTable,
    runs: Sequence[Run],
    scores: Sequence[Path],
    figure_dir: Path,
) -> None:
    """Write Figure 8, uncertainty torque of a leg over one gait cycle [N m]: the target and what a network predicts.

    There is one run. The titles have the RMSE of the cycle and that over all walks and robots.
    """
    (method,) = settings.methods
    curves, rows = read_cycle(layout, runs, layout.limb(settings.limb), start_s)
    pairs = {joint: compared(curves.uncertainty_panel(joint, joint, rows, zero=rows.start)) for joint in curves.joints}
    joints, metric = curves.joints, settings.metric
    read = read_scores(*scores)
    errors = joint_errors(read, layout, settings, joints, metric, statistics, published, settings.place)
    numbers = numbers_by(errors, "joint")
    figure = draw_leg([entitled(pair, method, numbers[joint]) for joint, pair in pairs.items()])
    written = with_drawn(errors, {joint: pair.rmse for joint, pair in pairs.items()})
    save_compared(figure, figure_dir / "figure_08", [pair.torque for pair in pairs.values()], written)


def entitled(pair: Compared, method: str, error: Number) -> Compared:
    """Return a pair with its errors [N m] in the title: RMSE of the cycle, and over all walks."""
    title = f"{pair.torque.title}\ncycle {pair.rmse[method]:.2f}, all {error.text()} N m"
    return replace(pair, torque=replace(pair.torque, title=title))
