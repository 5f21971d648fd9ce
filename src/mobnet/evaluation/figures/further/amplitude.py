"""What random torque exploration is good for: error over the largest random torque of the training data."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from mobnet.core.columns import AMPLITUDES
from mobnet.core.joints import JointLayout
from mobnet.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from mobnet.evaluation.figures.style import save_figure
from mobnet.evaluation.measure.data.random_torque import torque_left
from mobnet.evaluation.number.grid import Wanted, number_of
from mobnet.evaluation.number.number import Number
from mobnet.evaluation.number.rows import read_scores
from mobnet.settings.evaluation import Amplitude, AmplitudeTest, Statistics

LABEL, X_LABEL = "MOB-Net", "largest random torque in the training data [N m]"
MS = 1e3


def amplitude(
    settings: Amplitude, layout: JointLayout, statistics: Statistics, scores: Sequence[Path],
    amplitudes: Mapping[str, float], training: Mapping[str, Sequence[Path]], figure_dir: Path,
) -> None:  # fmt: skip
    """Write the figure as PDF, PNG and CSV: RMSE [N m] of tests over the largest random torque [N m] of the training.

    The last panel has the share [-] of a random torque that is left in the desired torque some time after its step,
    the mean over a leg's joints; `amplitudes` and `training` are those of each method.
    """
    read, panels, rows = read_scores(*scores), [], []
    for title, test in settings.tests.items():
        methods = sorted(test.methods, key=lambda name: amplitudes[name])
        errors = [number_of(read, [wanted_of(test, name)], statistics) for name in methods]
        panels.append(panel_of(title, "RMSE [N m]", [amplitudes[name] for name in methods], errors))
        of = test.scenario, test.level
        rows += [
            (title, amplitudes[name], *of, name, test.joint, test.metric, *error.with_ends, *error.spread, error.unit)
            for name, error in zip(methods, errors, strict=True)
        ]
    limb = next(iter(settings.tests.values())).limb
    left = {
        name: share_left(training[name], layout, limb, settings.lag_s)
        for name in sorted(training, key=lambda name: amplitudes[name])
        if amplitudes[name]
    }
    title = f"random torque left after {settings.lag_s * MS:g} ms"
    panels.append(panel_of(title, "share [-]", [amplitudes[name] for name in left], list(left.values())))
    rows += [
        (title, amplitudes[name], "", "", name, limb, "share", *share.with_ends, *share.spread, "-")
        for name, share in left.items()
    ]
    save_figure(draw_lines(panels), figure_dir / "amplitude", AMPLITUDES, rows)


def wanted_of(test: AmplitudeTest, method: str) -> Wanted:
    """Return what is looked at of a method."""
    return Wanted(test.scenario, test.limb, test.level, method, test.joint, test.metric)


def panel_of(title: str, label: str, amplitudes: Sequence[float], numbers: Sequence[Number]) -> LinePanel:
    """Return a panel of one line over the amplitude [N m]."""
    return LinePanel(title, X_LABEL, label, [Line(LABEL, amplitudes, numbers)], sizes=True)


def share_left(stems: Sequence[Path], layout: JointLayout, limb: str, lag_s: float) -> Number:
    """Return the share [-] of a limb's random torque that is left after a lag [s] in some recordings."""
    found = torque_left(stems, layout, [limb], [lag_s])
    return Number(next((share for _, part, share, _ in found if part == f"limb {limb}"), None))
