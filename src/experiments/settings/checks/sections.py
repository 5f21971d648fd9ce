"""What must hold between sections: names that are used exist, changes are accepted, numbers fit each other."""

from collections.abc import Collection, Iterator, Mapping
from functools import partial
from itertools import chain
from typing import Any

from pydantic import BaseModel, ValidationError

from experiments.records.collisions import READINGS
from experiments.records.reactions import FORCE_SENSORS, NONE
from experiments.settings.asked import RunRequest
from experiments.settings.catalogue import Catalogue
from experiments.settings.checks.claims import claim_problems
from experiments.settings.checks.data import data_problems
from experiments.settings.checks.detection import detection_problems, reaction_problems
from experiments.settings.checks.learning import learning_problems
from experiments.settings.checks.outcomes import outcome_problems
from experiments.settings.checks.products import product_problems
from experiments.settings.checks.results import Results
from experiments.settings.checks.sizes import size_problems
from experiments.settings.checks.surrogate import surrogate_problems
from experiments.settings.checks.walking import walking_problems
from experiments.settings.settings import Settings
from mobnet.core.errors import misfit
from mobnet.formats.names import Use, kind_of, unknown, uses
from mobnet.formats.reading import Place, Problem
from mobnet.settings.methods import swept_names
from mobnet.settings.networks import Learning, Network

Refused = tuple[Place, type[BaseModel], Mapping[str, Any], ValidationError]


def asked_problems(catalogue: Catalogue) -> Iterator[Problem]:
    """Yield methods that do not estimate what is shown of them, or that do not learn from what robots record."""
    for request in catalogue.asked:
        for text in (*_estimate_faults(catalogue, request), *_fleet_faults(catalogue, request)):
            yield request.place, text


def _estimate_faults(catalogue: Catalogue, request: RunRequest) -> Iterator[str]:
    """Yield joints that are shown of a run and that its method does not estimate."""
    groups = catalogue.layout.groups
    estimated = catalogue.estimated(request.method, request.scenario, request.level)
    shown = chain.from_iterable(groups.get(name, (name,)) for name in request.shown)
    missing = [joint for joint in shown if joint not in estimated]
    if missing and not (request.partly and estimated):
        yield misfit(request.method, f"methods that estimate {missing[0]} in {request.scenario}, {request.level}")


def _fleet_faults(catalogue: Catalogue, request: RunRequest) -> Iterator[str]:
    """Yield data that a method learns from and that the robots of the fleet do not record, where they walk."""
    fleet = catalogue.settings.fleet
    source = catalogue.source_of(request.method)
    if request.level not in fleet.levels:
        return
    learned = [(request.method, limb) for limb in catalogue.method(catalogue.network_source_of(request.method)).limbs]
    learned += [(source, limb) for limb in catalogue.method(source).fitted]
    data = [catalogue.network(*pair).data for pair in learned]
    yield from (
        misfit(f"{request.method}, which learns from {name}", f"methods that learn from {', '.join(fleet.sets)}")
        for name in data
        if name not in fleet.sets
    )


# What must hold for a single table or figure stands with those of its kind (`experiments.settings.checks.products`).
def shown_problems(catalogue: Catalogue) -> Iterator[Problem]:
    """Yield what does not fit in tables, figures and claims, and in detectors and reactions that they show."""
    results = Results(catalogue)
    yield from product_problems(catalogue.settings.evaluation, results, ("evaluation",))
    yield from detection_problems(results)
    yield from reaction_problems(results)
    yield from asked_problems(catalogue)
    yield from claim_problems(results)


def accepted_names(catalogue: Catalogue) -> dict[str, Collection[str]]:
    """Return kind of name -> the names that exist."""
    settings = catalogue.settings
    detection = catalogue.settings.detection
    experiments = chain.from_iterable(scale.experiments for scale in settings.scales.values())
    terrains = [name for name in type(settings.terrain).model_fields if getattr(settings.terrain, name) is not None]
    pushed = [name for name, row in settings.scenarios.items() if row.pushes]
    learned = [name for name, row in catalogue.all_methods.items() if row.limbs]
    struck = settings.scenarios[detection.collisions].pushes if detection.collisions in settings.scenarios else ()
    reacts = [name for name, row in detection.detectors.items() if not (row.norm or row.commanded)]
    points = [settings.pushes[name].point or "" for name in struck if name in settings.pushes]
    return {
        "scale": settings.scales, "level": [*settings.levels, *settings.fleet.levels],
        "level of one plant": settings.levels,
        "level of a surrogate robot": [name for name, level in settings.levels.items() if level.surrogate],
        "terrain": terrains, "push": settings.pushes, "obstacle": settings.obstacles,
        "motion": settings.motions, "scenario": settings.scenarios,
        "scenario with pushes": pushed, "scenario without pushes": settings.scenarios.keys() - {*pushed},
        "test with a window around pushes": settings.evaluation.windows,
        "training set": settings.training_sets, "experiment": set(experiments),
        "task of development": settings.development, "recipe": settings.trials.recipes,
        "network": settings.networks, "sweep": settings.sweeps, "method": catalogue.all_methods,
        "method with networks": learned,
        "method that runs on its own": [name for name, row in settings.methods.items() if row.of is None],
        "detector that reacts": (*reacts, FORCE_SENSORS, NONE), "case of reactions": settings.reaction.cases,
        "detector": detection.detectors, "rule of thresholds": (*READINGS, *detection.thresholds.rates_per_h),
        "level with detectors": (*detection.levels, *settings.fleet.robots), "leg with detectors": detection.legs,
        "cell of collisions": [" ".join(point.split("_")[1:]) for point in points],
        **settings.robot.accepted_names,
    }  # fmt: skip


def unknown_names(catalogue: Catalogue) -> Iterator[Problem]:
    """Yield the place of every name that does not exist and what is accepted there."""
    settings = catalogue.settings
    yield from unknown((*uses(settings, Settings), *_changed_uses(settings)), accepted_names(catalogue))


def _changed_uses(settings: Settings) -> Iterator[Use]:
    """Yield the names in what methods change of their networks."""
    for name, method in settings.methods.items():
        for key, value in method.network.items():
            if key in Network.model_fields:
                yield from uses(value, kind_of(Network.model_fields[key]), ("methods", name, "network", key))


def refused_changes(catalogue: Catalogue) -> Iterator[Refused]:
    """Yield every change by a method that is not accepted: place, section, what is given of it, and the error."""
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
    swept = [key for key, sweep in catalogue.settings.sweeps.items() if method in swept_names(key, sweep)]
    return ("sweeps", swept[0]) if swept else ("trials",)


def inconsistencies(catalogue: Catalogue) -> Iterator[Problem]:
    """Yield the place and the text of everything that does not fit together."""
    settings = catalogue.settings
    problems_found = [*walking_problems(settings), *data_problems(settings), *surrogate_problems(settings)]
    problems_found += learning_problems(catalogue)
    if not problems_found:  # only then can sizes and results be looked up
        problems_found = [*size_problems(catalogue), *shown_problems(catalogue)]
    yield from problems_found
    for name, scale in settings.scales.items():
        if scale.decides and not problems_found:  # only then is known what a claim counts
            yield from outcome_problems(catalogue.at_scale(name))
