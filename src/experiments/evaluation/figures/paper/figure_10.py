"""Figure 10: pushes on the knee of a leg in the air, and on the ground: curves, errors, shares shown and delays."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import pandas as pd

from experiments.evaluation.compare.curves import Panel
from experiments.evaluation.figures.drawing.curves import table_of
from experiments.evaluation.figures.drawing.named_bars import PAPER_LABEL, NamedBar
from experiments.evaluation.figures.drawing.pushes import PushGroup, draw_hits
from experiments.evaluation.figures.style import save_figure
from experiments.evaluation.measure.estimates.peaks import DELAY, OBSERVER, SHARE
from experiments.evaluation.measure.estimates.pushes import INCREASE, push_numbers, read_pushes
from experiments.evaluation.measure.estimates.run_errors import ERROR
from experiments.evaluation.number.frames import read_scores, records_of, rows_of
from experiments.evaluation.number.laws import numbers_by
from experiments.evaluation.number.rows import write_csv
from experiments.evaluation.number.scored import AVERAGE
from experiments.plan.runs import Run
from experiments.settings.figures import Figure10
from experiments.settings.published import PublishedTable
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import PUSH_ERRORS
from mobnet.core.joints import JointLayout

PICTURES = ("figure_10", "figure_10_support")  # of the tests of the section, in its order


def figure_10(
    settings: Figure10,
    published: PublishedTable,
    layout: JointLayout,
    statistics: Statistics,
    runs: Mapping[str, Sequence[Run]],
    scores: Sequence[Path],
    figure_dir: Path,
) -> None:
    """Write Figure 10, pushes on the knee of a leg [N m]: curves and numbers by method, a picture for each test.

    The first is that of the leg in the air, the second that of the leg on the ground. The title of a test leads to its
    runs, one of each method and all of one recording. Numbers of both are in one file.
    """
    read = read_scores(*scores)
    rows: list[pd.DataFrame] = []
    for picture, (title, test) in zip(PICTURES, settings.tests.items(), strict=False):
        numbers = push_numbers(read, layout, settings, test, published, statistics)
        drawn = [run for run in runs[title] if run.method in settings.drawn]
        panels = [ours_banded(panel) for panel in read_pushes(layout, settings, drawn, f"{title} {{}}", band=True)]
        figure = draw_hits(group_of(panels, title, numbers), settings.joint, PAPER_LABEL[True])
        save_figure(figure, figure_dir / picture, *table_of(panels))
        rows.append(numbers)
    write_csv(figure_dir / "figure_10_bars.csv", PUSH_ERRORS, records_of(pd.concat(rows), PUSH_ERRORS))


def group_of(panels: Sequence[Panel], title: str, rows: pd.DataFrame) -> PushGroup:
    """Return what is drawn of a test: its curves, and of its `PUSH_ERRORS` errors [N m], shares [-], delays [ms]."""
    # Rows over all pushes are numbers, those of single ones are marks.
    averages = rows_of(rows, push=AVERAGE)
    errors = rows_of(rows, measure=ERROR)
    single = errors[~errors["push"].isin([AVERAGE, INCREASE])].dropna(subset="value")
    bars: list[NamedBar] = []
    for method, number in numbers_by(rows_of(averages, measure=ERROR), "method").items():
        bars.append(NamedBar(method, method, number, rows_of(single, method=method)["value"].tolist()))
    shares = named_numbers(rows_of(averages, measure=SHARE))
    delays = named_numbers(rows_of(averages, measure=DELAY))
    # Where nothing pushes nothing is late.
    late = rows_of(averages, measure=DELAY + OBSERVER)["value"].dropna()
    late_ms = next((value for value in late if value), None)
    return PushGroup(panels, f"{title}: all hits, walks and robots", bars, shares, delays, late_ms)


def named_numbers(rows: pd.DataFrame) -> list[NamedBar]:
    """Return the number of each method."""
    return [NamedBar(method, method, number) for method, number in numbers_by(rows, "method").items()]


def ours_banded(panel: Panel) -> Panel:
    """Return a panel with the standard deviation of its last method alone."""
    *others, ours = panel.curves
    return replace(panel, curves=[*(replace(curve, std=None) for curve in others), ours])
