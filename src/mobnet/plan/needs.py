"""What each table and figure is made from: scores, runs, recordings or trainings."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path

from mobnet.plan.runs import Files
from mobnet.settings.evaluation import Runs

Needs = Mapping[str, object]


def _scores(files: Files, scenarios: Iterable[str]) -> Needs:
    """Return the scores of some tests, each once."""
    return {"scores": files.scores(dict.fromkeys(scenarios))}


def _recordings(files: Files, *names: str) -> Needs:
    """Return the recordings of training sets."""
    return {"sets": {name: files.training("recordings", name) for name in names}}


def _residuals(files: Files, *names: str) -> Needs:
    """Return the residuals of training sets."""
    return {"sets": {name: files.training("residuals", name) for name in dict.fromkeys(names)}}


def _coverage(files: Files) -> Needs:
    """Return the training sets with and without random torque exploration, and the tests compared with them."""
    sets = {"with RTE": "walk", "without RTE": "walk_plain"}
    tests = files.settings.evaluation.coverage.tests
    return {
        "training": {label: files.training("recordings", name) for label, name in sets.items()},
        "tests": tuple(files.tests(test.scenario, test.level) for test in tests),
    }


def _kinds(files: Files) -> tuple[Path, ...]:
    """Return the trained networks of Figure 17."""
    figure = files.settings.evaluation.figure_17
    return files.network_folders(figure.methods, figure.limb)


def _kinds_and_variants(files: Files) -> tuple[Path, ...]:
    """Return the trained networks of Figure 17 and of its variants."""
    figure, variants = files.settings.evaluation.figure_17, files.settings.evaluation.kinds.variants
    return files.network_folders((*figure.methods, *variants), figure.limb)


def _claims(files: Files) -> Needs:
    """Return the scores of every test, and the trainings of the kinds and sizes of the left leg's networks."""
    sizes = [folder for size in files.swept_sizes() for folder in size.folders]
    return {**_scores(files, files.settings.tests), "folders": tuple(dict.fromkeys([*_kinds(files), *sizes]))}


def _calibration(files: Files) -> Needs:
    """Return every network, and the runs of each test of the standard deviations."""
    tests = files.settings.evaluation.calibration.tests
    return {
        "folders": files.all_networks(),
        "runs": tuple(files.runs(test.scenario, test.level, test.methods) for test in tests),
    }


def _figure_05(files: Files) -> Needs:
    """Return the first runs at each level of Figure 5."""
    figure = files.settings.evaluation.figure_05
    panels = [Runs(scenario=figure.scenario, level=level, methods=names) for level, names in figure.panels.items()]
    return {"runs": tuple(run for panel in panels for run in files.first_runs(panel))}


def _figure_06(files: Files) -> Needs:
    """Return the first runs and the scores of Figure 6."""
    figure = files.settings.evaluation.figure_06
    return {"runs": files.first_runs(figure), **_scores(files, [figure.scenario])}


def _figure_10(files: Files) -> Needs:
    """Return the first runs of each panel and the scores of Figure 10."""
    figure = files.settings.evaluation.figure_10
    tests = (*figure.tests.values(), figure.against)
    runs = {title: files.first_runs(test) for title, test in figure.tests.items()}
    return {"runs": runs, **_scores(files, [test.scenario for test in tests])}


NEEDS: Mapping[str, Callable[[Files], Needs]] = {
    "table_01": lambda files: {},
    "claims": _claims,
    "data": lambda files: _recordings(files, *files.settings.training_sets),
    "commands": lambda files: _recordings(files, *files.settings.training_sets),
    "steps": lambda files: _recordings(files, "walk"),
    "coverage": _coverage,
    "uncertainty": lambda files: _residuals(files, *(row.data for row in files.settings.networks.values())),
    "kinds": lambda files: {"folders": _kinds_and_variants(files)},
    "methods": lambda files: _scores(files, [row.scenario for row in files.settings.evaluation.methods]),
    "calibration": _calibration,
    "error_budget": lambda files: _scores(
        files, [row.scenario for row in files.settings.evaluation.error_budget.tests]
    ),
    "figure_05": _figure_05,
    "figure_06": _figure_06,
    "figure_07": lambda files: {"runs": files.first_runs(files.settings.evaluation.figure_07)},
    "figure_08": lambda files: {"runs": files.first_runs(files.settings.evaluation.figure_08)},
    "figure_09": lambda files: {"runs": files.first_runs(files.settings.evaluation.figure_09)},
    "figure_10": _figure_10,
    "figure_17": lambda files: {"folders": _kinds(files)},
    "figure_18": lambda files: _scores(files, files.settings.evaluation.figure_18.panels),
    "figure_19": _coverage,
    "figure_20": lambda files: {"sizes_of_networks": files.swept_sizes()},
}
