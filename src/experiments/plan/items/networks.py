"""Tables and figures of networks: they read trainings, or what the configuration says of them."""

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from experiments.plan.files import Files
from experiments.plan.product import PaperItem
from experiments.plan.runs import Run
from experiments.settings.measures import CalibrationTest


def table_01() -> Callable[..., None]:
    """Sizes and learning of the networks of each limb."""
    from experiments.evaluation.tables.paper.table_01 import table_01

    return table_01


def figure_17() -> Callable[..., None]:
    """Losses by kind of network."""
    from experiments.evaluation.figures.paper.figure_17 import figure_17

    return figure_17


def both_recipes(files: Files) -> tuple[Path, ...]:
    """Return the trained networks of Figure 17, those that learned by one recipe first."""
    figure = files.settings.evaluation.figure_17
    return (
        *files.network_folders(figure.methods, figure.limb, figure.level),
        *files.network_folders(figure.best, figure.limb, figure.best_level),
    )


def kinds() -> Callable[..., None]:
    """Losses by kind of network, with variants of ours."""
    from experiments.evaluation.tables.further.kinds import kinds

    return kinds


def all_kinds(files: Files) -> tuple[Path, ...]:
    """Return the trained networks of Figure 17, then those of the variants that the table of kinds shows."""
    section = files.settings.evaluation.kinds
    limb = files.settings.evaluation.figure_17.limb
    return *both_recipes(files), *files.network_folders(section.variants, limb, section.level)


def figure_20() -> Callable[..., None]:
    """Losses by size of the network and by share of the data."""
    from experiments.evaluation.figures.paper.figure_20 import figure_20

    return figure_20


def latency() -> Callable[..., None]:
    """How long networks take for a tick."""
    from experiments.evaluation.tables.further.latency import latency

    return latency


def networks_of_limbs(files: Files, method: str) -> Mapping[str, Path]:
    """Return the first trained network of a method for each of its limbs."""
    first = files.network_seeds(method)[0]
    return {limb: files.network(method, limb, first) for limb in files.catalogue.method(method).limbs}


def calibration() -> Callable[..., None]:
    """Whether errors are as large as the standard deviations that networks predict."""
    from experiments.evaluation.report.calibration import calibration

    return calibration


def networks_by_level(files: Files) -> Mapping[str, tuple[Path, ...]]:
    """Return every network by the level that it learned at."""
    robots: list[Path] = []
    for of_robot in files.robots.values():
        robots += of_robot.all_networks()
    plant = tuple(folder for folder in files.all_networks() if folder not in robots)
    first = next(iter(files.settings.training_sets.values()))
    return {first.level: plant, files.settings.fleet.name: tuple(robots)}


def runs_by_test(files: Files, tests: Iterable[CalibrationTest]) -> tuple[tuple[Run, ...], ...]:
    """Return every run of the methods of each of some tests."""
    return tuple(files.runs(test.scenario, test.level, test.methods) for test in tests)


ITEMS: tuple[PaperItem, ...] = (
    PaperItem(
        table_01,
        table=True,
        given=lambda context: {
            "networks": {
                limb: context.files.catalogue.network(context.evaluation.table_01.method, limb)
                for limb in context.published.table_01.rows
            },
            "target": context.files.catalogue.method(context.evaluation.table_01.method).target,
            "layout": context.layout,
            "learning": context.settings.learning,
            "seed": context.settings.seed,
            "published": context.published.table_01,
        },
    ),
    PaperItem(
        figure_17,
        figure=True,
        given=lambda context: {
            "settings": context.evaluation.figure_17,
            "folders": both_recipes(context.files),
            "statistics": context.statistics,
        },
    ),
    PaperItem(
        kinds,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.kinds,
            "figure_17": context.evaluation.figure_17,
            "statistics": context.statistics,
            "published": context.published.kinds,
            "folders": all_kinds(context.files),
        },
    ),
    PaperItem(
        figure_20,
        figure=True,
        given=lambda context: {
            "sizes_of_networks": context.files.swept_sizes(),
            "statistics": context.statistics,
        },
    ),
    PaperItem(
        latency,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.latency,
            "statistics": context.statistics,
            "rates": context.settings.rates,
            "layout": context.layout,
            "seed": context.settings.seed,
            "networks": networks_of_limbs(context.files, context.evaluation.latency.method),
        },
    ),
    PaperItem(
        calibration,
        table=True,
        figure=True,
        given=lambda context: {
            "settings": context.evaluation.calibration,
            "learning": context.settings.learning,
            "coverage": context.evaluation.coverage,
            "layout": context.layout,
            "statistics": context.statistics,
            "folders": networks_by_level(context.files),
            "runs": runs_by_test(context.files, context.evaluation.calibration.tests),
        },
    ),
)
