"""The reliability diagram: observed less nominal coverage, by parts of the body."""

from collections import Counter
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

from experiments.evaluation.figures.style import LETTERS, PALETTE, save_figure
from experiments.evaluation.measure.learning.calibration import CoverageGrid
from experiments.settings.measures import CalibrationTable
from mobnet.core.columns import RELIABILITY
from mobnet.core.style import PAGE_INCH, STYLE, styled

ACROSS, PANEL_INCH, LABELS_INCH = 3, 1.6, 0.3  # panels in a row, height of a row and of the label below all
MOST = 33.0  # end of the axis [points]
TICKS = (-30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0)
WIDTHS = (1.5, 0.7)  # of the lines of the first limb in a panel and of the second [points]
LEARNED_ALPHA = 0.35  # of the lines before the scaling
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


@dataclass(frozen=True)
class ReliabilityPanel:
    """One panel, with a curve for each limb and case."""

    title: str
    curves: Sequence[CoverageCurve]


def reliability(
    settings: CalibrationTable, grids: Sequence[CoverageGrid], skipped: int, points: Sequence[float], figure_dir: Path
) -> None:
    """Write the reliability diagram as calibration.pdf, .png and .csv; the CSV file has limbs of no panel too.

    In the grids, the coverage of the nominal points (p,) follows that of the table's levels, `skipped` in number.
    """
    curves = curves_of(grids, settings, skipped, points)
    figure = draw_reliability(panels_of(curves, settings), settings.tolerance)
    save_figure(figure, figure_dir / "calibration", RELIABILITY, curve_rows(curves))


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


def panels_of(curves: Sequence[CoverageCurve], settings: CalibrationTable) -> list[ReliabilityPanel]:
    """Return a panel for each part of the body and method."""
    panels = []
    for part, limbs in settings.parts.items():
        own = [curve for curve in curves if curve.limb in limbs]
        for method in dict.fromkeys(curve.method for curve in own):
            shown = [curve for curve in own if curve.method == method]
            names = ", ".join(dict.fromkeys(curve.name for curve in shown))
            panels.append(ReliabilityPanel(f"{part} ({names}), {method}", shown))
    return panels


@styled
def draw_reliability(panels: Sequence[ReliabilityPanel], tolerance: float) -> Figure:
    """Draw observed less nominal coverage [points] over the nominal one [%]; pale lines as learned, full ones scaled.

    A case has one colour in every panel. Where sigma is true a line lies at zero, within the tolerance [-] in the band.
    The legend stands in the place after the last panel.
    """
    cases = dict.fromkeys(curve.case for panel in panels for curve in panel.curves)
    colours = {case: look.colour for case, look in zip(cases, PALETTE, strict=False)}
    rows = -(-(len(panels) + 1) // ACROSS)
    figure = Figure(figsize=(PAGE_INCH, PANEL_INCH * rows + LABELS_INCH), layout="constrained")
    axes: list[Axes] = figure.subplots(rows, ACROSS, squeeze=False, sharex=True, sharey=True).ravel().tolist()
    for k, (axis, panel) in enumerate(zip(axes, panels, strict=False)):
        axis.axhspan(-100.0 * tolerance, 100.0 * tolerance, **BAND)
        axis.axhline(0.0, color="0.5", linewidth=0.6, zorder=1)
        _draw(axis, panel, colours)
        axis.set(xlim=(0.0, 100.0), ylim=(-MOST, MOST), yticks=TICKS)
        axis.set_title(f"({LETTERS[k]}) {panel.title}", loc="left", pad=3)
        axis.tick_params(labelbottom=True)
    for axis in axes[len(panels) :]:
        axis.set_axis_off()
    _key(axes[len(panels)], colours, tolerance)
    figure.supxlabel("nominal coverage [%]", fontsize=STYLE["axes.labelsize"])
    figure.supylabel("observed less nominal coverage [points]", fontsize=STYLE["axes.labelsize"])
    return figure


def _draw(axis: Axes, panel: ReliabilityPanel, colours: Mapping[str, str]) -> None:
    """Draw the curves of one panel, of one case the first limb with a thick line and the second one with a thin one."""
    drawn = Counter[str]()
    for curve in panel.curves:
        look = {"color": colours[curve.case], "linewidth": WIDTHS[min(drawn[curve.case], 1)]}
        for observed, alpha in ((curve.before, LEARNED_ALPHA), (curve.after, 1.0)):
            axis.plot(100.0 * curve.nominal, 100.0 * (observed - curve.nominal), alpha=alpha, **look)
        drawn[curve.case] += 1


def _key(axis: Axes, colours: Mapping[str, str], tolerance: float) -> None:
    """Put the legend into an empty place: cases, what is pale, and the band."""
    handles: list[Any] = [Line2D([], [], color=colour, label=case) for case, colour in colours.items()]
    handles.append(Line2D([], [], color="black", alpha=LEARNED_ALPHA, label="pale: uncalibrated"))
    handles.append(Patch(label=f"within {100.0 * tolerance:g} points", **BAND))
    axis.legend(handles=handles, loc="center left", frameon=False, handlelength=1.8, borderpad=0.0)


def curve_rows(curves: Sequence[CoverageCurve]) -> Iterator[tuple[str, str, str, float, float, float]]:
    """Yield the plotted numbers: case, method, limb, nominal share, observed as learned and scaled."""
    for curve in curves:
        columns = (column.tolist() for column in (curve.nominal, curve.before, curve.after))
        yield from ((curve.case, curve.method, curve.name, *row) for row in zip(*columns, strict=True))
