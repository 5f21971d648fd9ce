"""What must hold for the runs that are asked for: their methods estimate what is shown, and learn what they need."""

from collections.abc import Iterator
from itertools import chain

from experiments.settings.asked import RunRequest
from experiments.settings.catalogue import Catalogue
from mobnet.core.errors import misfit
from mobnet.settings.reading import Problem


def asked_problems(catalogue: Catalogue) -> Iterator[Problem]:
    """Yield methods that do not estimate what is shown of them, or that do not learn from what robots record."""
    for one in catalogue.asked:
        for text in (*_estimate_faults(catalogue, one), *_fleet_faults(catalogue, one)):
            yield one.place, text


def _estimate_faults(catalogue: Catalogue, one: RunRequest) -> Iterator[str]:
    """Yield joints that are shown of a run and that its method does not estimate."""
    groups = catalogue.layout.groups
    held = catalogue.estimated(one.method, one.scenario, one.level)
    shown = chain.from_iterable(groups.get(name, (name,)) for name in one.shown)
    missing = [joint for joint in shown if joint not in held]
    if missing and not (one.partly and held):
        yield misfit(one.method, f"methods that estimate {missing[0]} in {one.scenario}, {one.level}")


def _fleet_faults(catalogue: Catalogue, one: RunRequest) -> Iterator[str]:
    """Yield data that a method learns from and that the robots of the fleet do not record, where they walk."""
    fleet = catalogue.settings.fleet
    source = catalogue.source_of(one.method)
    if one.level not in fleet.levels:
        return
    learned = [(one.method, limb) for limb in catalogue.method(catalogue.network_source_of(one.method)).limbs]
    learned += [(source, limb) for limb in catalogue.method(source).fitted]
    data = [catalogue.network(*pair).data for pair in learned]
    yield from (
        misfit(f"{one.method}, which learns from {name}", f"methods that learn from {', '.join(fleet.sets)}")
        for name in data
        if name not in fleet.sets
    )
