"""Tables and figures of what is recorded: they read recordings and the observer's residuals."""

from collections import defaultdict
from collections.abc import Callable, Mapping
from pathlib import Path

from experiments.plan.files import Files
from experiments.plan.product import PaperItem

Sets = Mapping[str, tuple[Path, ...]]  # name of a set -> its recordings, or their residuals


def data() -> Callable[..., None]:
    """What the training data contain."""
    from experiments.evaluation.tables.further.data import data

    return data


def training_sets(files: Files) -> Sets:
    """Return the recordings of every training set that is recorded, those of all robots together."""
    walked: set[str] = set()
    for of_robot in files.robots.values():
        walked.update(of_robot.learned_sets)
    fleet = [other for name, other in files.settings.fleet.sets.items() if name in walked]
    return {name: files.training("recordings", name) for name in (*files.recorded_sets, *fleet)}


def commands() -> Callable[..., None]:
    """How often each command of walking was given."""
    from experiments.evaluation.figures.further.commands import commands

    return commands


def steps() -> Callable[..., None]:
    """The steps of random walking beside those that the commands allow."""
    from experiments.evaluation.tables.further.steps import steps

    return steps


def figure_19() -> Callable[..., None]:
    """Velocity and torque in training and tests."""
    from experiments.evaluation.figures.paper.figure_19 import figure_19

    return figure_19


def coverage() -> Callable[..., None]:
    """Which share of the states of tests the training data cover."""
    from experiments.evaluation.tables.further.coverage import coverage

    return coverage


def with_and_without_rte(files: Files) -> Sets:
    """Return the first robot's recordings of random walking, with random torques and without."""
    first = next(iter(files.robots.values()))
    sets = {"with RTE": "walk", "without RTE": "walk_plain"}
    return {label: first.training("recordings", name) for label, name in sets.items()}


def compared_tests(files: Files) -> tuple[tuple[Path, ...], ...]:
    """Return the first robot's recordings of the tests that its training data are compared with."""
    robot, first = next(iter(files.robots.items()))
    return tuple(first.tests(test.scenario, robot) for test in files.settings.evaluation.coverage.tests)


def uncertainty() -> Callable[..., None]:
    """How large the torques are that the nominal model does not know."""
    from experiments.evaluation.tables.further.uncertainty import uncertainty

    return uncertainty


def learned_from(files: Files) -> list[str]:
    """Return the training sets that networks learn from."""
    return list(dict.fromkeys(row.data for row in files.settings.networks.values()))


def residuals_by_robot(files: Files) -> Mapping[str, Sets]:
    """Return the residuals of the training sets that networks of each robot learn from."""
    names = learned_from(files)
    robots: dict[str, Sets] = {}
    for robot, of_robot in files.whole_robots.items():
        sets = [name for name in of_robot.learned_sets if name in names]
        robots[robot] = {name: of_robot.training("residuals", name) for name in sets}
    return robots


def label_error() -> Callable[..., None]:
    """The error of the labels from which networks learn."""
    from experiments.evaluation.tables.further.label_error import label_error

    return label_error


def first_walks(files: Files) -> Mapping[str, tuple[Path, Path]]:
    """Return the first recording of each robot from which its legs learn, with its residual."""
    walks: dict[str, tuple[Path, Path]] = {}
    for robot, of_robot in files.whole_robots.items():
        walks[robot] = of_robot.training("recordings", "walk")[0], of_robot.training("residuals", "walk")[0]
    return walks


def hourly() -> Callable[..., None]:
    """How often an hour robots fall, and networks warn of a robot that they know."""
    from experiments.evaluation.tables.further.hourly import hourly

    return hourly


def walks_by_kind(files: Files) -> Mapping[str, list[Path]]:
    """Return all recordings by what is walked: falls are counted by what disturbs a walk (docs/notes/measures.md)."""
    walks = defaultdict[str, list[Path]](list)
    for owner in files.owners:
        for scenario, level, seed in owner.recorded():
            row = files.settings.scenarios[scenario]
            kind = "with random torque" if row.random_torque else "pushed" if row.pushes else "undisturbed"
            title = f"{'surrogate robots' if owner.robot else 'plant of section 5.1'}, {kind}"
            walks[title].append(owner.array("recordings", scenario, level, seed))
    return dict(walks)


ITEMS: tuple[PaperItem, ...] = (
    PaperItem(
        data,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.data,
            "robot": context.settings.robot,
            "walking": context.settings.walking,
            "commands": context.settings.commands,
            "terrain": context.settings.terrain,
            "recording": context.settings.recording,
            "published": context.published.data,
            "sets": training_sets(context.files),
        },
    ),
    PaperItem(
        commands,
        figure=True,
        given=lambda context: {
            "settings": context.evaluation.commands,
            "commands": context.settings.commands,
            "layout": context.layout,
            "sets": {name: context.files.training("recordings", name) for name in context.evaluation.commands.sets},
        },
    ),
    PaperItem(
        steps,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.steps,
            "robot": context.settings.robot,
            "walking": context.settings.walking,
            "commands": context.settings.commands,
            "sets": {"walk": context.files.training("recordings", "walk")},
        },
    ),
    PaperItem(
        figure_19,
        figure=True,
        given=lambda context: {
            "settings": context.evaluation.figure_19,
            "coverage": context.evaluation.coverage,
            "layout": context.layout,
            "training": with_and_without_rte(context.files),
            "tests": compared_tests(context.files),
        },
    ),
    PaperItem(
        coverage,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.coverage,
            "layout": context.layout,
            "ports": context.settings.robot.networks[context.evaluation.coverage.limb],
            "statistics": context.statistics,
            "training": with_and_without_rte(context.files),
            "tests": compared_tests(context.files),
        },
    ),
    PaperItem(
        uncertainty,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.uncertainty,
            "networks": context.settings.networks,
            "layout": context.layout,
            "published": context.published.uncertainty,
            "sets": {name: context.files.training("residuals", name) for name in learned_from(context.files)},
            "robots": residuals_by_robot(context.files),
        },
    ),
    PaperItem(
        label_error,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.label_error,
            "robot": context.settings.robot,
            "observer": context.settings.observer,
            "layout": context.layout,
            "walks": first_walks(context.files),
        },
    ),
    PaperItem(
        hourly,
        table=True,
        given=lambda context: {
            "settings": context.evaluation.hourly,
            "changed": context.evaluation.changed,
            "statistics": context.statistics,
            "walks": walks_by_kind(context.files),
            # Of robots that networks know: their check should flag nothing.
            "scores": context.scores(
                tuple(context.evaluation.changed.tests[title] for title in context.evaluation.hourly.known)
            ),
        },
    ),
)
