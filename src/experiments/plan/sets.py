"""What jobs make on the way to tables and figures and leave in the folder of results: the manifest lists all of it."""

from collections.abc import Iterator
from pathlib import Path

from experiments.plan.detection import detection_files, level_of_detectors
from experiments.plan.files import ARRAY, NOTE, Files, made_by_jobs
from experiments.plan.reactions import course_file, is_pushed, reaction_file, watch_file


def sets_left(files: Files) -> list[str]:
    """Return files and folders, as the rules that make them name them, without scores, which products read."""
    paths: list[Path] = []
    for owner in files.owners:
        paths += recordings_of(owner)
        paths += networks_of(owner)
        if level_of_detectors(owner):
            paths += reactions_of(owner)
    return made_by_jobs(paths)


def recordings_of(files: Files) -> Iterator[Path]:
    """Yield the recordings of a robot or of the plant, the motions that they take, and what is computed from them."""
    learned = [files.settings.training_sets[name] for name in files.learned_sets]
    learned_from = {(row.scenario, row.level) for row in learned}
    tests = files.catalogue.tests
    for scenario, level, seed in files.recorded():
        yield files.array("recordings", scenario, level, seed)
        for motion in files.motion(scenario, seed):
            yield motion.with_suffix(ARRAY)
            yield motion.with_suffix(NOTE)
        is_test = level in tests.get(scenario, ())
        if is_test or (scenario, level) in learned_from:
            yield files.array("residuals", scenario, level, seed)
        if is_test:
            method = next(iter(tests[scenario][level]))
            yield files.estimate(scenario, level, method, 0, seed)  # the set holds those of all methods


def networks_of(files: Files) -> Iterator[Path]:
    """Yield the trained networks of a robot or of the plant, and what methods are fitted to."""
    methods = dict.fromkeys(name.method for name in files.own_networks)
    for levels in files.catalogue.tests.values():
        for level in filter(files.has, levels):
            methods |= dict.fromkeys(levels[level])
    for name in files.own_networks:
        yield files.network(*name)
    for method in methods:
        yield from files.fit(method)


def reactions_of(files: Files) -> Iterator[Path]:
    """Yield what detectors find on a robot, its thresholds, and its walks into obstacles."""
    yield from detection_files(files).values()
    yield watch_file(files)
    for case in files.settings.reaction.cases:
        yield reaction_file(files, case)
        if is_pushed(files, case):
            yield course_file(files, case).with_suffix(ARRAY)
            yield course_file(files, case).with_suffix(NOTE)
