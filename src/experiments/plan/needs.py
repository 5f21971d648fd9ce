"""What tables and figures are made from: scores, runs, recordings or trainings.

Each function returns what one parameter of a product's function gets. The row of the product names it
(`experiments.settings.products.MadeBy.needs`); a section is that of the product.
"""

from collections import defaultdict
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

from experiments.plan.detection import Detections, all_detections, detection_files
from experiments.plan.files import Files, SweptSize
from experiments.plan.parts import PageScene
from experiments.plan.project import project_file
from experiments.plan.reactions import Reactions, all_reactions, courses_of, courses_of_robots
from experiments.plan.runs import Run
from experiments.settings.asked import tests_in
from experiments.settings.products import MadeBy
from experiments.settings.published import PublishedTable
from experiments.settings.runs import Runs
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.settings.data import Push
from mobnet.settings.networks import Limb, Network

Need = Callable[[Files, Any], object]
Named = TypeVar("Named", bound=Need)
ByName = Mapping[str, tuple[Path, ...]]
NEEDS: dict[str, Need] = {}  # by name


def need(function: Named) -> Named:
    """Let rows of products name a function."""
    NEEDS[function.__name__] = function
    return function


def needs_of(files: Files, row: MadeBy, section: Any) -> dict[str, object]:
    """Return what a product is made from, by parameter of its function.

    Raises:
        ConfigError: the row names a need that there is not.
    """
    found: dict[str, object] = {}
    for parameter, name in row.needs.items():
        if name not in NEEDS:
            raise ConfigError(not_accepted(f"need of {row.function}", name, NEEDS))
        found[parameter] = NEEDS[name](files, section)
    return found


# Scores and runs of tests.
@need
def scores(files: Files, section: Any) -> tuple[Path, ...]:
    """Return the scores of the tests that a section, or a tuple of them, names, at the levels that it names."""
    return files.scores(tests_in(files.settings, section))


@need
def scores_of_known_robots(files: Files, section: Any) -> tuple[Path, ...]:
    """Return the scores of the tests of robots that networks know, in which their check should flag nothing."""
    tests = files.settings.evaluation.changed.tests
    return scores(files, tuple(tests[title] for title in section.known))


@need
def claimed_scores(files: Files, _: Any) -> tuple[Path, ...]:
    """Return the scores that claims name."""
    return scores(files, files.settings.claims)


@need
def first_runs(files: Files, section: Any) -> tuple[Run, ...]:
    """Return the first run of each method of a section."""
    return files.first_runs(section)


@need
def first_runs_of_panels(files: Files, section: Any) -> tuple[Run, ...]:
    """Return the first runs at each level of which a section has a panel."""
    runs: list[Run] = []
    for level, methods in section.panels.items():
        runs += files.first_runs(Runs(scenario=section.scenario, level=level, methods=methods))
    return tuple(runs)


@need
def first_runs_by_title(files: Files, section: Any) -> Mapping[str, tuple[Run, ...]]:
    """Return the first runs of each test of a section, by its title."""
    return {title: files.first_runs(test) for title, test in section.tests.items()}


@need
def all_runs(files: Files, section: Any) -> tuple[Run, ...]:
    """Return every run of the methods of a section."""
    return files.runs(section.scenario, section.level, section.methods)


@need
def runs_by_test(files: Files, section: Any) -> tuple[tuple[Run, ...], ...]:
    """Return every run of the methods of each test of a section."""
    return tuple(files.runs(test.scenario, test.level, test.methods) for test in section.tests)


@need
def pushes_of_test(files: Files, section: Any) -> Mapping[str, Push]:
    """Return the pushes of the test of a section."""
    settings = files.settings
    return {name: settings.pushes[name] for name in settings.scenarios[section.scenario].pushes}


# Recordings and residuals.
@need
def training_sets(files: Files, _: Any) -> ByName:
    """Return the recordings of every training set that is recorded, those of all robots together."""
    walked: set[str] = set()
    for own in files.robots.values():
        walked.update(own.learned_sets)
    fleet = [other for name, other in files.settings.fleet.sets.items() if name in walked]
    return {name: files.training("recordings", name) for name in (*files.recorded_sets, *fleet)}


@need
def named_sets(files: Files, section: Any) -> ByName:
    """Return the recordings of the training sets that a section names."""
    return {name: files.training("recordings", name) for name in section.sets}


@need
def walking_set(files: Files, _: Any) -> ByName:
    """Return the recordings of random walking from which networks learn."""
    return {"walk": files.training("recordings", "walk")}


@need
def sets_with_and_without_rte(files: Files, _: Any) -> ByName:
    """Return the first robot's recordings of random walking, with random torques and without."""
    own = next(iter(files.robots.values()))
    sets = {"with RTE": "walk", "without RTE": "walk_plain"}
    return {label: own.training("recordings", name) for label, name in sets.items()}


@need
def first_robot_tests(files: Files, _: Any) -> tuple[tuple[Path, ...], ...]:
    """Return the first robot's recordings of the tests that its training data are compared with."""
    robot, own = next(iter(files.robots.items()))
    return tuple(own.tests(test.scenario, robot) for test in files.settings.evaluation.coverage.tests)


@need
def walks_by_kind(files: Files, _: Any) -> Mapping[str, list[Path]]:
    """Return all recordings by what is walked: falls are counted by what disturbs a walk (docs/notes/measures.md)."""
    walks = defaultdict[str, list[Path]](list)
    for own in files.owners:
        for scenario, level, seed in own.recorded():
            row = files.settings.scenarios[scenario]
            kind = "with random torque" if row.random_torque else "pushed" if row.pushes else "undisturbed"
            title = f"{'surrogate robots' if own.robot else 'plant of section 5.1'}, {kind}"
            walks[title].append(own.array("recordings", scenario, level, seed))
    return dict(walks)


@need
def first_walks(files: Files, _: Any) -> Mapping[str, tuple[Path, Path]]:
    """Return the first recording of each robot from which its legs learn, with its residual."""
    walks: dict[str, tuple[Path, Path]] = {}
    for robot, own in files.whole_robots.items():
        walks[robot] = own.training("recordings", "walk")[0], own.training("residuals", "walk")[0]
    return walks


def _learned_from(files: Files) -> list[str]:
    """Return the training sets that networks learn from."""
    return list(dict.fromkeys(row.data for row in files.settings.networks.values()))


@need
def residuals_by_set(files: Files, _: Any) -> ByName:
    """Return the residuals of the training sets that networks learn from."""
    return {name: files.training("residuals", name) for name in _learned_from(files)}


@need
def residuals_by_robot(files: Files, _: Any) -> Mapping[str, ByName]:
    """Return the residuals of the training sets that networks of each robot learn from."""
    names = _learned_from(files)
    robots: dict[str, dict[str, tuple[Path, ...]]] = {}
    for robot, own in files.whole_robots.items():
        robots[robot] = {name: own.training("residuals", name) for name in own.learned_sets if name in names}
    return robots


# Networks and what they learn.
def _both_recipes(files: Files) -> tuple[Path, ...]:
    """Return the trained networks of Figure 17, those that learned by one recipe first."""
    figure = files.settings.evaluation.figure_17
    return (
        *files.network_folders(figure.methods, figure.limb, figure.level),
        *files.network_folders(figure.best, figure.limb, figure.best_level),
    )


@need
def networks_of_both_recipes(files: Files, _: Any) -> tuple[Path, ...]:
    """Return the trained networks of Figure 17."""
    return _both_recipes(files)


@need
def networks_of_all_kinds(files: Files, section: Any) -> tuple[Path, ...]:
    """Return the trained networks of Figure 17, then those of the variants that a section shows."""
    figure = files.settings.evaluation.figure_17
    return *_both_recipes(files), *files.network_folders(section.variants, figure.limb, section.level)


@need
def claimed_networks(files: Files, _: Any) -> tuple[Path, ...]:
    """Return the trainings that claims may ask about: all kinds, and all sizes, of the left leg's networks."""
    folders = [*networks_of_all_kinds(files, files.settings.evaluation.kinds)]
    for size in files.swept_sizes():
        folders += size.folders
    return tuple(dict.fromkeys(folders))


@need
def networks_by_level(files: Files, _: Any) -> ByName:
    """Return every network by the level that it learned at."""
    robots: list[Path] = []
    for own in files.robots.values():
        robots += own.all_networks()
    plant = tuple(folder for folder in files.all_networks() if folder not in robots)
    first = next(iter(files.settings.training_sets.values()))
    return {first.level: plant, files.settings.fleet.name: tuple(robots)}


@need
def first_networks(files: Files, section: Any) -> Mapping[str, Path]:
    """Return the first trained network of each limb of the method of a section."""
    method = section.method
    limbs = files.catalogue.method(method).limbs
    return {limb: files.network(method, limb, files.network_seeds(method)[0]) for limb in limbs}


@need
def printed_networks(files: Files, section: Any) -> Mapping[str, Network]:
    """Return the networks of the rows of Table 1, with the changes of the method of a section."""
    limbs = files.settings.published.table_01.rows
    return {limb: files.catalogue.network(section.method, limb) for limb in limbs}


@need
def learned_target(files: Files, section: Any) -> object:
    """Return what the networks of the method of a section learn."""
    return files.catalogue.method(section.method).target


@need
def ports(files: Files, section: Any) -> Limb:
    """Return what the network of the limb of a section sees, and what it predicts."""
    return files.settings.robot.networks[section.limb]


@need
def swept_sizes(files: Files, _: Any) -> tuple[SweptSize, ...]:
    """Return the networks of each size and of each share of the data."""
    return files.swept_sizes()


@need
def swept_values(files: Files, section: Any) -> tuple[int, ...]:
    """Return the values of the sweep of a section."""
    return files.settings.sweeps[section.sweep].values


# Detectors and reactions.
@need
def detections(files: Files, _: Any) -> Detections:
    """Return the files of detectors of every level."""
    return all_detections(files)


@need
def struck(files: Files, section: Any) -> tuple[Path, ...]:
    """Return the recordings with collisions of the robot of a section."""
    return files.robots.get(section.level, files).tests(files.settings.detection.collisions, section.level)


@need
def estimates_of_struck(files: Files, section: Any) -> ByName:
    """Return the estimates of the same recordings, by the methods of a section's detectors."""
    own = files.robots.get(section.level, files)
    test = (files.settings.detection.collisions, section.level)
    found: dict[str, tuple[Path, ...]] = {}
    for method in section.detectors:
        found[method] = tuple(run.estimate for run in own.runs(*test, [method]))
    return found


@need
def reactions(files: Files, _: Any) -> Reactions:
    """Return the files of reactions of every robot."""
    return all_reactions(files)


@need
def courses(files: Files, section: Any) -> Mapping[str, Path]:
    """Return the first walk of each case of a section."""
    return courses_of(files, section.cases)


@need
def first_courses(files: Files, section: Any) -> Reactions:
    """Return the first walk of every robot in each case of a section."""
    return courses_of_robots(files, section.cases)


@need
def courses_of_case(files: Files, section: Any) -> Mapping[str, Path]:
    """Return the first walk of the case of a section."""
    return courses_of(files, [section.case])


# What does not come from a run.
@need
def printed_tables(files: Files, section: Any) -> Mapping[str, PublishedTable]:
    """Return the tables of the paper whose numbers a section shows."""
    return {name: files.settings.published.tables[name] for name in section.paper}


@need
def kept_file(_: Files, section: Any) -> Path:
    """Return the file of the repository that a section shows."""
    return project_file(section.data)


def explore_needs(files: Files) -> dict[str, object]:
    """Return the scenes of the page by name, that of the story first, and what its detector said of the collisions."""
    evaluation = files.settings.evaluation
    story = evaluation.story
    page = evaluation.explore
    methods = (*story.methods, *page.story.further)
    runs = files.first_runs(Runs(scenario=story.scenario, level=story.level, methods=methods))
    limb = files.settings.layout.limb_of[story.joint]
    told = page.story
    pushes = _pushes(files, story.scenario)
    gate = files.settings.detection.gate.method
    first = PageScene(told.push, told.plant, runs, (limb,), story.joint, told.threshold_nm, gate, pushes, story.push)
    scenes = {"story": first}
    for name, row in page.scenes.items():
        scenes[name] = PageScene(
            row.push, row.plant, files.first_runs(row), row.limbs, row.joint, row.threshold_nm,
            row.gate or gate, _pushes(files, row.scenario), from_s=row.from_s,
        )  # fmt: skip
    found = detection_files(files.robots.get(story.level, files))
    return {
        "scenes": scenes, "story": story, "peaks": evaluation.peaks,
        "collisions": found["collisions"], "detected": found["detected"],
    }  # fmt: skip


def _pushes(files: Files, scenario: str) -> dict[str, Push]:
    """Return the pushes of a scenario by name, in their order."""
    return {name: files.settings.pushes[name] for name in files.settings.scenarios[scenario].pushes}
