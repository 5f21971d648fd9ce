"""Figure 18: one network for each limb against one network for the whole body, errors of the upper body."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from experiments.evaluation.compare.rmse import PUSHED
from experiments.evaluation.figures.style import entitle, legend, looks, save_figure, stacked
from experiments.evaluation.measure.estimates.run_errors import ERROR
from experiments.evaluation.number.frames import ordered, read_scores, records_of, rows_of
from experiments.evaluation.number.laws import measured
from experiments.evaluation.number.number import number_text
from experiments.evaluation.number.scored import AVERAGE, number_of, runs_of
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
HATCHED: Mapping[str, Any] = {"edgecolor": "white", "linewidth": 0.0}


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
    asked = asked_of(settings, windows, layout)
    runs = ordered(runs_of(read_scores(*scores), asked), scenario=list(settings.panels), method=settings.methods)
    place = ["scenario", "method", "shown"]
    numbers = measured(runs, place, {"rmse_nm": lambda same: number_of(same, statistics)})
    places = asked[["shown", "shown_limb", "shown_joint"]].drop_duplicates("shown")
    rows = numbers.merge(places, how="left", on="shown")
    rows = rows.rename(columns={"shown_limb": "limb", "shown_joint": "joint"})
    figure = draw_limbs(rows, settings.panels, "RMSE [N m]")
    records = records_of(rows.rename(columns={"value": "rmse_nm"}), LIMB_ERRORS)
    save_figure(figure, figure_dir / "figure_18", LIMB_ERRORS, records)


def asked_of(settings: Figure18, windows: Mapping[str, PushWindow], layout: JointLayout) -> pd.DataFrame:
    """Return the errors whose mean is shown: of all limbs, then of each limb and its joints, columns CELL.

    `shown` numbers what is shown of a method in a test, and `shown_limb` and `shown_joint` say what it is of.
    """
    by_limb = {limb: layout.limb(limb) for limb in settings.limbs}
    # Of all limbs it is the mean over their joints, not that of the limbs' means.
    every = [(limb, joint) for limb, joints in by_limb.items() for joint in joints]
    shown = [(UPPER_BODY, AVERAGE, every)]
    for limb, joints in by_limb.items():
        shown.append((limb, AVERAGE, [(limb, joint) for joint in joints]))
        shown += [(limb, joint, [(limb, joint)]) for joint in joints]
    asked: list[tuple[int | str, ...]] = []
    for scenario in settings.panels:
        metric = PUSHED if scenario in windows else ERROR
        for method in settings.methods:
            for k, (limb, joint, places) in enumerate(shown):
                asked += [(k, limb, joint, scenario, *place, settings.level, method, metric) for place in places]
    columns = ["shown", "shown_limb", "shown_joint", "scenario", "limb", "joint", "level", "method", "metric"]
    return pd.DataFrame(asked, columns=columns)


@styled
def draw_limbs(rows: pd.DataFrame, titles: Mapping[str, str], y_label: str) -> Figure:
    """Draw bars [N m] with intervals and numbers, a panel for each test; all limbs together stand apart at the left.

    Rows have `scenario`, `method`, `limb`, `joint` and the number; those of single joints are not drawn. A scenario
    leads to its title.
    """
    figure, axes = stacked([y_label] * len(titles), PANEL_INCH, LEGEND_INCH)
    averages = rows_of(rows, joint=AVERAGE)
    for k, (axis, (scenario, title)) in enumerate(zip(axes, titles.items(), strict=True)):
        _draw(axis, rows_of(averages, scenario=scenario))
        axis.set_ylabel(y_label)
        entitle(axis, k, title)
    legend(figure, axes)
    return figure


def _draw(axis: Axes, rows: pd.DataFrame) -> None:
    """Draw the bars [N m] of a panel."""
    limbs = list(rows["limb"].unique())
    methods = list(rows["method"].unique())
    places = np.arange(len(limbs)) + (np.arange(len(limbs)) > 0) * (APART - 1.0)
    width = BAR_SHARE / max(1, len(methods))
    styles = looks(methods)
    for k, method in enumerate(methods):
        bars = rows_of(rows, method=method)
        x = places + (k - (len(methods) - 1) / 2) * width
        value = bars["value"].to_numpy()
        low = bars["low"].fillna(bars["value"]).to_numpy()
        high = bars["high"].fillna(bars["value"]).to_numpy()
        look = {"color": styles[method].colour, "hatch": styles[method].hatch, **HATCHED}
        axis.bar(x, value, 0.92 * width, label=method, **look)
        axis.vlines(x, low, high, color="black", linewidth=0.8)
        for place, number, top in zip(x, value, high, strict=True):
            axis.annotate(
                number_text(number, 1),
                (place, top),
                (0.0, 1.5),
                textcoords="offset points",
                ha="center",
                va="bottom",
                fontsize=NUMBER_POINTS,
            )
        # Room for the number above the highest interval of all methods.
        axis.set_ylim(0.0, max(axis.get_ylim()[1], ROOM * float(high.max(initial=0.0))))
    axis.set_xticks(places, limbs)
    axis.tick_params(axis="x", length=0.0)
