"""Figure 10: pushes on the knee of a leg in the air, and on the ground: curves, errors, shares shown and delays."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from experiments.evaluation.compare.curves import Panel
from experiments.evaluation.figures.drawing.curves import table_of
from experiments.evaluation.figures.drawing.named_bars import PAPER_LABEL, NamedBar
from experiments.evaluation.figures.drawing.pushes import PushGroup, draw_hits
from experiments.evaluation.figures.style import save_figure
from experiments.evaluation.measure.estimates.peaks import DELAY, OBSERVER, SHARE
from experiments.evaluation.measure.estimates.pushes import (
    AVERAGE,
    INCREASE,
    PushErrors,
    Responses,
    collision_errors,
    read_pushes,
    responses_of,
)
from experiments.evaluation.measure.estimates.run_errors import ERROR
from experiments.evaluation.number.grid import read_lookup
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import Field, write_csv
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
    lookup = read_lookup(scores, statistics)
    rows = list[tuple[Field, ...]]()
    for picture, (title, test) in zip(PICTURES, settings.tests.items(), strict=False):
        errors = collision_errors(layout, settings, test, published, lookup)
        responses = responses_of(layout, lookup, test, settings.joint)
        drawn = [run for run in runs[title] if run.method in settings.drawn]
        panels = [ours_banded(panel) for panel in read_pushes(layout, settings, drawn, f"{title} {{}}", band=True)]
        group = group_of(panels, title, errors, responses)
        figure = draw_hits(group, settings.joint, PAPER_LABEL[True])
        save_figure(figure, figure_dir / picture, *table_of(panels))
        rows += rows_of(test.scenario, errors, responses)
    write_csv(figure_dir / "figure_10_bars.csv", PUSH_ERRORS, rows)


def group_of(panels: Sequence[Panel], title: str, errors: PushErrors, responses: Responses) -> PushGroup:
    """Return what is drawn of a test: its curves, and of each method errors [N m], share [-] and delay [ms]."""
    bars = [NamedBar(name, name, own[AVERAGE], marks_of(own)) for name, own in errors.items()]
    shares = [NamedBar(name, name, responses[name][SHARE]) for name in errors]
    delays = [NamedBar(name, name, responses[name][DELAY]) for name in errors]
    late = next((own[DELAY + OBSERVER].value for own in responses.values() if own[DELAY + OBSERVER].value), None)
    return PushGroup(panels, f"{title}: all hits, walks and robots", bars, shares, delays, late)


def ours_banded(panel: Panel) -> Panel:
    """Return a panel with the standard deviation of its last method alone."""
    *others, ours = panel.curves
    return replace(panel, curves=[*(replace(curve, std=None) for curve in others), ours])


def marks_of(own: Mapping[str, Number]) -> list[float]:
    """Return a method's error in each push [N m]."""
    return [
        number.value for push, number in own.items() if push not in (AVERAGE, INCREASE) and number.value is not None
    ]


def rows_of(scenario: str, errors: PushErrors, responses: Responses) -> list[tuple[Field, ...]]:
    """Return rows of `PUSH_ERRORS`: a method's errors by push, then its share and delay over all pushes."""
    found: list[tuple[str, str, str, Number]] = []
    for method, own in errors.items():
        found += [(method, push, ERROR, error) for push, error in own.items()]
        found += [(method, AVERAGE, measure, number) for measure, number in responses[method].items()]
    return [
        (scenario, method, push, measure, *number.with_ends, *number.spread, number.unit, number.published)
        for method, push, measure, number in found
    ]
