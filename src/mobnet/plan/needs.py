"""What each table and figure is made from: scores, runs, recordings or trainings."""

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from mobnet.core.errors import ConfigError
from mobnet.plan.detection import all_detections
from mobnet.plan.runs import Files
from mobnet.settings.asked import tests_in
from mobnet.settings.evaluation import Runs

Needs = Mapping[str, object]


def needs_of(files: Files, name: str, section: Any, parameters: Iterable[str]) -> Needs:
    """Return what a product is made from: its own entry of `NEEDS`, or what its function's parameters usually mean.

    Raises:
        ConfigError: a parameter has its usual meaning, and the section lacks what this needs.
    """
    if name in NEEDS:
        return NEEDS[name](files)
    try:
        return {parameter: USUAL[parameter](files, section) for parameter in parameters if parameter in USUAL}
    except AttributeError as error:
        raise ConfigError(f"{name}: its section lacks what a function of it asks for: {error}") from None


def _scores(files: Files, section: Any) -> tuple[Path, ...]:
    """Return the scores of the tests that a section, or a tuple of them, names, at the levels that it names."""
    return files.scores(tests_in(files.settings, section))


def _folders(files: Files, section: Any) -> tuple[Path, ...]:
    """Return the trained networks of a section's methods and limb."""
    return files.network_folders(section.methods, section.limb, section.level)


def _sets(files: Files, section: Any) -> Mapping[str, tuple[Path, ...]]:
    """Return the recordings of every training set that is recorded, those of all robots together."""
    walked = {name for own in files.robots.values() for name in own.learned_sets}
    fleet = [other for name, other in files.settings.fleet.sets.items() if name in walked]
    return {name: files.training("recordings", name) for name in (*files.recorded_sets, *fleet)}


def _steps(files: Files) -> Needs:
    """Return the recordings of random walking."""
    return {"sets": {"walk": files.training("recordings", "walk")}}


def _uncertainty(files: Files) -> Needs:
    """Return the residuals of the training sets that networks learn from."""
    names = dict.fromkeys(row.data for row in files.settings.networks.values())
    robots = {
        robot: {name: own.training("residuals", name) for name in own.learned_sets if name in names}
        for robot, own in files.robots.items()
    }
    return {"sets": {name: files.training("residuals", name) for name in names}, "robots": robots}


def _coverage(files: Files) -> Needs:
    """Return the first robot's training sets with and without random torque, its tests, and what the network sees."""
    sets = {"with RTE": "walk", "without RTE": "walk_plain"}
    settings, (robot, own) = files.settings.evaluation.coverage, next(iter(files.robots.items()))
    return {
        "training": {label: own.training("recordings", name) for label, name in sets.items()},
        "tests": tuple(own.tests(test.scenario, robot) for test in settings.tests),
        "ports": files.settings.robot.networks[settings.limb],
    }


def _amplitude(files: Files) -> Needs:
    """Return the scores, and of each method the largest random torque [N m] in its training data, and these data."""
    settings, section = files.settings, files.settings.evaluation.amplitude
    amplitudes, training = dict[str, float](), dict[str, tuple[Path, ...]]()
    for test in section.tests.values():
        for method in test.methods:
            data = files.catalogue.network(method, test.limb).data
            own = files.robots.get(test.level, files)
            scenario = own.settings.training_sets[data].scenario
            asked = settings.scenarios[scenario].random_torque
            amplitudes[method] = settings.random_torque_of(scenario).legs_waist_nm if asked else 0.0
            training[method] = own.training("recordings", data)
    return {"scores": _scores(files, section), "amplitudes": amplitudes, "training": training}


def _fine_tuning(files: Files) -> Needs:
    """Return the scores, and the seconds of new data of the sweep."""
    section = files.settings.evaluation.fine_tuning
    return {"scores": _scores(files, section), "seconds": files.settings.sweeps[section.sweep].values}


def _kinds(files: Files) -> Needs:
    """Return the trained networks of Figure 17 and of its variants."""
    return {"folders": _folders_of_kinds(files), "figure_17": files.settings.evaluation.figure_17}


def _folders_of_kinds(files: Files) -> tuple[Path, ...]:
    """Return the trained networks of Figure 17, then those of its variants."""
    figure, table = files.settings.evaluation.figure_17, files.settings.evaluation.kinds
    return (
        *files.network_folders(figure.methods, figure.limb, figure.level),
        *files.network_folders(table.variants, figure.limb, table.level),
    )


def _claims(files: Files) -> Needs:
    """Return the scores that claims name, and the trainings of the kinds and sizes of the left leg's networks."""
    sizes = [folder for size in files.swept_sizes() for folder in size.folders]
    folders = tuple(dict.fromkeys([*_folders_of_kinds(files), *sizes]))
    return {"scores": _scores(files, files.settings.claims), "folders": folders}


def _latency(files: Files) -> Needs:
    """Return the first trained network of each limb of the method whose time is looked at."""
    method = files.settings.evaluation.latency.method
    first = files.network_seeds(method)[0]
    return {"networks": {limb: files.network(method, limb, first) for limb in files.catalogue.method(method).limbs}}


def _table_01(files: Files) -> Needs:
    """Return the networks of the method of Table 1, with its changes, and what they learn."""
    method = files.settings.evaluation.table_01.method
    limbs = files.settings.published.table_01.rows
    networks = {limb: files.catalogue.network(method, limb) for limb in limbs}
    return {"networks": networks, "target": files.catalogue.method(method).target}


def _calibration(files: Files) -> Needs:
    """Return every network by the level that it learned at, and the runs of each test of the standard deviations."""
    tests, fleet = files.settings.evaluation.calibration.tests, files.settings.fleet.name
    robots = tuple(folder for own in files.robots.values() for folder in own.all_networks())
    plant = tuple(folder for folder in files.all_networks() if folder not in robots)
    return {
        "folders": {files.settings.development.level: plant, fleet: robots},
        "runs": tuple(files.runs(test.scenario, test.level, test.methods) for test in tests),
    }


def _noise(files: Files) -> Needs:
    """Return the scores of the readings of Table 3, and the paper's tables that they stand beside."""
    settings, printed = files.settings.evaluation.noise, files.settings.published.tables
    return {"scores": _scores(files, settings), "printed": {name: printed[name] for name in settings.paper}}


def _figure_05(files: Files) -> Needs:
    """Return the first runs at each level of Figure 5."""
    figure = files.settings.evaluation.figure_05
    panels = [Runs(scenario=figure.scenario, level=level, methods=names) for level, names in figure.panels.items()]
    return {"runs": tuple(run for panel in panels for run in files.first_runs(panel))}


def _figure_10(files: Files) -> Needs:
    """Return the first runs of each panel and the scores of Figure 10."""
    figure = files.settings.evaluation.figure_10
    runs = {title: files.first_runs(test) for title, test in figure.tests.items()}
    return {"runs": runs, "scores": _scores(files, figure)}


def _figure_13(files: Files) -> Needs:
    """Return the detections, and the recordings with collisions of the robot of Figures 13 and 15."""
    figure, scenario = files.settings.evaluation.figure_13, files.settings.detection.collisions
    own = files.robots.get(figure.level, files)
    return {"detections": all_detections(files), "recordings": own.tests(scenario, figure.level)}


def _figure_15(files: Files) -> Needs:
    """Return what Figure 13 takes, and the estimates of the methods of Figure 15."""
    figure, scenario = files.settings.evaluation.figure_15, files.settings.detection.collisions
    own = files.robots.get(figure.level, files)
    estimates = {
        method: tuple(run.estimate for run in own.runs(scenario, figure.level, [method])) for method in figure.detectors
    }
    return {**_figure_13(files), "recordings": own.tests(scenario, figure.level), "estimates": estimates}


USUAL: Mapping[str, Callable[[Files, Any], object]] = {  # parameter -> what it gets
    "scores": _scores,
    "runs": Files.first_runs,
    "folders": _folders,
    "sets": _sets,
    "detections": lambda files, _: all_detections(files),
}
NEEDS: Mapping[str, Callable[[Files], Needs]] = {  # products that need something else
    "table_01": _table_01,
    "claims": _claims,
    "latency": _latency,
    "steps": _steps,
    "coverage": _coverage,
    "uncertainty": _uncertainty,
    "kinds": _kinds,
    "calibration": _calibration,
    "amplitude": _amplitude,
    "fine_tuning": _fine_tuning,
    "noise": _noise,
    "figure_05": _figure_05,
    "figure_10": _figure_10,
    "figure_13": _figure_13,
    "figure_15": _figure_15,
    "figure_19": _coverage,
    "figure_20": lambda files: {"sizes_of_networks": files.swept_sizes()},
    "learning_curve": lambda files: {"kept": Path(files.settings.evaluation.learning_curve.data)},
}
