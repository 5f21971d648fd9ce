"""The reliability diagram: observed minus nominal coverage, as learned and as scaled."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from experiments.evaluation.figures.style import NAME, apart, beside, entitle, looks, save_figure
from experiments.evaluation.measure.learning.calibration import CoverageGrid
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


@dataclass(frozen=True)
class CoverageCurve:
    """Coverage of a limb in a case over nominal shares (p,): observed with sigma as learned (p,) and scaled (p,).

    `name` is what the figure calls the limb: that of the base comes with the unit, as it has two.
    """

    case: str
    method: str
    limb: str
    name: str
    nominal: NDArray[Any]
    before: NDArray[Any]
    after: NDArray[Any]

    @property
    def text(self) -> str:
        """What the figure calls it, whose colour says the method."""
        return f"{self.name}, {self.case}"

    def leaves(self, tolerance: float) -> bool:
        """Return whether the scaled coverage is somewhere further from the nominal one than a tolerance [-]."""
        return bool(np.abs(self.after - self.nominal).max() > tolerance)


def reliability(
    settings: CalibrationTable, grids: Sequence[CoverageGrid], skipped: int, points: Sequence[float], figure_dir: Path
) -> None:
    """Write the reliability diagram as calibration.pdf, .png and .csv; the CSV file has limbs that are not drawn too.

    In the grids, the coverage of the nominal points (p,) follows that of the table's levels, `skipped` in number.
    """
    curves = curves_of(grids, settings, skipped, points)
    drawn = [curve for curve in curves if curve.limb in settings.drawn]
    save_figure(
        draw_reliability(drawn, settings.tolerance), figure_dir / "calibration", RELIABILITY, curve_rows(curves)
    )


def nominal_points(count: int) -> list[float]:
    """Return nominal shares evenly spread inside 0 and 1 (count,)."""
    return np.linspace(0.0, 1.0, count + 2)[1:-1].tolist()


def curves_of(
    grids: Sequence[CoverageGrid], settings: CalibrationTable, skipped: int, points: Sequence[float]
) -> list[CoverageCurve]:
    """Return the curves of all methods, limbs and tests: those without collisions, then those of each collision."""
    ordered = sorted(grids, key=lambda grid: (settings.methods.index(grid.method), bool(grid.pushed)))
    curves = []
    for grid in ordered:
        case = settings.names.get(grid.test, grid.case) if grid.pushed else IN_DISTRIBUTION
        name = grid.limb + (f" [{grid.unit}]" if grid.limb == "V" else "")
        observed = grid.values[..., skipped:-2].mean(axis=(0, 1))
        curves.append(CoverageCurve(case, grid.method, grid.limb, name, np.array(points), *observed))
    return curves


@styled
def draw_reliability(curves: Sequence[CoverageCurve], tolerance: float) -> Figure:
    """Draw observed minus nominal coverage [points] over the nominal one [%]: (a) as learned, (b) scaled.

    Where sigma is true a line lies at zero. Curves that leave the band of the tolerance [-] once they are scaled have
    the colour of their method in both panels, and their names in (b); others are grey.
    """
    colours = {method: look.colour for method, look in looks(curve.method for curve in curves).items()}
    figure, axes = beside(2, HEIGHT_INCH, width_ratios=WIDTHS, sharey=True)
    drawn = [0.0]
    titles = ("as learned", "scaled on validation data")
    for k, (axis, title) in enumerate(zip(axes, titles, strict=True)):
        end = 100.0 / (100.0 + ROOM) if k else 1.0
        axis.axhspan(-100.0 * tolerance, 100.0 * tolerance, xmax=end, **BAND)
        axis.axhline(0.0, xmax=end, color="0.5", linewidth=0.6, zorder=1)
        for curve in curves:
            is_outside = curve.leaves(tolerance)
            observed = curve.after if k else curve.before
            look = {"color": colours[curve.method], "linewidth": 1.3, "zorder": 3} if is_outside else WITHIN
            points = 100.0 * (observed - curve.nominal)
            drawn += points.tolist()
            axis.plot(100.0 * curve.nominal, points, **look)
        axis.set_xlim(0.0, 100.0)
        axis.set_xlabel("nominal coverage [%]", x=end / 2.0)  # below its numbers, not below the names
        entitle(axis, k, title)
    axes[0].set_ylim(min(drawn) - ROOM_Y, max(drawn) + ROOM_Y)
    axes[0].set_ylabel("observed minus nominal\ncoverage [points]")
    outside = [curve for curve in curves if curve.leaves(tolerance)]
    _name(axes[1], outside, colours)
    methods = dict.fromkeys(curve.method for curve in outside)
    handles: list[Any] = [Line2D([], [], color=colours[method], label=method) for method in methods]
    handles.append(Line2D([], [], label=f"others, within {100.0 * tolerance:g} points", **WITHIN))
    handles.append(Patch(label=f"\N{PLUS-MINUS SIGN}{100.0 * tolerance:g} points", **BAND))
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles), frameon=False, borderpad=0.0)
    return figure


def _name(axis: Axes, curves: Sequence[CoverageCurve], colours: Mapping[str, str]) -> None:
    """Write the names of curves at their right ends, apart from one another."""
    axis.set(xlim=(0.0, 100.0 + ROOM), xticks=(0.0, 20.0, 40.0, 60.0, 80.0, 100.0))
    axis.spines["bottom"].set_bounds(0.0, 100.0)
    ends = [100.0 * float(curve.after[-1] - curve.nominal[-1]) for curve in curves]
    for curve, end, place in zip(curves, ends, apart(ends, NAMES_APART, axis.get_ylim()[1]), strict=True):
        x = 100.0 * float(curve.nominal[-1])
        axis.plot([x, NAMES_FROM], [end, place], color=colours[curve.method], linewidth=0.4)
        axis.annotate(curve.text, (NAMES_FROM, place), (2.0, 0.0), ha="left", **NAME)


def curve_rows(curves: Sequence[CoverageCurve]) -> Iterator[tuple[str, str, str, float, float, float]]:
    """Yield the plotted numbers: case, method, limb, nominal share, observed as learned and scaled."""
    for curve in curves:
        columns = (column.tolist() for column in (curve.nominal, curve.before, curve.after))
        yield from ((curve.case, curve.method, curve.name, *row) for row in zip(*columns, strict=True))
