"""Figure 6: estimates around a step of torque on a swinging hip, and their errors in the windows that are scored."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.compare.curves import compared, without_zero
from experiments.evaluation.compare.rmse import PUSHED
from experiments.evaluation.figures.drawing.compared import bars_of, save_compared
from experiments.evaluation.figures.drawing.pushes import draw_step
from experiments.evaluation.measure.estimates.pushes import read_pushes
from experiments.evaluation.measure.estimates.run_errors import error_rows, joint_errors
from experiments.evaluation.number.grid import read_lookup
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
    errors = joint_errors(read_lookup(scores, statistics), layout, settings, [joint], PUSHED, published, settings.level)
    sizes = pushes[name].torque_nm
    title = f"{f'{sizes[0]:g} N m' if sizes else 'push'} on {joint} in the swing"
    panels = read_pushes(layout, settings, without_zero(runs), title)[:1]
    drawn = compared(panels[0]).rmse if panels else {}
    figure = draw_step(panels, bars_of(errors[joint], drawn), joint, "RMSE around all steps")
    written = error_rows(settings, PUSHED, errors, {joint: drawn})
    save_compared(figure, figure_dir / "figure_06", panels, written)
