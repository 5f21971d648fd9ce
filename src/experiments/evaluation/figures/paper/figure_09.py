"""Figure 9: external torque of the joints of a leg over one gait cycle, by method, and errors."""

from collections.abc import Sequence
from pathlib import Path

from experiments.evaluation.compare.curves import compared, read_cycle, without_zero
from experiments.evaluation.figures.drawing.compared import bars_by_joint, draw_columns, save_compared, with_drawn
from experiments.evaluation.figures.drawing.curves import FROM_LIFT_OFF
from experiments.evaluation.figures.drawing.named_bars import PAPER_LABEL
from experiments.evaluation.number.frames import read_scores
from experiments.evaluation.number.scored import joint_errors
from experiments.plan.runs import Run
from experiments.settings.figures import Figure09
from experiments.settings.published import PublishedTable
from experiments.settings.runs import Statistics
from mobnet.core.joints import JointLayout


def figure_09(
    settings: Figure09,
    start_s: float,
    layout: JointLayout,
    statistics: Statistics,
    published: PublishedTable,
    runs: Sequence[Run],
    scores: Sequence[Path],
    figure_dir: Path,
) -> None:
    """Write Figure 9, external torque of a leg over one gait cycle [N m] by method, from runs of one recording.

    Some joints are drawn, the CSV has all; the bars are errors over all walks and robots.
    """
    curves, rows = read_cycle(layout, without_zero(runs), layout.limb(settings.limb), start_s)
    pairs = {joint: compared(curves.panel(joint, joint, rows, zero=rows.start)) for joint in curves.joints}
    joints, metric = curves.joints, settings.metric
    read = read_scores(*scores)
    errors = joint_errors(read, layout, settings, joints, metric, statistics, published, settings.place)
    drawn = {joint: pair.rmse for joint, pair in pairs.items()}
    bars = bars_by_joint(errors, drawn)
    figure = draw_columns(
        [pairs[joint] for joint in settings.drawn],
        [bars[joint] for joint in settings.drawn],
        [layout.unit(joint) for joint in settings.drawn],
        settings.errors_of,
        FROM_LIFT_OFF,
        PAPER_LABEL[published.robot],
    )
    panels = [pair.torque for pair in pairs.values()]
    save_compared(figure, figure_dir / "figure_09", panels, with_drawn(errors, drawn))
