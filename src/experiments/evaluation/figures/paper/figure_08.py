"""Figure 8: uncertainty torque of the joints of a leg over one gait cycle, what a network predicts, and its errors."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from experiments.evaluation.compare.curves import Compared, compared, read_cycle
from experiments.evaluation.figures.drawing.compared import draw_leg, save_compared
from experiments.evaluation.measure.estimates.run_errors import error_rows, joint_errors
from experiments.evaluation.number.grid import read_lookup
from experiments.evaluation.number.number import Number
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
    lookup = read_lookup(scores, statistics)
    drawn = {joint: pair.rmse for joint, pair in pairs.items()}
    errors = joint_errors(lookup, layout, settings, curves.joints, settings.metric, published, settings.place)
    titled = [entitled(pair, method, errors[joint][method]) for joint, pair in pairs.items()]
    written = error_rows(settings, settings.metric, errors, drawn)
    figure = draw_leg(titled)
    save_compared(figure, figure_dir / "figure_08", [pair.torque for pair in pairs.values()], written)


def entitled(pair: Compared, method: str, error: Number) -> Compared:
    """Return a pair with its errors [N m] in the title: RMSE of the cycle, and over all walks."""
    title = f"{pair.torque.title}: cycle {pair.rmse[method]:.2f}, all {error.text()} N m"
    return replace(pair, torque=replace(pair.torque, title=title))
