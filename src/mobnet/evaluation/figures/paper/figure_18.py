"""Figure 18: one network for each limb against one network for the whole body, errors of the upper body."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from mobnet.core.columns import LIMB_ERRORS
from mobnet.core.joints import JointLayout
from mobnet.evaluation.compare.rmse import PUSHED
from mobnet.evaluation.figures.drawing.bars import BarPanel, draw_bars
from mobnet.evaluation.figures.style import save_figure
from mobnet.evaluation.measure.estimates.scores import AVERAGE
from mobnet.evaluation.number.grid import Wanted, number_of
from mobnet.evaluation.number.number import Number
from mobnet.evaluation.number.rows import read_scores
from mobnet.settings.evaluation import Figure18, PushWindow, Statistics

UPPER_BODY = "upper body"  # all limbs of the figure together

Errors = dict[tuple[str, str], Number]  # limb or UPPER_BODY, joint or AVERAGE -> error [N m]


def figure_18(
    settings: Figure18, windows: Mapping[str, PushWindow], layout: JointLayout, statistics: Statistics,
    scores: Sequence[Path], figure_dir: Path,
) -> None:  # fmt: skip
    """Write Figure 18, mean RMSE [N m] over the joints of the upper body and of its limbs, as PDF, PNG and CSV.

    Of a test with a window around pushes, it is that of the windows.
    """
    read, rows, panels = read_scores(*scores), [], []
    for scenario, title in settings.panels.items():
        errors = {}
        metric = PUSHED if scenario in windows else "rmse"
        for method in settings.methods:
            wanted = wanted_of(settings, layout, scenario, method, metric)
            errors[method] = {place: number_of(read, of, statistics) for place, of in wanted.items()}
        panels.append(panel_of(title, errors))
        rows += [
            (scenario, method, *place, *error.with_ends, *error.spread)
            for method, found in errors.items() for place, error in found.items()
        ]  # fmt: skip
    save_figure(draw_bars(panels, "RMSE [N m]"), figure_dir / "figure_18", LIMB_ERRORS, rows)


def wanted_of(
    settings: Figure18, layout: JointLayout, scenario: str, method: str, metric: str = "rmse"
) -> dict[tuple[str, str], list[Wanted]]:
    """Return limb and joint -> the errors whose mean is shown: of the upper body, then of each limb and its joints."""
    limbs = {
        limb: [Wanted(scenario, limb, settings.level, method, joint, metric) for joint in layout.limb(limb)]
        for limb in settings.limbs
    }
    found = {(UPPER_BODY, AVERAGE): [wanted for own in limbs.values() for wanted in own]}
    for limb, own in limbs.items():
        found |= {(limb, AVERAGE): own, **{(limb, wanted.joint): [wanted] for wanted in own}}
    return found


def panel_of(title: str, errors: Mapping[str, Errors]) -> BarPanel:
    """Return a panel: a group for the upper body and for each limb, in each a bar for each method [N m]."""
    bars = {
        method: {limb: error for (limb, joint), error in own.items() if joint == AVERAGE}
        for method, own in errors.items()
    }
    groups = dict.fromkeys(limb for own in bars.values() for limb in own)
    return BarPanel(title, list(groups), {method: list(own.values()) for method, own in bars.items()})
