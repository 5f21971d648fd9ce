"""Tables and figures of reactions: they read the trials of every robot, and the courses of walks."""

from collections.abc import Callable

from experiments.plan.product import PaperItem
from experiments.plan.reactions import all_reactions, courses_of, courses_of_robots


def safety() -> Callable[..., None]:
    """Robots that walk into an obstacle and react, or do not."""
    from experiments.evaluation.tables.further.safety import safety

    return safety


def sensorless() -> Callable[..., None]:
    """Robots that walk without force sensors."""
    from experiments.evaluation.tables.further.sensorless import sensorless

    return sensorless


def figure_16() -> Callable[..., None]:
    """Forces while a robot walks into an obstacle."""
    from experiments.evaluation.figures.paper.figure_16 import figure_16

    return figure_16


def figure_21() -> Callable[..., None]:
    """A robot that walks into an obstacle, as pictures."""
    from experiments.evaluation.figures.paper.figure_21 import figure_21

    return figure_21


def figure_22() -> Callable[..., None]:
    """Reactions in other cases."""
    from experiments.evaluation.figures.paper.figure_22 import figure_22

    return figure_22


ITEMS: tuple[PaperItem, ...] = (
    PaperItem(
        safety,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.safety,
            "reaction": context.settings.reaction,
            "statistics": context.statistics,
            "published": context.published.section_5_4,
            "reactions": all_reactions(context.files),
        },
    ),
    PaperItem(
        sensorless,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.sensorless,
            "statistics": context.statistics,
            "reactions": all_reactions(context.files),
        },
    ),
    PaperItem(
        figure_16,
        figure=True,
        given=lambda context: {
            "settings": context.evaluation.figure_16,
            "reaction": context.settings.reaction,
            "statistics": context.statistics,
            "published": context.published.section_5_4,
            "reactions": all_reactions(context.files),
            "courses": courses_of(context.files, context.evaluation.figure_16.cases),
        },
    ),
    PaperItem(
        figure_21,
        figure=True,
        given=lambda context: {
            "settings": context.evaluation.figure_21,
            "robot": context.settings.robot,
            "obstacles": context.settings.obstacles,
            "courses": courses_of(context.files, [context.evaluation.figure_21.case]),
        },
    ),
    PaperItem(
        figure_22,
        figure=True,
        given=lambda context: {
            "settings": context.evaluation.figure_22,
            "robot": context.settings.robot,
            "looks": context.settings.robot.looks,
            "obstacles": context.settings.obstacles,
            "reaction": context.settings.reaction,
            "reactions": all_reactions(context.files),
            "courses": courses_of_robots(context.files, context.evaluation.figure_22.cases),
        },
    ),
)
