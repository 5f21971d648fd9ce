"""Names in the configuration that must exist elsewhere in it, or on the robot: found by the fields' marks."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from types import NoneType, UnionType
from typing import Annotated, Any, Union, cast, get_args, get_origin

from pydantic import BaseModel

from mobnet.core.errors import not_accepted
from mobnet.settings.base import Named
from mobnet.settings.networks import Network
from mobnet.settings.settings import Settings

Use = tuple[tuple[str, ...], str, str]  # place, kind of name, name


def accepted_names(settings: Settings) -> dict[str, Collection[str]]:
    """Return kind of name -> the names that exist."""
    layout = settings.layout
    trained = [scale.train.keys() for scale in settings.scales.values()]
    experiments = [scale.experiments.keys() for scale in settings.scales.values()]
    terrains = [name for name in type(settings.terrain).model_fields if getattr(settings.terrain, name) is not None]
    return {
        "scale": settings.scales, "level": settings.levels, "terrain": terrains, "push": settings.pushes,
        "motion": settings.motions, "scenario": settings.scenarios, "test": settings.tests,
        "test with a window around pushes": settings.evaluation.windows,
        "training set": set(trained[0]).intersection(*trained),
        "experiment": set(experiments[0]).intersection(*experiments),
        "network": settings.networks, "method": settings.all_methods, "sweep": settings.sweeps,
        "joint": layout.names, "motor": layout.actuated, "limb": layout.groups,
        "limb or joint": (*layout.groups, *layout.names),
        "method that runs on its own": [name for name, row in settings.methods.items() if row.of is None],
    }  # fmt: skip


def unknown_names(settings: Settings) -> Iterator[tuple[tuple[str, ...], str]]:
    """Yield the place of every name that does not exist and what is accepted there."""
    accepted = accepted_names(settings)
    for place, kind, name in (*uses(settings, Settings, ()), *_changed_uses(settings)):
        if name not in accepted[kind]:
            yield place, not_accepted(kind, name, accepted[kind])


def _changed_uses(settings: Settings) -> Iterator[Use]:
    """Yield the names in what methods change of their networks."""
    for name, method in settings.all_methods.items():
        for key, value in method.network.items():
            if key in Network.model_fields:
                field = Network.model_fields[key]
                yield from uses(
                    value, Annotated[field.annotation, *field.metadata, None], ("methods", name, "network", key)
                )


def uses(value: Any, kind: Any, place: tuple[str, ...]) -> Iterator[Use]:
    """Yield every name that a value of an annotated kind holds.

    Args:
        value: a section, a container or a scalar.
        kind: its annotation.
        place: keys that lead to it.
    """
    origin, args = get_origin(kind), get_args(kind)
    if origin is Annotated:
        yield from ((place, mark.kind, value) for mark in args[1:] if isinstance(mark, Named))
        yield from uses(value, args[0], place)
    elif isinstance(value, BaseModel):
        for name, field in type(value).model_fields.items():
            inner = Annotated[field.annotation, *field.metadata] if field.metadata else field.annotation
            yield from uses(getattr(value, name), inner, (*place, name))
    elif origin in (Union, UnionType):
        yield from _union_uses(value, args, place)
    elif isinstance(value, dict) and len(args) == 2:
        for key, item in cast("dict[str, Any]", value).items():
            yield from uses(key, args[0], place)
            yield from uses(item, args[1], (*place, key))
    elif isinstance(value, tuple) and args:
        items = cast("tuple[Any, ...]", value)
        kinds = [args[0]] * len(items) if args[-1] is Ellipsis else args
        for item, inner in zip(items, kinds, strict=True):
            yield from uses(item, inner, place)


def _union_uses(value: Any, kinds: tuple[Any, ...], place: tuple[str, ...]) -> Iterator[Use]:
    """Yield the names of a value that is of one of several kinds."""
    for kind in kinds:
        bare = get_args(kind)[0] if get_origin(kind) is Annotated else kind
        origin = get_origin(bare) or bare
        if bare is not NoneType and isinstance(origin, type) and isinstance(value, origin):
            yield from uses(value, kind, place)
            return
