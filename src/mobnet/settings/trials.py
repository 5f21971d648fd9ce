"""Trials: variants of methods that no table shows. They are judged on development walks, and methods are chosen so."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from typing import Annotated, NamedTuple

from pydantic import Field

from mobnet.settings import base
from mobnet.settings.base import Section
from mobnet.settings.methods import Method

Value = bool | int | float | str


class Grid(Section):
    """Keys of a method's `learning` and `options`, each with values; all combinations are tried."""

    learning: dict[str, base.Distinct[Value]] = {}
    options: dict[str, base.Distinct[Value]] = {}


class Tuning(Section):
    """What is tried for each method, all of them in trainings of one length, and methods beside which they stand."""

    references: base.MethodNames
    experiment: base.ExperimentName
    grids: dict[base.MethodName, Grid]


class Lengths(Section):
    """Methods whose networks are trained at each length, and with each of some shares of their first learning rate."""

    methods: base.Distinct[base.LearnedName]
    experiments: base.Distinct[base.ExperimentName]
    rate_shares: base.Distinct[base.PositiveShare]


class Explored(Section):
    """How each robot of the fleet walks while its falls are counted: with each largest random torque on legs and waist.

    The first robot's walks have the seed `first_seed`, between those of development and of training; the next robot's
    have the next one.
    """

    scenario: base.ScenarioName
    amplitudes_nm: base.Rising[Annotated[base.Positive, Field(le=1000)]]
    walked_s: base.Real = Field(ge=1, le=7200)
    first_seed: base.Whole = Field(ge=601, le=900)


class Trials(Section):
    """The trials: variants of methods, with networks of one limb, and random torques."""

    limb: base.NetworkName
    tuning: Tuning
    lengths: Lengths
    random_torque: Explored


class Trial(NamedTuple):
    """A variant of the method `base`: its name, the keys that it changes with their new values, and the variant."""

    base: str
    name: str
    changes: Mapping[str, Value]
    method: Method


def combinations(grid: Grid) -> Iterator[dict[str, Value]]:
    """Yield every combination of a grid, key -> value."""
    keys = [*grid.learning, *grid.options]
    for values in product(*grid.learning.values(), *grid.options.values()):
        yield dict(zip(keys, values, strict=True))


def trial_name(base: str, changes: Mapping[str, Value]) -> str:
    """Return the name of a variant, such as MOB-Net-squared-0-005: a folder's name, without a point."""
    return "-".join([base, *map(str, changes.values())]).replace("_", "-").replace(".", "-")


def references(trials: Trials, methods: Mapping[str, Method]) -> Iterator[Trial]:
    """Yield the methods that stand beside what is tried, unchanged."""
    for name in trials.tuning.references:
        yield Trial(name, name, {}, methods[name])


def tuned(trials: Trials, methods: Mapping[str, Method]) -> Iterator[Trial]:
    """Yield every combination of what is tried for each method; a training that diverges is a result."""
    grids = {name: grid for name, grid in trials.tuning.grids.items() if name in methods}
    for name, grid in grids.items():
        for changes in combinations(grid):
            learning = {key: changes[key] for key in grid.learning}
            options = {key: changes[key] for key in grid.options}
            method = _changed(methods[name], trials, trials.tuning.experiment, learning, options)
            yield Trial(name, trial_name(name, changes), changes, method)


def of_lengths(trials: Trials, methods: Mapping[str, Method], rate_first: float) -> Iterator[Trial]:
    """Yield every method at every length and share of its first learning rate.

    That rate is `rate_first` for a method without one of its own.
    """
    known = [name for name in trials.lengths.methods if name in methods]
    for name, experiment, share in product(known, trials.lengths.experiments, trials.lengths.rate_shares):
        learning = {} if share == 1.0 else {"rate_first": share * _rate_of(methods[name], rate_first)}
        changes = {"experiment": experiment, **learning}
        yield Trial(name, trial_name(name, changes), changes, _changed(methods[name], trials, experiment, learning, {}))


def _rate_of(method: Method, rate_first: float) -> float:
    """Return a method's first learning rate; a value that is no number is refused elsewhere, at its own place."""
    own = method.learning.get("rate_first", rate_first)
    return float(own) if isinstance(own, int | float) else rate_first


def _changed(
    method: Method, trials: Trials, experiment: str, learning: Mapping[str, Value], options: Mapping[str, Value]
) -> Method:
    """Return a method after changes, with networks, if it has any, of the limb and the experiment of the trials."""
    changes: dict[str, object] = {"options": {**method.options, **options}}
    if method.limbs:
        changes |= {
            "limbs": (trials.limb,),
            "network": {**method.network, "experiment": experiment},
            "learning": {**method.learning, **learning, "may_diverge": True},
        }
    return method.model_copy(update=changes)
