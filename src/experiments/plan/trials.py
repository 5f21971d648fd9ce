"""The trials: products that are no part of `all`. They take hours, so docs/trials holds a copy of their tables."""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from experiments.plan.files import Files, made_by_jobs
from experiments.plan.items import trials as made_by
from experiments.plan.jobs import KINDS, scoring
from experiments.plan.product import TABLE, Call, Product
from experiments.plan.runs import ExplainedRobot, TaughtRobot, Tried, TriedTask
from experiments.settings.settings import Settings
from experiments.settings.trials import (
    WAY,
    MethodVariant,
    compared,
    explained,
    factors_of,
    references,
    sets_of,
    taught,
    tuned,
)


def trial_products(files: Files) -> Iterator[Product]:
    """Yield the tables of what was tried: `tuning`, what is compared, `random_torque` and `factorial`."""
    settings = files.settings
    given = settings.trials, settings.methods
    first = settings.trials.tuning.task
    tables = {"tuning": [*references(*given, first), *tuned(*given, settings.development)]}
    for name in settings.trials.compared:
        trials = list(compared(*given, settings.development, name))
        tasks = dict.fromkeys(trial.task for trial in trials)
        # What is tried is judged beside methods of the same task that nothing changes.
        tables[name] = []
        for task in tasks:
            tables[name] += references(*given, task)
        tables[name] += trials
    for name, trials in tables.items():
        yield _product(files, files.shared / "trials" / name, trials)
    counted = tuple(robot.falls for robot in files.whole_robots.values())
    out = files.shared / "trials" / "random_torque"
    arguments = {"counted": counted, "statistics": settings.evaluation.statistics, "out": out}
    call = Call(made_by.falls, arguments)
    yield _table(out, call, made_by_jobs(counted))
    yield _factorial(files, files.shared / "trials" / "factorial")
    yield _why(files, files.shared / "trials" / "why")


def _factorial(files: Files, out: Path) -> Product:
    """Return the table of what the walks of training sets teach, on some robots of the fleet, or else on all."""
    settings = files.settings
    trial = settings.trials.factorial
    wanted = {name: files_of_robot for name, files_of_robot in files.robots.items() if name in trial.robots}
    robots = {name: _taught(files_of_robot) for name, files_of_robot in (wanted or files.robots).items()}
    cells = {name: factors_of(settings.training_sets, settings.scenarios, name) for name in sets_of(trial)}
    arguments = {
        **_known(settings),
        "settings": trial,
        "robots": robots,
        "cells": cells,
        "torque_nm": settings.random_torque.legs_waist_nm,
        "peaks": settings.evaluation.peaks,
        "statistics": settings.evaluation.statistics,
        "out": out,
    }
    kinds = _kinds(robot.walk for robot in robots.values())
    call = Call(made_by.factorial, arguments)
    return _table(out, call, made_by_jobs(robots), kinds)


def _taught(files: Files) -> TaughtRobot:
    """Return what is tried on a robot, and the walks on which it is judged."""
    settings = files.settings
    trial = settings.trials.factorial
    beside = [MethodVariant(name, name, {}, settings.methods[name], "") for name in trial.references]
    tried: list[Tried] = []
    for variant in (*taught(settings.trials, settings.methods), *beside):
        tried += _tried(files, variant)
    return _judged_on(files, trial.limb, files.robot, (trial.walk, trial.hits), trial.as_in, tried)


def _why(files: Files, out: Path) -> Product:
    """Return the table of why a hit is hidden, on the robots of the trial; at a scale that has none of them, on all."""
    settings = files.settings
    trial = settings.trials.why
    asked: list[ExplainedRobot] = []
    for name, files_of_robot in files.robots.items():
        sets: dict[str, None] = {}
        # A small scale has few robots; rows of others would leave the table without these lines.
        for row in trial.rows:
            if name in row.robots or not set(row.robots) & set(files.robots):
                sets |= dict.fromkeys(row.sets)
        asked += [_explained(files_of_robot, name, data) for data in sets]
    arguments = {
        **_known(settings),
        "settings": trial,
        "robots": tuple(asked),
        "peaks": settings.evaluation.peaks,
        "statistics": settings.evaluation.statistics,
        "out": out,
    }
    kinds = _kinds(explained_robot.taught.walk for explained_robot in asked)
    call = Call(made_by.why, arguments)
    return _table(out, call, made_by_jobs(tuple(asked)), kinds)


def _explained(files: Files, robot: str, data: str) -> ExplainedRobot:
    """Return what is tried on a robot as the walks of a training set have it."""
    settings = files.settings
    trial = settings.trials.why
    beside = [MethodVariant(name, name, {}, settings.methods[name], "") for name in trial.references]
    tried: list[Tried] = []
    for variant in (*explained(settings.trials, settings.methods, robot, data), *beside):
        tried += _tried(files, variant)
    level = settings.training_sets[data].level
    taught_robot = _judged_on(files, trial.limb, level, (trial.walk, trial.hits), trial.as_in, tried)
    if data != trial.path_set or robot not in trial.path_robots:
        return ExplainedRobot(robot, data, taught_robot, (), ())
    twins = tuple(files.array("recordings", trial.twin, level, seed) for seed in files.development_seeds)
    # What inputs bring in is asked of networks that learned in the first way alone: the others only differ in size.
    ways = next(iter(trial.ways))
    paths = [each for each in tried if each.base in trial.paths and each.changes.get(WAY) == ways]
    return ExplainedRobot(robot, data, taught_robot, twins, tuple(paths))


def _judged_on(
    files: Files, limb: str, level: str, walks: tuple[str, str], as_in: str, tried: Sequence[Tried]
) -> TaughtRobot:
    """Return variants with the walks of a robot at a level on which they are judged: one, and one with hits."""
    settings = files.settings
    joints = tuple(settings.layout.limbs(settings.robot.networks[limb].joints))
    tasks: list[TriedTask] = []
    for scenario in walks:
        recordings = tuple(files.array("recordings", scenario, level, seed) for seed in files.development_seeds)
        residuals = tuple(files.array("residuals", scenario, level, seed) for seed in files.development_seeds)
        tasks.append(TriedTask(settings.levels[level], joints, tuple(tried), recordings, residuals))
    walk, hits = tasks
    asked = scoring(settings, walks[1], files.robot)
    window = settings.evaluation.windows[as_in]
    return TaughtRobot(walk, hits, asked.model_copy(update={"window": window}))


def _product(files: Files, out: Path, trials: Sequence[MethodVariant]) -> Product:
    """Return the table of some trials, which runs all their networks on the walks of their tasks."""
    settings = files.settings
    by_task = defaultdict[str, list[MethodVariant]](list)
    for trial in trials:
        by_task[trial.task].append(trial)
    tasks = {name: _task(files, name, of_task) for name, of_task in by_task.items()}
    arguments = {
        **_known(settings),
        "tasks": tasks,
        "out": out,
    }
    kinds = _kinds(tasks.values())
    call = Call(made_by.trials, arguments)
    return _table(out, call, made_by_jobs(tasks), kinds)


def _known(settings: Settings) -> dict[str, object]:
    """Return what every table of trials is told to run estimators on walks."""
    return {
        "robot": settings.robot,
        "gravity_m_s2": settings.plant.gravity_m_s2,
        "observer": settings.observer,
        "rate_hz": settings.rates.data_hz,
    }


def _kinds(tasks: Iterable[TriedTask]) -> dict[str, None]:
    """Return the modules of the estimators that are tried, each once."""
    modules: dict[str, None] = {}
    for task in tasks:
        for tried in task.tried:
            modules |= dict.fromkeys(f"{KINDS}.{row.kind}" for row in tried.methods.values())
    return modules


def _table(out: Path, call: Call, inputs: Iterable[str], modules: Iterable[str] = ()) -> Product:
    """Return the product of a call that writes a table."""
    return Product(out.name, call, tuple(inputs), tuple(f"{out}.{ending}" for ending in TABLE), tuple(modules))


def _task(files: Files, name: str, trials: Iterable[MethodVariant]) -> TriedTask:
    """Return what is tried at a task, with all networks and walks of its plant."""
    task = files.settings.development[name]
    owner_of_level = next(owner for owner in files.owners if owner.has(task.level))
    tried: list[Tried] = []
    for trial in trials:
        tried += _tried(owner_of_level, trial)
    walks = owner_of_level.development("recordings", name), owner_of_level.development("residuals", name)
    joints = tuple(owner_of_level.settings.layout.limbs(owner_of_level.settings.robot.networks[task.limb].joints))
    return TriedTask(owner_of_level.settings.levels[task.level], joints, tuple(tried), *walks)


def _tried(files: Files, trial: MethodVariant) -> Iterator[Tried]:
    """Yield a trial with each of its networks, or without any."""
    source = files.catalogue.source_of(trial.name)
    methods = {source: files.catalogue.method(source), trial.name: trial.method}
    for seed in files.network_seeds(trial.name):
        networks = {limb: files.network(trial.name, limb, seed) for limb in trial.method.limbs}
        fitted = next(iter(files.fit(trial.name)), None)
        yield Tried(trial.base, trial.name, dict(trial.changes), methods, networks, fitted, seed)
