"""Figure 6: estimates around a step of torque on a swinging hip, and their errors in the windows that are scored."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.compare.curves import compared, without_zero
from experiments.evaluation.compare.rmse import PUSHED
from experiments.evaluation.figures.drawing.compared import bars_of, save_compared, with_drawn
from experiments.evaluation.figures.drawing.pushes import draw_step
from experiments.evaluation.measure.estimates.pushes import read_pushes
from experiments.evaluation.number.frames import read_scores
from experiments.evaluation.number.laws import numbers_by
from experiments.evaluation.number.scored import joint_errors
from experiments.plan.runs import Run
from experiments.settings.figures import Figure06
from experiments.settings.published import PublishedTable
from experiments.settings.runs import Statistics
from mobnet.core.joints import JointLayout
from mobnet.settings.data import Push, Scenario


def figure_06(
    settings: Figure06,
    published: PublishedTable,
    layout: JointLayout,
    statistics: Statistics,
    runs: Sequence[Run],
    scenarios: Mapping[str, Scenario],
    pushes: Mapping[str, Push],
    scores: Sequence[Path],
    figure_dir: Path,
) -> None:
    """Write Figure 6, a step of torque on a swinging hip [N m]: curves around the first, errors around all.

    The runs are one of each method, all of one recording.
    """
    joint = settings.joint
    (name,) = scenarios[settings.scenario].pushes
    read = read_scores(*scores)
    errors = joint_errors(read, layout, settings, [joint], PUSHED, statistics, published, settings.level)
    sizes = pushes[name].torque_nm
    title = f"{f'{sizes[0]:g} N m' if sizes else 'push'} on {joint} in the swing"
    panels = read_pushes(layout, settings, without_zero(runs), title)[:1]
    drawn = compared(panels[0]).rmse if panels else {}
    bars = bars_of(numbers_by(errors, "method"), drawn)
    figure = draw_step(panels, bars, joint, "RMSE around all steps")
    save_compared(figure, figure_dir / "figure_06", panels, with_drawn(errors, {joint: drawn}))
