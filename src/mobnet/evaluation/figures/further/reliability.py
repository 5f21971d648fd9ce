"""The reliability diagram: observed over nominal coverage, a line for each limb."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from mobnet.core.columns import RELIABILITY
from mobnet.evaluation.figures.style import STYLE, Look, legend, looks, save_figure, styled
from mobnet.evaluation.measure.learning.calibration import CoverageGrid

PANEL_INCH, LEGEND_INCH = 1.8, 0.4  # side of a panel, height of the legend above all
IDEAL = {"color": "0.7", "linewidth": 0.6, "linestyle": "-", "zorder": 0}
TICKS = (0.0, 0.5, 1.0)
LEARNED_ALPHA = 0.35  # of the lines before the scaling
IN_DISTRIBUTION = "in distribution"


@dataclass(frozen=True)
class CoverageCurve:
    """Coverage of one limb over nominal shares (p,): observed with sigma as learned (p,) and scaled (p,)."""

    label: str
    nominal: NDArray[Any]
    before: NDArray[Any]
    after: NDArray[Any]


@dataclass(frozen=True)
class ReliabilityPanel:
    """One panel, with a curve for each limb: the method chooses its row, the title (its tests) the column."""

    method: str
    title: str
    curves: Sequence[CoverageCurve]


@styled
def draw_reliability(panels: Sequence[ReliabilityPanel]) -> Figure:
    """Draw observed over nominal coverage; pale lines as learned, full ones scaled; on the diagonal sigma is true.

    A limb has the same colour in every panel; the place of a method and a title without a panel stays empty.
    """
    methods, titles = (list(dict.fromkeys(getattr(panel, key) for panel in panels)) for key in ("method", "title"))
    styles = looks(curve.label for panel in panels for curve in panel.curves)
    size = PANEL_INCH * max(1, len(titles)), PANEL_INCH * max(1, len(methods)) + LEGEND_INCH
    figure = Figure(figsize=size, layout="constrained")
    axes = figure.subplots(max(1, len(methods)), max(1, len(titles)), squeeze=False)
    for axis in axes.flat:
        axis.set_visible(False)
    for panel in panels:
        axis = axes[methods.index(panel.method), titles.index(panel.title)]
        draw_panel(axis, panel, styles)
        axis.set_title(panel.title, loc="left", pad=3)
        axis.set_ylabel(panel.method)
    figure.supxlabel("nominal coverage [-]; pale: as learned", fontsize=STYLE["axes.labelsize"])
    figure.supylabel("observed coverage [-]", fontsize=STYLE["axes.labelsize"])
    legend(figure, axes.ravel().tolist())
    return figure


def draw_panel(axis: Axes, panel: ReliabilityPanel, styles: Mapping[str, Look]) -> None:
    """Draw the curves of one panel on the diagonal, each limb in its look."""
    axis.set_visible(True)
    axis.plot([0.0, 1.0], [0.0, 1.0], **IDEAL)
    for curve in panel.curves:
        line = styles[curve.label].line
        axis.plot(curve.nominal, curve.before, alpha=LEARNED_ALPHA, **line)
        axis.plot(curve.nominal, curve.after, label=curve.label, **line)
    axis.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0), xticks=TICKS, yticks=TICKS, aspect="equal")


def curve_rows(panels: Sequence[ReliabilityPanel]) -> Iterator[tuple[str, str, str, float, float, float]]:
    """Yield the plotted numbers: title, method, limb, nominal share, observed as learned and scaled."""
    for panel in panels:
        for curve in panel.curves:
            columns = (column.tolist() for column in (curve.nominal, curve.before, curve.after))
            yield from ((panel.title, panel.method, curve.label, *row) for row in zip(*columns, strict=True))


def reliability(panels: Sequence[ReliabilityPanel], figure_dir: Path) -> None:
    """Write the reliability diagram as calibration.pdf, .png and .csv."""
    save_figure(draw_reliability(panels), figure_dir / "calibration", RELIABILITY, curve_rows(panels))


def nominal_points(count: int) -> list[float]:
    """Return nominal shares evenly spread inside 0 and 1 (count,)."""
    return np.linspace(0.0, 1.0, count + 2)[1:-1].tolist()


def panels_of(
    grids: Sequence[CoverageGrid], methods: Sequence[str], skipped: int, points: Sequence[float]
) -> list[ReliabilityPanel]:
    """Return the panels of the figure: for each method one of all collision-free tests, then one of each collision.

    In the grids, the coverage of the nominal points (p,) follows that of the table's levels, `skipped` in number.
    """
    panels: dict[tuple[str, str], list[CoverageCurve]] = {}
    for grid in sorted(grids, key=lambda grid: methods.index(grid.method)):
        title = grid.case if grid.pushed else IN_DISTRIBUTION
        observed = grid.values[..., skipped:-2].mean(axis=(0, 1))
        curve = CoverageCurve(grid.limb + (f" [{grid.unit}]" if grid.limb == "V" else ""), np.array(points), *observed)
        panels.setdefault((grid.method, title), []).append(curve)
    return [ReliabilityPanel(*key, curves) for key, curves in panels.items()]
