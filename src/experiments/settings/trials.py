"""Trials: variants of methods that no table shows. They are judged on development walks, and methods are chosen so."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from typing import Annotated, Any, NamedTuple

from pydantic import Field

from mobnet.formats import base
from mobnet.formats.base import Section
from mobnet.settings.data import Development, Scenario, TrainingSet
from mobnet.settings.methods import Method

Value = bool | int | float | str
EXPERIMENT, RECIPE = "experiment", "recipe"  # what a comparison changes
DATA, WAY = "data", "way"  # what the factorial changes, and the trial `why`


class Grid(Section):
    """Keys of a method's `learning` and `options`, each with values; all combinations are tried."""

    learning: dict[str, base.Distinct[Value]] = {}
    options: dict[str, base.Distinct[Value]] = {}


class Tuning(Section):
    """What is tried for each method, all of them in trainings of one length, and methods beside which they stand."""

    task: base.TaskName
    recipe: base.RecipeName
    references: base.MethodNames
    experiment: base.ExperimentName
    grids: dict[base.MethodName, Grid]


class Comparison(Section):
    """Methods whose networks learn a task by each of some recipes, for each of some lengths."""

    task: base.TaskName
    methods: base.Distinct[base.LearnedName]
    recipes: base.Distinct[base.RecipeName]
    experiments: base.Distinct[base.ExperimentName]


class Explored(Section):
    """How each robot of the fleet walks while its falls are counted: with each largest random torque on legs and waist.

    The first robot's walks have the seed `first_seed`, between those of development and of training; the next robot's
    have the next one.
    """

    scenario: base.ScenarioName
    amplitudes_nm: base.Rising[Annotated[base.Positive, Field(le=1000)]]
    walked_s: base.Real = Field(ge=1, le=7200)
    first_seed: base.Whole = Field(ge=601, le=900)


class Factorial(Section):
    """What walks teach: networks of a limb that learn from each of the `cells`, training sets of equal size.

    The scenarios of the cells differ in random torque, pushes and commands, and have every combination of them. The set
    `another_day` has the scenario of `same_day`, one of the cells. Each robot walks `walk`, where errors are means over
    the limb's joints, and `hits`, where they are those of a `joint` in the time around pushes that test `as_in` has.
    `references` stand beside, and the method `fitted`, which is fitted to the set `same_day`.
    """

    robots: base.Distinct[base.SurrogateLevelName]
    limb: base.NetworkName
    method: base.LearnedName
    experiment: base.ExperimentName
    cells: base.Distinct[base.TrainingSetName]
    same_day: base.TrainingSetName
    another_day: base.TrainingSetName
    references: base.MethodNames
    fitted: base.MethodName
    walk: base.ScenarioName
    hits: base.PushedName
    as_in: base.PushedTestName
    joint: base.JointName


class Way(Section):
    """How networks learn: keys of their sections `network` and `learning` over those of a method."""

    network: base.Change = {}
    learning: base.Change = {}


class WhyRow(Section):
    """Methods whose networks learn from each of some training sets, in each of some ways, on each of some robots.

    A set is named as on the plant, and is that of the robot; the robot is judged at the level of the set.
    """

    robots: base.Distinct[base.SurrogateLevelName]
    sets: base.Distinct[base.TrainingSetName]
    methods: base.Distinct[base.LearnedName]
    ways: base.Distinct[base.LowerName]
    experiment: base.ExperimentName


class Why(Section):
    """Why a hit is hidden: networks of a limb that differ in inputs, robot and learning.

    Each robot walks `walk`, where errors are means over the limb's joints, `hits`, where they are those of a `joint` in
    the time around pushes that test `as_in` has, and `twin`, the same walks without the hits. Which input carries a hit
    is asked of the methods `paths` that learn from the set `path_set`, on the `path_robots`.
    """

    limb: base.NetworkName
    ways: dict[base.LowerName, Way]
    rows: base.Some[WhyRow]
    references: base.MethodNames
    walk: base.ScenarioName
    hits: base.PushedName
    twin: base.PushedName
    as_in: base.PushedTestName
    joint: base.JointName
    paths: base.Distinct[base.LearnedName]
    path_set: base.TrainingSetName
    path_robots: base.Distinct[base.SurrogateLevelName]


class Trials(Section):
    """The trials: recipes (keys of `learning` over those of a method), comparisons, random torques, factorial, why."""

    recipes: dict[str, base.Change]
    tuning: Tuning
    compared: dict[base.LowerName, tuple[Comparison, ...]]
    random_torque: Explored
    factorial: Factorial
    why: Why


class MethodVariant(NamedTuple):
    """A variant of the method `base` at a task: its name, the keys that it changes with their values, the method."""

    base: str
    name: str
    changes: Mapping[str, Value]
    method: Method
    task: str


class Factors(NamedTuple):
    """What the walks of a training set have: random torque, pushes, and commands of a kind."""

    random_torque: bool
    pushes: bool
    commands: str


def factors_of(sets: Mapping[str, TrainingSet], scenarios: Mapping[str, Scenario], name: str) -> Factors:
    """Return what the walks of a training set have."""
    row = scenarios[sets[name].scenario]
    return Factors(row.random_torque, bool(row.pushes), str(row.commands))


def sets_of(trial: Factorial) -> tuple[str, ...]:
    """Return all training sets of the factorial, that of another day last."""
    return (*trial.cells, trial.another_day)


def combinations(grid: Grid) -> Iterator[dict[str, Value]]:
    """Yield every combination of a grid, key -> value."""
    keys = [*grid.learning, *grid.options]
    for values in product(*grid.learning.values(), *grid.options.values()):
        yield dict(zip(keys, values, strict=True))


def trial_name(base: str, changes: Mapping[str, Value]) -> str:
    """Return the name of a variant, such as MOB-Net-squared-0-005: a folder's name, without a point."""
    return "-".join([base, *map(str, changes.values())]).replace("_", "-").replace(".", "-")


def references(trials: Trials, methods: Mapping[str, Method], task: str) -> Iterator[MethodVariant]:
    """Yield the methods that stand beside what is tried, unchanged."""
    for name in trials.tuning.references:
        yield MethodVariant(name, name, {}, methods[name], task)


def tuned(trials: Trials, methods: Mapping[str, Method], tasks: Mapping[str, Development]) -> Iterator[MethodVariant]:
    """Yield every combination of what is tried for each method; a training that diverges is a result."""
    tuning = trials.tuning
    for name, grid in tuning.grids.items():
        for changes in combinations(grid) if name in methods else ():
            learning = {**trials.recipes.get(tuning.recipe, {}), **{key: changes[key] for key in grid.learning}}
            options = {key: changes[key] for key in grid.options}
            method = _changed(methods[name], tasks.get(tuning.task), tuning.experiment, learning, options)
            yield MethodVariant(name, trial_name(name, changes), changes, method, tuning.task)


def compared(
    trials: Trials, methods: Mapping[str, Method], tasks: Mapping[str, Development], table: str | None = None
) -> Iterator[MethodVariant]:
    """Yield every method by every recipe at every length, of one table or of all."""
    for row in _rows(trials, table):
        known = [name for name in row.methods if name in methods]
        for name, experiment, recipe in product(known, row.experiments, row.recipes):
            changes: dict[str, Value] = {EXPERIMENT: experiment, RECIPE: recipe}
            method = _changed(methods[name], tasks.get(row.task), experiment, trials.recipes.get(recipe, {}), {})
            yield MethodVariant(name, trial_name(name, changes), changes, method, row.task)


def taught(trials: Trials, methods: Mapping[str, Method]) -> Iterator[MethodVariant]:
    """Yield the factorial's method with each of its training sets, then the method that is fitted to one of them."""
    trial = trials.factorial
    if trial.method in methods:
        method = methods[trial.method]
        for name in sets_of(trial):
            network = {**method.network, "experiment": trial.experiment, DATA: name}
            variant = method.model_copy(update={"limbs": (trial.limb,), "network": network})
            yield MethodVariant(trial.method, trial_name(trial.method, {DATA: name}), {DATA: name}, variant, "")
    if trial.fitted in methods:
        changes: dict[str, Value] = {DATA: trial.same_day}
        variant = methods[trial.fitted].model_copy(update={"fitted": (trial.limb,), "network": changes})
        yield MethodVariant(trial.fitted, trial_name(trial.fitted, changes), changes, variant, "")


def explained(
    trials: Trials, methods: Mapping[str, Method], robot: str | None = None, named: str | None = None
) -> Iterator[MethodVariant]:
    """Yield the networks of the trial `why`, of one robot and of one training set, or of all."""
    trial = trials.why
    for row in trial.rows:
        sets = [name for name in row.sets if named in (name, None)]
        # Checks of the configuration tell names that do not exist, here they are passed over.
        known = [name for name in row.methods if name in methods]
        ways = [name for name in row.ways if name in trial.ways]
        for data, base_name, way in product(sets, known, ways if robot in (*row.robots, None) else ()):
            method = methods[base_name]
            changes: dict[str, Value] = {DATA: data, WAY: way}
            chosen = trial.ways[way]
            variant = method.model_copy(
                update={
                    "limbs": (trial.limb,),
                    "networks_of": {},
                    "network": {**method.network, "experiment": row.experiment, DATA: data, **chosen.network},
                    "learning": {**method.learning, **chosen.learning},
                }
            )
            yield MethodVariant(base_name, trial_name(base_name, changes), changes, variant, "")


def experiments_of(trials: Trials) -> set[str]:
    """Return the names of the lengths that are tried."""
    names = {trials.tuning.experiment}
    for row in trials.why.rows:
        names.add(row.experiment)
    for way in trials.why.ways.values():
        if EXPERIMENT in way.network:
            names.add(str(way.network[EXPERIMENT]))
    for row in _rows(trials, None):
        names.update(row.experiments)
    return names


def _rows(trials: Trials, table: str | None) -> list[Comparison]:
    """Return the rows of one table of comparisons, or of all."""
    comparisons: list[Comparison] = []
    for name, rows in trials.compared.items():
        if table in (name, None):
            comparisons += rows
    return comparisons


def _changed(
    method: Method, task: Development | None, experiment: str, learning: Mapping[str, Any], options: Mapping[str, Value]
) -> Method:
    """Return a method after changes, with networks, if it has any, of the limb of the task; without one as it is."""
    changes: dict[str, object] = {"options": {**method.options, **options}}
    if method.limbs and task:
        changes |= {
            "limbs": (task.limb,),
            "network": {**method.network, "experiment": experiment},
            "learning": {**method.learning, **learning, "may_diverge": True},
        }
    return method.model_copy(update=changes)
