"""Standard deviations by their own size, and how long an error stays: coverage, error over sigma, autocorrelation."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, StrMethodFormatter

from experiments.evaluation.figures.style import Look, entitle, legend, looks, save_figure
from experiments.evaluation.measure.estimates.sigma import COVER, MEMORY, STD
from experiments.evaluation.number.frames import records_of, rows_of
from experiments.evaluation.number.laws import fields_of, number_from
from experiments.evaluation.number.number import Number
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


def sigma_figure(settings: Sigma, scores: pd.DataFrame, statistics: Statistics, share: float, figure_dir: Path) -> None:
    """Write coverage of a nominal share [-], error [N m] and autocorrelation [-] of tests like the training data."""
    known = {title: test for title, test in settings.tests.items() if title not in settings.against}
    metrics = [MEMORY.format(lag) for lag in settings.lags_ms]
    for pattern in (SIZE, COVERED, ERROR_OF):
        metrics += [pattern.format(part) for part in parts_of(settings)]
    averages = numbers_of(scores, asked_of(known.items(), metrics), statistics)
    records: list[dict[str, object]] = []
    for (title, method, limb), same in averages.groupby(["title", "method", "limb"], sort=False):
        numbers = {row["metric"]: number_from(row) for row in same.to_dict("records")}
        place = {"test": title, "method": method, "limb": limb}
        records += [{**place, **point} for point in points_of(settings, numbers)]
    rows = pd.DataFrame(records, columns=list(SIGMA))
    save_figure(draw_sigma(rows, share), figure_dir / "sigma", SIGMA, records_of(rows, SIGMA))


def points_of(settings: Sigma, numbers: Mapping[str, Number]) -> Iterator[dict[str, object]]:
    """Yield the points of the lines of a limb, of those whose numbers, by their metric, are all there.

    A point has its `panel`, its `x` [unit of LABELS] and the number there.
    """
    parts = parts_of(settings)
    sizes = [numbers[SIZE.format(part)] for part in parts]
    lines = {
        COVERAGE: (parts, [numbers[COVERED.format(part)] for part in parts]),
        ERROR: ([number.value or 0.0 for number in sizes], [numbers[ERROR_OF.format(part)] for part in parts]),
        CORRELATION: (settings.lags_ms, [numbers[MEMORY.format(lag)] for lag in settings.lags_ms]),
    }
    for panel, (x, numbers_shown) in lines.items():
        if all(number.value is not None for number in (*sizes, *numbers_shown)):
            for at, number in zip(x, numbers_shown, strict=True):
                yield {"panel": panel, "x": float(at), **fields_of(number)}


def parts_of(settings: Sigma) -> list[int]:
    """Return the numbers of the parts of the samples, from small to large standard deviations."""
    return list(range(1, settings.parts + 1))


@styled
def draw_sigma(rows: pd.DataFrame, share: float) -> Figure:
    """Draw a large panel and two small ones beside it; thin grey lines show where a sigma that is true would be.

    The rows have columns `SIGMA`.
    """
    rows = rows.assign(label=rows["method"] + ", " + rows["limb"])
    styles = looks(rows["label"].unique())
    figure = Figure(figsize=SIZE_INCH, layout="constrained")
    axes = figure.subplot_mosaic([[ERROR, COVERAGE], [ERROR, CORRELATION]], width_ratios=WIDTHS)
    axes = {panel: axes[panel] for panel in LABELS}
    for k, (panel, axis) in enumerate(axes.items()):
        for _, line in rows_of(rows, panel=panel).groupby(["test", "label"], sort=False):
            _draw(axis, line, styles[line["label"].iloc[0]])
        axis.set(xlabel=LABELS[panel][0], ylabel=LABELS[panel][1])
        entitle(axis, k, panel)
    axes[COVERAGE].axhline(share, **GUIDE)
    axes[COVERAGE].set_ylim(0.0, 1.0)
    parts = sorted(rows_of(rows, panel=COVERAGE)["x"])
    sizes = sorted(rows_of(rows, panel=ERROR)["x"])
    for part in parts[-1:]:
        axes[COVERAGE].annotate(f"nominal share: {share:.0%}", (part, share), (0.0, -14.0), **NAME)
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


def _draw(axis: Axes, line: pd.DataFrame, look: Look) -> None:
    """Draw a line and the band of its intervals."""
    x = line["x"].to_numpy()
    mean, low, high = line[["value", "low", "high"]].astype(float).T.fillna(line["value"].astype(float)).to_numpy()
    axis.plot(x, mean, label=line["label"].iloc[0], marker=look.marker, markersize=2.5, **look.line)
    axis.fill_between(x, low, high, color=look.colour, alpha=0.18, linewidth=0.0)
