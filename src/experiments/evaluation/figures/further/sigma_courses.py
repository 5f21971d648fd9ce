"""Standard deviations by their own size, and how long an error stays: coverage, error over sigma, autocorrelation."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, StrMethodFormatter

from experiments.evaluation.figures.style import Look, entitle, legend, looks, save_figure
from experiments.evaluation.measure.estimates.sigma import COVER, MEMORY, STD
from experiments.evaluation.number.laws import number_from
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import Field
from experiments.evaluation.number.scored import asked_of, numbers_of
from experiments.settings.measures import Sigma
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import SIGMA
from mobnet.core.style import PAGE_INCH, styled

COVERAGE = "coverage"
ERROR = "error over sigma"
CORRELATION = "autocorrelation"
LABELS = {
    ERROR: ("mean predicted sigma [N m]", "RMSE [N m]"),
    COVERAGE: ("part of the samples by size of sigma", "covered share [-]"),
    CORRELATION: ("lag [ms]", "autocorrelation [-]"),
}
SIZE_INCH, WIDTHS = (PAGE_INCH, 3.6), (1.45, 1.0)  # of the figure; share of the large panel and of the two others
NAME: dict[str, Any] = {
    "textcoords": "offset points",
    "ha": "right",
    "va": "center",
    "fontsize": 7,
}  # of a thin grey line
SIZE, COVERED, ERROR_OF = f"{STD}_part_{{}}", f"{COVER}_part_{{}}", "rmse_part_{}"  # metrics of a part
DIAGONAL = "error = sigma"
GUIDE = {"color": "0.7", "linewidth": 0.6, "linestyle": "-", "zorder": 0}  # where sigma would be true


@dataclass(frozen=True)
class SigmaLine:
    """A line of a panel: numbers (n,) of a limb of a method in a test, over x (n,) [units of LABELS]."""

    panel: str
    test: str
    method: str
    limb: str
    x: Sequence[float]
    numbers: Sequence[Number]

    @property
    def label(self) -> str:
        """Name in the legend."""
        return f"{self.method}, {self.limb}"

    def rows(self) -> Iterator[tuple[Field, ...]]:
        """Yield the rows of sigma.csv."""
        for x, number in zip(self.x, self.numbers, strict=True):
            yield self.panel, self.test, self.method, self.limb, float(x), *number.with_ends, *number.spread


def sigma_figure(settings: Sigma, scores: pd.DataFrame, statistics: Statistics, share: float, figure_dir: Path) -> None:
    """Write coverage of a nominal share [-], error [N m] and autocorrelation [-] of tests like the training data."""
    known = {title: test for title, test in settings.tests.items() if title not in settings.against}
    metrics = [MEMORY.format(lag) for lag in settings.lags_ms]
    for pattern in (SIZE, COVERED, ERROR_OF):
        metrics += [pattern.format(part) for part in parts_of(settings)]
    averages = numbers_of(scores, asked_of(known.items(), metrics), statistics)
    courses: list[SigmaLine] = []
    for (title, method, limb), same in averages.groupby(["title", "method", "limb"], sort=False):
        numbers = {row["metric"]: number_from(row) for row in same.to_dict("records")}
        courses += courses_of(settings, numbers, str(title), str(method), str(limb))
    rows = [row for course in courses for row in course.rows()]
    save_figure(draw_sigma(courses, share), figure_dir / "sigma", SIGMA, rows)


def courses_of(
    settings: Sigma, numbers: Mapping[str, Number], title: str, method: str, limb: str
) -> Iterator[SigmaLine]:
    """Yield the lines of a limb of a method in a test, those whose numbers, by their metric, are all there."""
    parts = parts_of(settings)
    sizes = [numbers[SIZE.format(part)] for part in parts]
    lines = {
        COVERAGE: (parts, [numbers[COVERED.format(part)] for part in parts]),
        ERROR: ([number.value or 0.0 for number in sizes], [numbers[ERROR_OF.format(part)] for part in parts]),
        CORRELATION: (settings.lags_ms, [numbers[MEMORY.format(lag)] for lag in settings.lags_ms]),
    }
    for panel, (x, numbers_shown) in lines.items():
        if all(number.value is not None for number in (*sizes, *numbers_shown)):
            yield SigmaLine(panel, title, method, limb, x, numbers_shown)


def parts_of(settings: Sigma) -> list[int]:
    """Return the numbers of the parts of the samples, from small to large standard deviations."""
    return list(range(1, settings.parts + 1))


@styled
def draw_sigma(courses: Sequence[SigmaLine], share: float) -> Figure:
    """Draw a large panel and two small ones beside it; thin grey lines show where a sigma that is true would be."""
    styles = looks(course.label for course in courses)
    figure = Figure(figsize=SIZE_INCH, layout="constrained")
    axes = figure.subplot_mosaic([[ERROR, COVERAGE], [ERROR, CORRELATION]], width_ratios=WIDTHS)
    axes = {panel: axes[panel] for panel in LABELS}
    for k, (panel, axis) in enumerate(axes.items()):
        for course in courses:
            if course.panel == panel:
                _draw(axis, course, styles[course.label])
        axis.set(xlabel=LABELS[panel][0], ylabel=LABELS[panel][1])
        entitle(axis, k, panel)
    axes[COVERAGE].axhline(share, **GUIDE)
    axes[COVERAGE].set_ylim(0.0, 1.0)
    parts: list[float] = []
    sizes: list[float] = []
    for course in courses:
        if course.panel == COVERAGE:
            parts += course.x
        elif course.panel == ERROR:
            sizes += course.x
    for part in sorted(parts)[-1:]:
        axes[COVERAGE].annotate(f"nominal share: {share:.0%}", (part, share), (0.0, -14.0), **NAME)
    sizes.sort()
    axes[ERROR].plot(sizes, sizes, **GUIDE)
    for x in sizes[-1:]:
        axes[ERROR].annotate(DIAGONAL, (x, x), (-4.0, 0.0), **NAME)
    axes[ERROR].set(xscale="log", yscale="log")
    axes[CORRELATION].set_xscale("log")
    axes[COVERAGE].xaxis.set_major_locator(MaxNLocator(integer=True))
    scales = {axes[ERROR].xaxis: (1, 2, 5), axes[ERROR].yaxis: (1, 2, 5), axes[CORRELATION].xaxis: (1,)}
    for scale, steps in scales.items():
        scale.set_major_locator(LogLocator(subs=steps))
        scale.set_major_formatter(StrMethodFormatter("{x:g}"))
        scale.set_minor_formatter(NullFormatter())
    axes[CORRELATION].axhline(0.0, **GUIDE)
    legend(figure, list(axes.values()))
    return figure


def _draw(axis: Axes, course: SigmaLine, look: Look) -> None:
    """Draw a line and the band of its intervals."""
    mean, low, high = np.array([number.range for number in course.numbers], dtype=np.float64).T
    axis.plot(course.x, mean, label=course.label, marker=look.marker, markersize=2.5, **look.line)
    axis.fill_between(course.x, low, high, color=look.colour, alpha=0.18, linewidth=0.0)
