"""Figures of one walk: they read its recording, residual and estimates, and the scores of its test."""

from collections.abc import Callable

from experiments.plan.files import Files
from experiments.plan.product import Arguments, Context, PaperItem
from experiments.plan.runs import Run
from experiments.settings.figures import Figure05, HandFigure
from experiments.settings.runs import Runs


def figure_05() -> Callable[..., None]:
    """Forward walking at each level of uncertainty."""
    from experiments.evaluation.figures.paper.figure_05 import figure_05

    return figure_05


def runs_of_panels(files: Files, section: Figure05) -> tuple[Run, ...]:
    """Return the first runs at each level of which the figure has a panel."""
    runs: list[Run] = []
    for level, methods in section.panels.items():
        runs += files.first_runs(Runs(scenario=section.scenario, level=level, methods=methods))
    return tuple(runs)


def figure_06() -> Callable[..., None]:
    """Pushes of a leg in the air."""
    from experiments.evaluation.figures.paper.figure_06 import figure_06

    return figure_06


def figure_07() -> Callable[..., None]:
    """A load on the left hand of the plant of section 5.1."""
    from experiments.evaluation.figures.paper.hand_figure import hand_figure

    return hand_figure


def figure_08() -> Callable[..., None]:
    """A gait cycle of a leg on surrogate robots."""
    from experiments.evaluation.figures.paper.figure_08 import figure_08

    return figure_08


def figure_09() -> Callable[..., None]:
    """A gait cycle of the base on surrogate robots."""
    from experiments.evaluation.figures.paper.figure_09 import figure_09

    return figure_09


def figure_10() -> Callable[..., None]:
    """Hits of a knee, in the air and on the ground."""
    from experiments.evaluation.figures.paper.figure_10 import figure_10

    return figure_10


def figure_12() -> Callable[..., None]:
    """A load on the left hand of surrogate robots."""
    from experiments.evaluation.figures.paper.hand_figure import hand_figure

    return hand_figure


def of_a_hand(context: Context, name: str, section: HandFigure) -> Arguments:
    """Return what a figure of a loaded hand gets."""
    return {
        "settings": section,
        "name": name,
        "layout": context.layout,
        "detection": context.settings.detection,
        "statistics": context.statistics,
        "published": context.published.tables[section.table],
        "runs": context.files.first_runs(section),
        "scores": context.scores(section),
    }


ITEMS: tuple[PaperItem, ...] = (
    PaperItem(
        figure_05,
        figure=True,
        bars=True,
        given=lambda context: {
            "settings": context.evaluation.figure_05,
            "start_s": context.start_s(context.evaluation.figure_05.start_s),
            "layout": context.layout,
            "statistics": context.statistics,
            "published": context.published.tables[context.evaluation.figure_05.table],
            "scores": context.scores(context.evaluation.figure_05),
            "runs": runs_of_panels(context.files, context.evaluation.figure_05),
        },
    ),
    PaperItem(
        figure_06,
        figure=True,
        bars=True,
        given=lambda context: {
            "settings": context.evaluation.figure_06,
            "published": context.published.tables["figure_06"],
            "layout": context.layout,
            "statistics": context.statistics,
            "runs": context.files.first_runs(context.evaluation.figure_06),
            "scenarios": context.settings.scenarios,
            "pushes": context.settings.pushes,
            "scores": context.scores(context.evaluation.figure_06),
        },
    ),
    PaperItem(
        figure_07,
        figure=True,
        bars=True,
        given=lambda context: of_a_hand(context, "figure_07", context.evaluation.figure_07),
    ),
    PaperItem(
        figure_08,
        figure=True,
        bars=True,
        given=lambda context: {
            "settings": context.evaluation.figure_08,
            "start_s": context.start_s(context.evaluation.figure_08.start_s),
            "layout": context.layout,
            "statistics": context.statistics,
            "published": context.published.tables[context.evaluation.figure_08.table],
            "runs": context.files.first_runs(context.evaluation.figure_08),
            "scores": context.scores(context.evaluation.figure_08),
        },
    ),
    PaperItem(
        figure_09,
        figure=True,
        bars=True,
        given=lambda context: {
            "settings": context.evaluation.figure_09,
            "start_s": context.start_s(context.evaluation.figure_09.start_s),
            "layout": context.layout,
            "statistics": context.statistics,
            "published": context.published.tables[context.evaluation.figure_09.table],
            "runs": context.files.first_runs(context.evaluation.figure_09),
            "scores": context.scores(context.evaluation.figure_09),
        },
    ),
    PaperItem(
        figure_10,
        figure=True,
        further=("figure_10_support",),
        bars=True,
        given=lambda context: {
            "settings": context.evaluation.figure_10,
            "published": context.published.tables["figure_10"],
            "layout": context.layout,
            "statistics": context.statistics,
            "scores": context.scores(context.evaluation.figure_10),
            "runs": {
                title: context.files.first_runs(test) for title, test in context.evaluation.figure_10.tests.items()
            },
        },
    ),
    PaperItem(
        figure_12,
        figure=True,
        bars=True,
        given=lambda context: of_a_hand(context, "figure_12", context.evaluation.figure_12),
    ),
)
