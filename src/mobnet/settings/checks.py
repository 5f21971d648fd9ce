"""What must hold between sections: names that are used exist, runs that are shown are run, pushes have windows."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import partial
from itertools import product
from typing import Annotated, cast

from pydantic import BaseModel, ValidationError

from mobnet.core.errors import not_accepted
from mobnet.settings.evaluation import Mean
from mobnet.settings.names import Place, Use, unknown, uses
from mobnet.settings.networks import Learning, Network
from mobnet.settings.settings import Settings

Problem = tuple[Place, str]
Shown = tuple[Place, str, str, str]  # place, scenario, level, method
ROOT: Place = ("evaluation",)


def accepted_names(settings: Settings) -> dict[str, Collection[str]]:
    """Return kind of name -> the names that exist."""
    experiments = [scale.experiments.keys() for scale in settings.scales.values()]
    terrains = [name for name in type(settings.terrain).model_fields if getattr(settings.terrain, name) is not None]
    return {
        "scale": settings.scales, "level": settings.levels, "terrain": terrains, "push": settings.pushes,
        "motion": settings.motions, "scenario": settings.scenarios, "test": settings.tests,
        "test with a window around pushes": settings.evaluation.windows,
        "training set": settings.training_sets,
        "experiment": set(experiments[0]).intersection(*experiments),
        "network": settings.networks, "method": settings.all_methods, "sweep": settings.sweeps,
        "method that runs on its own": [name for name, row in settings.methods.items() if row.of is None],
        **settings.robot.accepted_names,
    }  # fmt: skip


def unknown_names(settings: Settings) -> Iterator[tuple[Place, str]]:
    """Yield the place of every name that does not exist and what is accepted there."""
    yield from unknown((*uses(settings, Settings), *_changed_uses(settings)), accepted_names(settings))


def _changed_uses(settings: Settings) -> Iterator[Use]:
    """Yield the names in what methods change of their networks."""
    for name, method in settings.all_methods.items():
        for key, value in method.network.items():
            if key in Network.model_fields:
                field = Network.model_fields[key]
                yield from uses(
                    value, Annotated[field.annotation, *field.metadata, None], ("methods", name, "network", key)
                )


def inconsistencies(settings: Settings) -> Iterator[Problem]:
    """Yield the place and the text of everything that does not fit together."""
    for place, scenario, level, method in shown_runs(settings):
        accepted = settings.tests.get(scenario, {}).get(level)
        if accepted is None:
            yield place, not_accepted(f"level of test {scenario}", level, settings.tests.get(scenario, {}))
        elif method not in accepted:
            yield place, not_accepted(f"method of test {scenario}, {level}", method, accepted)
    for name, row in settings.training_sets.items():
        for scale in settings.scales.keys() - row.sizes.keys():
            yield ("training_sets", name, "sizes"), f"scale is missing: {scale}"
    yield from _metrics_without_window(settings)
    yield from _missing_places(settings)
    for limb, values in settings.published.uncertainty.std.items():
        if len(values) != len(settings.layout.limb(limb)):
            yield ("published", "uncertainty", "std", limb), f"{len(values)} numbers; accepted: one for each joint"


def shown_runs(settings: Settings) -> Iterator[Shown]:
    """Yield every run that a table, a figure or a claim shows."""
    evaluation = settings.evaluation
    for place, section in sections_below(evaluation, ROOT):
        if {"scenario", "level", "methods"} <= type(section).model_fields.keys():
            scenario, level, methods = (getattr(section, name) for name in ("scenario", "level", "methods"))
            yield from ((place, scenario, level, method) for method in methods)
    figure = evaluation.figure_05
    for level, methods in figure.panels.items():
        yield from (((*ROOT, "figure_05", "panels"), figure.scenario, level, method) for method in methods)
    for scenario, method in product(evaluation.figure_18.panels, evaluation.figure_18.methods):
        yield (*ROOT, "figure_18", "panels"), scenario, evaluation.figure_18.level, method
    for name, claim in settings.claims.items():
        for cell in claim.cells:
            if cell.scenario and cell.level and cell.method:
                yield ("claims", name, "cells"), cell.scenario, cell.level, cell.method


def sections_below(value: object, place: Place) -> Iterator[tuple[Place, BaseModel]]:
    """Yield a section and all below it, each with the keys that lead to it."""
    if isinstance(value, BaseModel):
        yield place, value
        for name in type(value).model_fields:
            yield from sections_below(getattr(value, name), (*place, name))
    elif isinstance(value, Mapping):
        for key, item in cast("Mapping[str, object]", value).items():
            yield from sections_below(item, (*place, str(key)))
    elif isinstance(value, tuple):
        for item in cast("Sequence[object]", value):
            yield from sections_below(item, place)


def _metrics_without_window(settings: Settings) -> Iterator[Problem]:
    """Yield rows of tables whose metric looks at pushes of a test that has no window around them."""
    for name, table in settings.evaluation.tables.items():
        own = [metric for column in table.columns if isinstance(column, Mean) for metric in column.metrics]
        for row in table.rows:
            if (
                any("push" in metric for metric in (*own, row.metric))
                and row.scenario not in settings.evaluation.windows
            ):
                place = (*ROOT, "tables", name, "rows")
                yield place, not_accepted("test with a window around pushes", row.scenario, settings.evaluation.windows)


def _missing_places(settings: Settings) -> Iterator[Problem]:
    """Yield rows of tables that name a place of the paper's numbers which is not there."""
    for name, table in settings.evaluation.tables.items():
        printed = settings.published.tables.get(name)
        accepted = printed.numbers if printed else {}
        for row in table.rows:
            if row.paper is not None and row.paper not in accepted:
                yield (*ROOT, "tables", name, "rows"), not_accepted("paper", row.paper, accepted)


def refused_changes(settings: Settings) -> Iterator[tuple[Place, type[BaseModel], ValidationError]]:
    """Yield the place of every change by a method that is not accepted, the section that it changes, and the error."""
    for name, method in settings.all_methods.items():
        checks = [("network", Network, partial(settings.network, name, limb)) for limb in method.limbs]
        for part, section, made in (*checks, ("learning", Learning, partial(settings.learned, name))):
            try:
                made()
            except ValidationError as error:
                yield ("methods", name, part), section, error
