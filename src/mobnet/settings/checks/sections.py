"""What must hold between sections: names that are used exist, changes are accepted, numbers fit each other."""

from collections.abc import Collection, Iterator, Mapping
from functools import partial
from itertools import chain
from typing import Annotated, Any

from pydantic import BaseModel, ValidationError

from mobnet.settings.catalogue import Catalogue
from mobnet.settings.checks.data import data_problems
from mobnet.settings.checks.learning import learning_problems
from mobnet.settings.checks.shown import shown_problems
from mobnet.settings.checks.sizes import size_problems
from mobnet.settings.checks.surrogate import surrogate_problems
from mobnet.settings.checks.walking import walking_problems
from mobnet.settings.methods import swept_name
from mobnet.settings.names import Use, unknown, uses
from mobnet.settings.networks import Learning, Network
from mobnet.settings.reading import Place
from mobnet.settings.settings import Settings

Problem = tuple[Place, str]
Refused = tuple[Place, type[BaseModel], Mapping[str, Any], ValidationError]


def accepted_names(catalogue: Catalogue) -> dict[str, Collection[str]]:
    """Return kind of name -> the names that exist."""
    settings = catalogue.settings
    experiments = chain.from_iterable(scale.experiments for scale in settings.scales.values())
    terrains = [name for name in type(settings.terrain).model_fields if getattr(settings.terrain, name) is not None]
    return {
        "scale": settings.scales, "level": [*settings.levels, *settings.fleet.levels],
        "level of one plant": settings.levels, "terrain": terrains, "push": settings.pushes,
        "motion": settings.motions, "scenario": settings.scenarios, "test": [one.scenario for one in catalogue.asked],
        "test with a window around pushes": settings.evaluation.windows,
        "training set": settings.training_sets, "experiment": set(experiments),
        "network": settings.networks, "detector": settings.detection.detectors,
        "method": catalogue.all_methods, "sweep": settings.sweeps,
        "method that runs on its own": [name for name, row in settings.methods.items() if row.of is None],
        **settings.robot.accepted_names,
    }  # fmt: skip


def unknown_names(settings: Settings) -> Iterator[Problem]:
    """Yield the place of every name that does not exist and what is accepted there."""
    yield from unknown((*uses(settings, Settings), *_changed_uses(settings)), accepted_names(Catalogue(settings)))


def _changed_uses(settings: Settings) -> Iterator[Use]:
    """Yield the names in what methods change of their networks."""
    for name, method in settings.methods.items():
        for key, value in method.network.items():
            if key in Network.model_fields:
                field, place = Network.model_fields[key], ("methods", name, "network", key)
                yield from uses(value, Annotated[field.annotation, *field.metadata, None], place)


def refused_changes(settings: Settings) -> Iterator[Refused]:
    """Yield every change by a method that is not accepted: place, section, what is given of it, and the error."""
    catalogue = Catalogue(settings)
    for name, method in {**catalogue.all_methods, **catalogue.tried}.items():
        checks = [("network", Network, method.network, partial(catalogue.network, name, limb)) for limb in method.limbs]
        checks += [("learning", Learning, method.learning, partial(catalogue.learned, name))]
        for part, section, given, made in checks:
            try:
                made()
            except ValidationError as error:
                yield _place_of(catalogue, name, part), section, given, error


def _place_of(catalogue: Catalogue, method: str, part: str) -> Place:
    """Return the place of what makes a change: a method, a sweep or the trials."""
    if method in catalogue.settings.methods:
        return ("methods", method, part)
    swept = [key for key, sweep in catalogue.settings.sweeps.items()
             if method in {swept_name(base, key, value) for base in sweep.of for value in sweep.values}]  # fmt: skip
    return ("sweeps", swept[0]) if swept else ("trials",)


def inconsistencies(settings: Settings) -> Iterator[Problem]:
    """Yield the place and the text of everything that does not fit together."""
    catalogue = Catalogue(settings)
    found = [problem for check in (walking_problems, data_problems, surrogate_problems) for problem in check(settings)]
    found += learning_problems(catalogue)
    yield from found
    if not found:  # only then can sizes and results be looked up
        yield from size_problems(settings)
        yield from shown_problems(catalogue)
