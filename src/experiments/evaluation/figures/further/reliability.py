"""The reliability diagram: observed minus nominal coverage, as learned and as scaled."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from experiments.evaluation.figures.style import NAME, apart, beside, entitle, looks, save_figure
from experiments.evaluation.measure.learning.calibration import CASE, COVERAGE, case_of
from experiments.evaluation.number.frames import records_of, rows_of
from experiments.settings.measures import CalibrationTable
from experiments.settings.table_columns import RELIABILITY
from mobnet.core.style import styled

HEIGHT_INCH, WIDTHS = 2.4, (1.0, 1.8)  # of the figure; of its panels, the second one with the names
ROOM_Y = 3.0  # above and below all curves [points]
NAMES_FROM, ROOM = 106.0, 85.0  # where names begin, and how far the axis goes on for them [%]
NAMES_APART = 4.5  # least distance between two names [points]
WITHIN: Mapping[str, Any] = {"color": "0.65", "linewidth": 0.7, "zorder": 2}
BAND: Mapping[str, Any] = {"color": "0.92", "linewidth": 0.0, "zorder": 0}
IN_DISTRIBUTION = "in distribution"
DRAWN = ("curve", "case", "name", "method", "nominal", "before", "after")  # columns of curves, beside `limb`


def reliability(settings: CalibrationTable, measures: pd.DataFrame, points: Sequence[float], figure_dir: Path) -> None:
    """Write the reliability diagram as calibration.pdf, .png and .csv; the CSV file has limbs that are not drawn too.

    The measures of tests have columns `TRUSTED`, with the coverage of the nominal points (p,).
    """
    curves = curves_of(measures, settings, points)
    drawn = curves[curves["limb"].isin(settings.drawn)]
    filed = records_of(curves.assign(limb=curves["name"]), RELIABILITY)
    save_figure(draw_reliability(drawn, settings.tolerance), figure_dir / "calibration", RELIABILITY, filed)


def nominal_points(count: int) -> list[float]:
    """Return nominal shares evenly spread inside 0 and 1 (count,)."""
    return np.linspace(0.0, 1.0, count + 2)[1:-1].tolist()


def curves_of(measures: pd.DataFrame, settings: CalibrationTable, points: Sequence[float]) -> pd.DataFrame:
    """Return the curves of all methods, limbs and tests: those without collisions, then those of each collision.

    Returns:
        A row for each nominal point of each curve, which `curve` numbers: `case`, `method`, `limb` and the `name` that
        it has in the figure, and the shares [-] `nominal`, and observed with sigma as learned, `before`, and scaled,
        `after`. The base has a name for each of its two units.
    """
    coverage = rows_of(measures, metric=COVERAGE)
    coverage = coverage[coverage["share"].isin(points)]
    curves: list[pd.DataFrame] = []
    for keys, runs in coverage.groupby(CASE, sort=False):
        scenario, level, pushed, method, limb, unit = map(str, keys)
        case = settings.names.get(scenario, case_of(scenario, level, pushed)) if pushed else IN_DISTRIBUTION
        name = limb + (f" [{unit}]" if limb == "V" else "")
        curve = runs.pivot_table("value", "share", "stage").rename_axis("nominal").reset_index()
        curve = curve.assign(method=method, limb=limb)
        curves.append(curve.assign(case=case, name=name, rank=settings.methods.index(method), is_pushed=bool(pushed)))
    ranked = sorted(curves, key=lambda curve: (curve["rank"].iloc[0], curve["is_pushed"].iloc[0]))
    numbered = [curve.assign(curve=number) for number, curve in enumerate(ranked)]
    return pd.concat(numbered, ignore_index=True) if numbered else pd.DataFrame(columns=["limb", *DRAWN])


def leaves(curve: pd.DataFrame, tolerance: float) -> bool:
    """Return whether the scaled coverage is somewhere further from the nominal one than a tolerance [-]."""
    return bool((curve["after"] - curve["nominal"]).abs().max() > tolerance)


@styled
def draw_reliability(curves: pd.DataFrame, tolerance: float) -> Figure:
    """Draw observed minus nominal coverage [points] over the nominal one [%]: (a) as learned, (b) scaled.

    Where sigma is true a line lies at zero. Curves that leave the band of the tolerance [-] once they are scaled have
    the colour of their method in both panels, and their names in (b); others are grey.
    """
    colours = {method: look.colour for method, look in looks(curves["method"].unique()).items()}
    each_curve = [curve for _, curve in curves.groupby("curve")]
    outside = [curve for curve in each_curve if leaves(curve, tolerance)]
    figure, axes = beside(2, HEIGHT_INCH, width_ratios=WIDTHS, sharey=True)
    drawn = [0.0]
    titles = ("as learned", "scaled on validation data")
    for k, (axis, title) in enumerate(zip(axes, titles, strict=True)):
        end = 100.0 / (100.0 + ROOM) if k else 1.0
        axis.axhspan(-100.0 * tolerance, 100.0 * tolerance, xmax=end, **BAND)
        axis.axhline(0.0, xmax=end, color="0.5", linewidth=0.6, zorder=1)
        for curve in each_curve:
            observed = curve["after"] if k else curve["before"]
            colour = colours[curve["method"].iloc[0]]
            look = {"color": colour, "linewidth": 1.3, "zorder": 3} if leaves(curve, tolerance) else WITHIN
            points = 100.0 * (observed - curve["nominal"])
            drawn += points.tolist()
            axis.plot(100.0 * curve["nominal"], points, **look)
        axis.set_xlim(0.0, 100.0)
        axis.set_xlabel("nominal coverage [%]", x=end / 2.0)  # below its numbers, not below the names
        entitle(axis, k, title)
    axes[0].set_ylim(min(drawn) - ROOM_Y, max(drawn) + ROOM_Y)
    axes[0].set_ylabel("observed minus nominal\ncoverage [points]")
    _name(axes[1], outside, colours)
    methods = dict.fromkeys(curve["method"].iloc[0] for curve in outside)
    handles: list[Any] = [Line2D([], [], color=colours[method], label=method) for method in methods]
    handles.append(Line2D([], [], label=f"others, within {100.0 * tolerance:g} points", **WITHIN))
    handles.append(Patch(label=f"\N{PLUS-MINUS SIGN}{100.0 * tolerance:g} points", **BAND))
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles), frameon=False, borderpad=0.0)
    return figure


def _name(axis: Axes, curves: Sequence[pd.DataFrame], colours: Mapping[str, str]) -> None:
    """Write the names of curves at their right ends, apart from one another; their colours say the methods."""
    axis.set(xlim=(0.0, 100.0 + ROOM), xticks=(0.0, 20.0, 40.0, 60.0, 80.0, 100.0))
    axis.spines["bottom"].set_bounds(0.0, 100.0)
    last = [curve.iloc[-1] for curve in curves]
    ends = [100.0 * float(point["after"] - point["nominal"]) for point in last]
    for point, end, place in zip(last, ends, apart(ends, NAMES_APART, axis.get_ylim()[1]), strict=True):
        x = 100.0 * float(point["nominal"])
        axis.plot([x, NAMES_FROM], [end, place], color=colours[point["method"]], linewidth=0.4)
        axis.annotate(f"{point['name']}, {point['case']}", (NAMES_FROM, place), (2.0, 0.0), ha="left", **NAME)
