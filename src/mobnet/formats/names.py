"""Names in a section that must exist elsewhere: found by the marks of the fields that hold them."""

from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, Union, cast, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from mobnet.core.errors import not_accepted
from mobnet.formats.base import Named
from mobnet.formats.reading import Place

Use = tuple[Place, str, str]  # place, kind of name, name


def unknown(uses_found: Iterable[Use], accepted: Mapping[str, Collection[str]]) -> Iterator[tuple[Place, str]]:
    """Yield the place of every name that does not exist among those of its kind, and what is accepted there."""
    for place, kind, name in uses_found:
        if name not in accepted[kind]:
            text = not_accepted(kind, name, accepted[kind])
            yield place, text.removeprefix(f"{kind}: ") if place[-1:] == (kind,) else text  # no "scale: scale:"


def uses(value: Any, kind: Any, place: Place = ()) -> Iterator[Use]:
    """Yield every name that a value of an annotated kind holds, below the keys that lead to it."""
    origin = get_origin(kind)
    args = get_args(kind)
    if origin is Annotated:
        if isinstance(value, str):  # anything else is refused where the section is made
            yield from ((place, mark.kind, value) for mark in args[1:] if isinstance(mark, Named))
        yield from uses(value, args[0], place)
    elif isinstance(value, BaseModel):
        for name, inner in _named_fields(type(value)).items():
            yield from uses(getattr(value, name), inner, (*place, name))
    elif origin in (Union, UnionType):
        yield from _union_uses(value, args, place)
    elif isinstance(value, dict) and len(args) == 2:
        for key, item in cast("dict[str, Any]", value).items():
            yield from uses(key, args[0], (*place, key))
            yield from uses(item, args[1], (*place, key))
    elif isinstance(value, tuple) and args:
        items = cast("tuple[Any, ...]", value)
        kinds = [args[0]] * len(items) if args[-1] is Ellipsis else args
        for index, (item, inner) in enumerate(zip(items, kinds, strict=True)):
            yield from uses(item, inner, (*place, index))


def _union_uses(value: Any, kinds: tuple[Any, ...], place: Place) -> Iterator[Use]:
    """Yield the names of a value that is of one of several kinds."""
    for kind in kinds:
        bare = get_args(kind)[0] if get_origin(kind) is Annotated else kind
        origin = get_origin(bare) or bare
        if bare is not NoneType and isinstance(origin, type) and isinstance(value, origin):
            yield from uses(value, kind, place)
            return


def kind_of(field: FieldInfo) -> Any:
    """Return the annotated kind of a field's values, with its marks."""
    return Annotated[field.annotation, *field.metadata, None]  # which has one mark at least


@cache
def _named_fields(section: type[BaseModel]) -> dict[str, Any]:
    """Return the fields of a section in which a name may stand -> their kinds; most others are numbers."""
    fields = section.model_fields.items()
    kinds = {name: kind_of(field) for name, field in fields}
    return {name: kind for name, kind in kinds.items() if _may_name(kind)}


def _may_name(kind: Any) -> bool:
    """Return whether a value of an annotated kind may hold a name."""
    if kind is Any or (isinstance(kind, type) and issubclass(kind, BaseModel)):
        return True  # its own fields are looked at when a value is
    return any(isinstance(part, Named) or _may_name(part) for part in get_args(kind))
