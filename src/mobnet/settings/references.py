"""The names that exist in a configuration and on its robot, by kind, and those that are used and do not exist."""

from collections.abc import Collection, Iterator
from typing import Annotated

from mobnet.settings.names import Place, Use, unknown, uses
from mobnet.settings.networks import Network
from mobnet.settings.settings import Settings


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
