"""Trials: variants of methods that no table shows. They are judged on development walks, and methods are chosen so."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import product
from typing import NamedTuple

from pydantic import JsonValue

from mobnet.settings import base
from mobnet.settings.base import Section
from mobnet.settings.methods import Method


class Grid(Section):
    """Keys of a method's `learning` and `options`, each with values; all combinations are tried."""

    learning: dict[str, base.Distinct[JsonValue]] = {}
    options: dict[str, base.Distinct[JsonValue]] = {}


class Tuning(Section):
    """What is tried for each method, all of them in trainings of one length."""

    experiment: base.ExperimentName
    grids: dict[base.MethodName, Grid]


class Lengths(Section):
    """Methods whose networks are trained as long as each of some experiments says."""

    methods: base.MethodNames
    experiments: base.Distinct[base.ExperimentName]


class Trials(Section):
    """The trials, of networks of one limb."""

    limb: base.NetworkName
    tuning: Tuning
    lengths: Lengths


class Trial(NamedTuple):
    """A variant of the `base` method: what is changed, key -> value, and the method after that."""

    base: str
    changes: Mapping[str, JsonValue]
    method: Method

    @property
    def name(self) -> str:
        """Name of the variant, such as MOB-Net-squared-0.005."""
        return "-".join([self.base, *map(str, self.changes.values())]).replace("_", "-")


def tuned(trials: Trials, methods: Mapping[str, Method]) -> Iterator[Trial]:
    """Yield every combination of what is tried for each method; a training that diverges is a result."""
    for name, grid in trials.tuning.grids.items():
        keys = [*grid.learning, *grid.options]
        for values in product(*grid.learning.values(), *grid.options.values()):
            changes = dict(zip(keys, values, strict=True))
            learning = {key: changes[key] for key in grid.learning}
            options = {key: changes[key] for key in grid.options}
            yield Trial(name, changes, _changed(methods[name], trials, trials.tuning.experiment, learning, options))


def of_lengths(trials: Trials, methods: Mapping[str, Method]) -> Iterator[Trial]:
    """Yield every method at every length."""
    for name, experiment in product(trials.lengths.methods, trials.lengths.experiments):
        yield Trial(name, {"experiment": experiment}, _changed(methods[name], trials, experiment, {}, {}))


def _changed(
    method: Method, trials: Trials, experiment: str, learning: base.Change, options: Mapping[str, JsonValue]
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
