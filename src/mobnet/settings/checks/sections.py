"""What must hold between sections: names that are used exist, changes are accepted, numbers fit each other."""

from collections.abc import Collection, Iterator, Mapping
from functools import partial
from itertools import chain
from typing import Annotated, Any

from pydantic import BaseModel, ValidationError

from mobnet.settings.checks.data import data_problems
from mobnet.settings.checks.learning import learning_problems
from mobnet.settings.checks.shown import shown_problems
from mobnet.settings.checks.sizes import size_problems
from mobnet.settings.checks.surrogate import surrogate_problems
from mobnet.settings.checks.walking import walking_problems
from mobnet.settings.fleet import levels_of
from mobnet.settings.names import Use, unknown, uses
from mobnet.settings.networks import Learning, Network
from mobnet.settings.reading import Place
from mobnet.settings.settings import Settings

Problem = tuple[Place, str]
Refused = tuple[Place, type[BaseModel], Mapping[str, Any], ValidationError]


def accepted_names(settings: Settings) -> dict[str, Collection[str]]:
    """Return kind of name -> the names that exist."""
    experiments = chain.from_iterable(scale.experiments for scale in settings.scales.values())
    terrains = [name for name in type(settings.terrain).model_fields if getattr(settings.terrain, name) is not None]
    return {
        "scale": settings.scales, "level": [*settings.levels, *levels_of(settings.fleet)],
        "level of one plant": settings.levels, "terrain": terrains, "push": settings.pushes,
        "motion": settings.motions, "scenario": settings.scenarios, "test": settings.tests,
        "test with a window around pushes": settings.evaluation.windows,
        "training set": settings.training_sets, "experiment": set(experiments),
        "network": settings.networks, "detector": settings.detection.detectors,
        "method": settings.all_methods, "sweep": settings.sweeps,
        "method that runs on its own": [name for name, row in settings.methods.items() if row.of is None],
        **settings.robot.accepted_names,
    }  # fmt: skip


def unknown_names(settings: Settings) -> Iterator[Problem]:
    """Yield the place of every name that does not exist and what is accepted there."""
    yield from unknown((*uses(settings, Settings), *_changed_uses(settings)), accepted_names(settings))


def _changed_uses(settings: Settings) -> Iterator[Use]:
    """Yield the names in what methods change of their networks."""
    for name, method in settings.methods.items():
        for key, value in method.network.items():
            if key in Network.model_fields:
                field, place = Network.model_fields[key], ("methods", name, "network", key)
                yield from uses(value, Annotated[field.annotation, *field.metadata, None], place)


def refused_changes(settings: Settings) -> Iterator[Refused]:
    """Yield every change by a method that is not accepted: place, section, what is given of it, and the error."""
    for name, method in {**settings.all_methods, **settings.tried}.items():
        checks = [("network", Network, method.network, partial(settings.network, name, limb)) for limb in method.limbs]
        checks += [("learning", Learning, method.learning, partial(settings.learned, name))]
        for part, section, given, made in checks:
            try:
                made()
            except ValidationError as error:
                yield _place_of(settings, name, part), section, given, error


def _place_of(settings: Settings, method: str, part: str) -> Place:
    """Return the place of what makes a change: a method, a sweep or the trials."""
    swept = settings.sweep_of(method)
    if method in settings.tried:
        return ("trials",)
    return ("sweeps", swept) if swept else ("methods", method, part)


def inconsistencies(settings: Settings) -> Iterator[Problem]:
    """Yield the place and the text of everything that does not fit together."""
    checks = walking_problems, data_problems, learning_problems, surrogate_problems
    found = [problem for check in checks for problem in check(settings)]
    yield from found
    if not found:  # only then can sizes and results be looked up
        yield from size_problems(settings)
        yield from shown_problems(settings)
