"""Figure 18: one network for each limb against one network for the whole body, errors of the upper body."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from experiments.evaluation.compare.rmse import PUSHED
from experiments.evaluation.figures.style import entitle, legend, looks, save_figure, stacked
from experiments.evaluation.measure.estimates.scores import AVERAGE
from experiments.evaluation.number.grid import Wanted, number_of
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import read_scores
from experiments.settings.figures import Figure18
from experiments.settings.runs import PushWindow, Statistics
from experiments.settings.table_columns import LIMB_ERRORS
from mobnet.core.joints import JointLayout
from mobnet.core.style import styled

UPPER_BODY = "all"  # limbs of the figure together, the mean over their joints
PANEL_INCH, LEGEND_INCH = 1.6, 0.35  # height of a panel and of the legend above all
APART = 1.35  # distance of the first limb from all limbs together [distances of two limbs]
BAR_SHARE = 0.84  # of the distance of two limbs
NUMBER_POINTS, ROOM = 6.0, 1.12  # size of a number above its bar, height of the axis over the highest bar
Errors = dict[tuple[str, str], Number]  # limb or UPPER_BODY, joint or AVERAGE -> error [N m]
HATCHED: Mapping[str, Any] = {"edgecolor": "white", "linewidth": 0.0}


@dataclass(frozen=True)
class LimbPanel:
    """One panel, of n groups of bars: a method has a number [N m] with its interval in each of them."""

    title: str
    groups: Sequence[str]
    bars: Mapping[str, Sequence[Number]]


def figure_18(
    settings: Figure18,
    windows: Mapping[str, PushWindow],
    layout: JointLayout,
    statistics: Statistics,
    scores: Sequence[Path],
    figure_dir: Path,
) -> None:
    """Write Figure 18, mean RMSE [N m] over the joints of the upper body and of its limbs, as PDF, PNG and CSV.

    Of a test with a window around pushes, it is that of the windows.
    """
    read = read_scores(*scores)
    rows = []
    panels = []
    for scenario, title in settings.panels.items():
        errors = {}
        metric = PUSHED if scenario in windows else "rmse"
        for method in settings.methods:
            wanted = wanted_of(settings, layout, scenario, method, metric)
            errors[method] = {place: number_of(read, of, statistics) for place, of in wanted.items()}
        panels.append(panel_of(title, errors))
        for method, found in errors.items():
            rows += [(scenario, method, *place, *error.with_ends, *error.spread) for place, error in found.items()]
    save_figure(draw_limbs(panels, "RMSE [N m]"), figure_dir / "figure_18", LIMB_ERRORS, rows)


def wanted_of(
    settings: Figure18, layout: JointLayout, scenario: str, method: str, metric: str = "rmse"
) -> dict[tuple[str, str], list[Wanted]]:
    """Return limb and joint -> the errors whose mean is shown: of all limbs, then of each limb and its joints."""
    whole: list[Wanted] = []
    by_limb: dict[tuple[str, str], list[Wanted]] = {}
    for limb in settings.limbs:
        own = [Wanted(scenario, limb, settings.level, method, joint, metric) for joint in layout.limb(limb)]
        whole += own  # of all limbs it is the mean over their joints, not that of the limbs' means
        by_limb[limb, AVERAGE] = own
        for wanted in own:
            by_limb[limb, wanted.joint] = [wanted]
    return {(UPPER_BODY, AVERAGE): whole, **by_limb}


def panel_of(title: str, errors: Mapping[str, Errors]) -> LimbPanel:
    """Return a panel: a group for all limbs and for each limb, in each a bar for each method [N m]."""
    groups: dict[str, None] = {}
    bars: dict[str, list[Number]] = {}
    for method, own in errors.items():
        averages = {limb: error for (limb, joint), error in own.items() if joint == AVERAGE}
        groups |= dict.fromkeys(averages)
        bars[method] = list(averages.values())
    return LimbPanel(title, list(groups), bars)


@styled
def draw_limbs(panels: Sequence[LimbPanel], y_label: str) -> Figure:
    """Draw bars [N m] with intervals and numbers, a panel for each test; all limbs together stand apart at the left."""
    figure, axes = stacked([y_label] * len(panels), PANEL_INCH, LEGEND_INCH)
    for k, (axis, panel) in enumerate(zip(axes, panels, strict=True)):
        _draw(axis, panel)
        axis.set_ylabel(y_label)
        entitle(axis, k, panel.title)
    legend(figure, axes)
    return figure


def _draw(axis: Axes, panel: LimbPanel) -> None:
    """Draw the bars [N m] of a panel."""
    places = np.arange(len(panel.groups)) + (np.arange(len(panel.groups)) > 0) * (APART - 1.0)
    width = BAR_SHARE / max(1, len(panel.bars))
    styles = looks(panel.bars)
    for k, (method, numbers) in enumerate(panel.bars.items()):
        x = places + (k - (len(panel.bars) - 1) / 2) * width
        value, low, high = np.array([number.range for number in numbers], dtype=np.float64).reshape(-1, 3).T
        look = {"color": styles[method].colour, "hatch": styles[method].hatch, **HATCHED}
        axis.bar(x, value, 0.92 * width, label=method, **look)
        axis.vlines(x, low, high, color="black", linewidth=0.8)
        for place, number, top in zip(x, numbers, high, strict=True):
            axis.annotate(
                number.text(1),
                (place, top),
                (0.0, 1.5),
                textcoords="offset points",
                ha="center",
                va="bottom",
                fontsize=NUMBER_POINTS,
            )
        # Room for the number above the highest interval of all methods.
        axis.set_ylim(0.0, max(axis.get_ylim()[1], ROOM * float(high.max(initial=0.0))))
    axis.set_xticks(places, panel.groups)
    axis.tick_params(axis="x", length=0.0)
