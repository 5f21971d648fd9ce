"""Sections as plain dataclasses, for code that takes numbers and knows no configuration."""

from dataclasses import fields
from typing import Any, ClassVar, Protocol, TypeVar, cast

from mobnet.formats.base import Section


class Dataclass(Protocol):
    """Any dataclass."""

    __dataclass_fields__: ClassVar[dict[str, Any]]


Kind = TypeVar("Kind", bound=Dataclass)


def as_plain(section: Section, kind: type[Kind]) -> Kind:
    """Return an object of a dataclass with the values that a section has under the names of its fields.

    A field whose value is a section is of a dataclass, too.
    """
    values = dict[str, Any]()
    for field in fields(kind):
        value = getattr(section, field.name)
        if isinstance(value, Section):
            value = as_plain(value, cast("type[Dataclass]", field.type))
        values[field.name] = value
    return kind(**values)
