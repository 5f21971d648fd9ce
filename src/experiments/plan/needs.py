"""What each table and figure is made from: scores, runs, recordings or trainings.

A parameter of a product's function says by its name what it gets (`USUAL`), where the product has no need of its own.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from experiments.plan.detection import all_detections
from experiments.plan.files import Files
from experiments.plan.reactions import all_reactions, courses_of
from experiments.plan.runs import Run
from experiments.settings.asked import tests_in
from experiments.settings.runs import Runs
from mobnet.core.errors import ConfigError

Needs = Mapping[str, object]


def needs_of(files: Files, name: str, section: Any, parameters: Iterable[str]) -> Needs:
    """Return what a product is made from, by parameter: its own entry of `NEEDS`, and what others usually mean.

    Raises:
        ConfigError: a parameter has its usual meaning, and the section lacks what this needs.
    """
    own: Needs = NEEDS[name](files, section) if name in NEEDS else {}
    usual = [parameter for parameter in parameters if parameter in USUAL and parameter not in own]
    try:
        return {**{parameter: USUAL[parameter](files, section) for parameter in usual}, **own}
    except AttributeError as error:
        raise ConfigError(f"{name}: its section lacks what a function of it asks for: {error}") from None


def _scores(files: Files, section: Any) -> tuple[Path, ...]:
    """Return the scores of the tests that a section, or a tuple of them, names, at the levels that it names."""
    return files.scores(tests_in(files.settings, section))


def _sets(files: Files, _: Any) -> Mapping[str, tuple[Path, ...]]:
    """Return the recordings of every training set that is recorded, those of all robots together."""
    walked: set[str] = set()
    for own in files.robots.values():
        walked.update(own.learned_sets)
    fleet = [other for name, other in files.settings.fleet.sets.items() if name in walked]
    return {name: files.training("recordings", name) for name in (*files.recorded_sets, *fleet)}


def _struck(files: Files, section: Any) -> tuple[Path, ...]:
    """Return the recordings with collisions of the robot of a section."""
    return files.robots.get(section.level, files).tests(files.settings.detection.collisions, section.level)


def _estimates(files: Files, section: Any) -> Mapping[str, tuple[Path, ...]]:
    """Return the estimates of the same recordings, by the methods of a section's detectors."""
    own = files.robots.get(section.level, files)
    test = (files.settings.detection.collisions, section.level)
    found: dict[str, tuple[Path, ...]] = {}
    for method in section.detectors:
        found[method] = tuple(run.estimate for run in own.runs(*test, [method]))
    return found


def _uncertainty(files: Files, _: Any) -> Needs:
    """Return the residuals of the training sets that networks learn from."""
    names = dict.fromkeys(row.data for row in files.settings.networks.values())
    robots: dict[str, dict[str, tuple[Path, ...]]] = {}
    for robot, own in files.robots.items():
        robots[robot] = {name: own.training("residuals", name) for name in own.learned_sets if name in names}
    return {"sets": {name: files.training("residuals", name) for name in names}, "robots": robots}


def _label_error(files: Files, _: Any) -> Needs:
    """Return the first recording of each robot from which its legs learn, with its residual."""
    walks: dict[str, tuple[Path, Path]] = {}
    for robot, own in files.robots.items():
        walks[robot] = own.training("recordings", "walk")[0], own.training("residuals", "walk")[0]
    return {"walks": walks}


def _coverage(files: Files, _: Any) -> Needs:
    """Return the first robot's training sets with random torques and without, its tests, and what the network sees."""
    sets = {"with RTE": "walk", "without RTE": "walk_plain"}
    settings = files.settings.evaluation.coverage
    (robot, own) = next(iter(files.robots.items()))
    return {
        "training": {label: own.training("recordings", name) for label, name in sets.items()},
        "tests": tuple(own.tests(test.scenario, robot) for test in settings.tests),
        "ports": files.settings.robot.networks[settings.limb],
    }


def _folders_of_figure_17(files: Files) -> tuple[Path, ...]:
    """Return the trained networks of Figure 17, those that learned by one recipe first."""
    figure = files.settings.evaluation.figure_17
    return (
        *files.network_folders(figure.methods, figure.limb, figure.level),
        *files.network_folders(figure.best, figure.limb, figure.best_level),
    )


def _folders_of_kinds(files: Files) -> tuple[Path, ...]:
    """Return the trained networks of Figure 17, then those of the variants that the table of kinds shows."""
    figure = files.settings.evaluation.figure_17
    table = files.settings.evaluation.kinds
    return *_folders_of_figure_17(files), *files.network_folders(table.variants, figure.limb, table.level)


def _claims(files: Files, _: Any) -> Needs:
    """Return the scores that claims name, and the trainings of the kinds and sizes of the left leg's networks."""
    folders = [*_folders_of_kinds(files)]
    for size in files.swept_sizes():
        folders += size.folders
    return {"scores": _scores(files, files.settings.claims), "folders": tuple(dict.fromkeys(folders))}


def _hourly(files: Files, section: Any) -> Needs:
    """Return all recordings by what is walked, and the scores of the tests in which the check should flag nothing."""
    # Falls are counted by what disturbs a walk (note 0042).
    walks = defaultdict[str, list[Path]](list)
    for own in files.owners:
        for scenario, level, seed in own.recorded():
            row = files.settings.scenarios[scenario]
            kind = "with random torque" if row.random_torque else "pushed" if row.pushes else "undisturbed"
            title = f"{'surrogate robots' if own.robot else 'plant of section 5.1'}, {kind}"
            walks[title].append(own.array("recordings", scenario, level, seed))
    changed = files.settings.evaluation.changed
    known = tuple(changed.tests[title] for title in section.known)
    return {"walks": dict(walks), "changed": changed, "scores": _scores(files, known)}


def _latency(files: Files, section: Any) -> Needs:
    """Return the first trained network of each limb of the method whose time is looked at."""
    method = section.method
    limbs = files.catalogue.method(section.method).limbs
    return {"networks": {limb: files.network(method, limb, files.network_seeds(method)[0]) for limb in limbs}}


def _table_01(files: Files, section: Any) -> Needs:
    """Return the networks of the method of Table 1, with its changes, and what they learn."""
    limbs = files.settings.published.table_01.rows
    networks = {limb: files.catalogue.network(section.method, limb) for limb in limbs}
    return {"networks": networks, "target": files.catalogue.method(section.method).target}


def _calibration(files: Files, section: Any) -> Needs:
    """Return every network by the level that it learned at, and the runs of each test of the standard deviations."""
    robots: list[Path] = []
    for own in files.robots.values():
        robots += own.all_networks()
    plant = tuple(folder for folder in files.all_networks() if folder not in robots)
    first = next(iter(files.settings.training_sets.values()))
    return {
        "folders": {first.level: plant, files.settings.fleet.name: tuple(robots)},
        "runs": tuple(files.runs(test.scenario, test.level, test.methods) for test in section.tests),
    }


def _contact_points(files: Files, section: Any) -> Needs:
    """Return all runs of a section, and the pushes of its test."""
    settings = files.settings
    pushes = {name: settings.pushes[name] for name in settings.scenarios[section.scenario].pushes}
    return {"runs": files.runs(section.scenario, section.level, section.methods), "pushes": pushes}


def _figure_05(files: Files, section: Any) -> Needs:
    """Return the first runs at each level of Figure 5."""
    runs: list[Run] = []
    for level, methods in section.panels.items():
        runs += files.first_runs(Runs(scenario=section.scenario, level=level, methods=methods))
    return {"runs": tuple(runs)}


USUAL: Mapping[str, Callable[[Files, Any], object]] = {  # parameter -> what it gets
    "scores": _scores,
    "runs": Files.first_runs,
    "folders": lambda files, section: files.network_folders(section.methods, section.limb, section.level),
    "sets": _sets,
    "detections": lambda files, _: all_detections(files),
    "reactions": lambda files, _: all_reactions(files),
    "courses": lambda files, section: courses_of(files, section.cases),
    "recordings": _struck,
    "estimates": _estimates,
    "printed": lambda files, section: {name: files.settings.published.tables[name] for name in section.paper},
    "seconds": lambda files, section: files.settings.sweeps[section.sweep].values,
    "sizes_of_networks": lambda files, _: files.swept_sizes(),
    "kept": lambda _, section: Path(section.data),
}
NEEDS: Mapping[str, Callable[[Files, Any], Needs]] = {  # products in which parameters mean something else
    "table_01": _table_01,
    "claims": _claims,
    "hourly": _hourly,
    "latency": _latency,
    "commands": lambda files, own: {"sets": {name: files.training("recordings", name) for name in own.sets}},
    "steps": lambda files, _: {"sets": {"walk": files.training("recordings", "walk")}},
    "contact_points": _contact_points,
    "coverage": _coverage,
    "uncertainty": _uncertainty,
    "label_error": _label_error,
    "figure_17": lambda files, _: {"folders": _folders_of_figure_17(files)},
    "kinds": lambda files, _: {"folders": _folders_of_kinds(files), "figure_17": files.settings.evaluation.figure_17},
    "calibration": _calibration,
    "safety": lambda files, _: {"published": files.settings.published.section_5_4},
    "figure_16": lambda files, _: {"published": files.settings.published.section_5_4},
    "figure_21": lambda files, own: {"courses": courses_of(files, [own.case])},
    "figure_05": _figure_05,
    "figure_10": lambda files, own: {"runs": {title: files.first_runs(test) for title, test in own.tests.items()}},
    "figure_19": _coverage,
}
