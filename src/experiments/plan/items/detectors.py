"""Tables and figures of detectors: they read what detectors find of collisions, and recordings with collisions."""

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from experiments.plan.detection import all_detections
from experiments.plan.files import Files
from experiments.plan.product import PaperItem
from mobnet.settings.data import Push


def table_09() -> Callable[..., None]:
    """Collisions that detectors find, and their delay."""
    from experiments.evaluation.tables.paper.table_09 import table_09

    return table_09


def table_13() -> Callable[..., None]:
    """Thresholds of the detectors."""
    from experiments.evaluation.tables.paper.table_13 import table_13

    return table_13


def false_alarms() -> Callable[..., None]:
    """False alarms an hour."""
    from experiments.evaluation.tables.further.false_alarms import false_alarms

    return false_alarms


def found_by_rate() -> Callable[..., None]:
    """Collisions found at each rate of false alarms."""
    from experiments.evaluation.tables.further.found_by_rate import found_by_rate

    return found_by_rate


def smallest_force() -> Callable[..., None]:
    """The smallest force that is found."""
    from experiments.evaluation.tables.further.smallest_force import smallest_force

    return smallest_force


def links() -> Callable[..., None]:
    """Collisions found by the link that is hit."""
    from experiments.evaluation.tables.further.links import links

    return links


def contact_points() -> Callable[..., None]:
    """Where on a link a force acts, by the estimate."""
    from experiments.evaluation.tables.further.contact_points import contact_points

    return contact_points


def pushes_of(files: Files, scenario: str) -> Mapping[str, Push]:
    """Return the pushes of a scenario by name, in their order."""
    settings = files.settings
    return {name: settings.pushes[name] for name in settings.scenarios[scenario].pushes}


def figure_13() -> Callable[..., None]:
    """Collisions, and when detectors find them."""
    from experiments.evaluation.figures.paper.figure_13 import figure_13

    return figure_13


def figure_14() -> Callable[..., None]:
    """Delays of the detectors."""
    from experiments.evaluation.figures.paper.figure_14 import figure_14

    return figure_14


def figure_15() -> Callable[..., None]:
    """Courses of what detectors look at."""
    from experiments.evaluation.figures.paper.figure_15 import figure_15

    return figure_15


def with_collisions(files: Files, level: str) -> tuple[Path, ...]:
    """Return the recordings with collisions of the robot of a level."""
    return files.robots.get(level, files).tests(files.settings.detection.collisions, level)


def estimates_of_collisions(files: Files, level: str, methods: Iterable[str]) -> Mapping[str, tuple[Path, ...]]:
    """Return what methods estimate of the same recordings."""
    of_robot = files.robots.get(level, files)
    scenario = files.settings.detection.collisions
    estimates: dict[str, tuple[Path, ...]] = {}
    for method in methods:
        estimates[method] = tuple(run.estimate for run in of_robot.runs(scenario, level, [method]))
    return estimates


def detection_curves() -> Callable[..., None]:
    """Collisions found over false alarms."""
    from experiments.evaluation.figures.further.detection_curves import detection_curves

    return detection_curves


ITEMS: tuple[PaperItem, ...] = (
    PaperItem(
        table_09,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.table_09,
            "smallest_force": context.evaluation.smallest_force,
            "detection": context.settings.detection,
            "statistics": context.statistics,
            "published": context.published.tables["table_09"],
            "detections": all_detections(context.files),
        },
    ),
    PaperItem(
        table_13,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.table_13,
            "layout": context.layout,
            "published": context.published.tables["table_13"],
            "detections": all_detections(context.files),
        },
    ),
    PaperItem(
        false_alarms,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.false_alarms,
            "detection": context.settings.detection,
            "statistics": context.statistics,
            "detections": all_detections(context.files),
        },
    ),
    PaperItem(
        found_by_rate,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.found_by_rate,
            "detection": context.settings.detection,
            "statistics": context.statistics,
            "detections": all_detections(context.files),
        },
    ),
    PaperItem(
        smallest_force,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.smallest_force,
            "detection": context.settings.detection,
            "statistics": context.statistics,
            "detections": all_detections(context.files),
        },
    ),
    PaperItem(
        links,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.links,
            "detection": context.settings.detection,
            "statistics": context.statistics,
            "detections": all_detections(context.files),
        },
    ),
    PaperItem(
        contact_points,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.contact_points,
            "contact_point": context.settings.contact_point,
            "robot": context.settings.robot,
            "observer": context.settings.observer,
            "statistics": context.statistics,
            "detections": all_detections(context.files),
            "pushes": pushes_of(context.files, context.evaluation.contact_points.scenario),
            "runs": context.files.runs(
                context.evaluation.contact_points.scenario,
                context.evaluation.contact_points.level,
                context.evaluation.contact_points.methods,
            ),
        },
    ),
    PaperItem(
        figure_13,
        figure=True,
        given=lambda context: {
            "settings": context.evaluation.figure_13,
            "detection": context.settings.detection,
            "robot": context.settings.robot,
            "looks": context.settings.robot.looks,
            "detections": all_detections(context.files),
            "recordings": with_collisions(context.files, context.evaluation.figure_13.level),
        },
    ),
    PaperItem(
        figure_14,
        figure=True,
        given=lambda context: {
            "settings": context.evaluation.figure_14,
            "detection": context.settings.detection,
            "published": context.published.section_5_3,
            "detections": all_detections(context.files),
        },
    ),
    PaperItem(
        figure_15,
        figure=True,
        given=lambda context: {
            "settings": context.evaluation.figure_15,
            "detection": context.settings.detection,
            "layout": context.layout,
            "detections": all_detections(context.files),
            "recordings": with_collisions(context.files, context.evaluation.figure_15.level),
            "estimates": estimates_of_collisions(
                context.files, context.evaluation.figure_15.level, context.evaluation.figure_15.detectors
            ),
        },
    ),
    PaperItem(
        detection_curves,
        figure=True,
        given=lambda context: {
            "settings": context.evaluation.detection_curves,
            "detection": context.settings.detection,
            "statistics": context.statistics,
            "detections": all_detections(context.files),
        },
    ),
)
