"""What is said of a table beside its section, and what stands in a section."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, cast

from pydantic import BaseModel

from mobnet.formats.base import Section


@dataclass(frozen=True)
class ClaimedTable:
    """The mark of a field of `Evaluation`: claims may name fields of the table of this section.

    Attributes:
        columns: of its CSV file.
        clustered: whether intervals in it are over robots.
    """

    columns: tuple[str, ...]
    clustered: bool = False


def claimed_tables(section: type[Section]) -> dict[str, ClaimedTable]:
    """Return field -> what is said of its table, of those fields of a section that have such a mark."""
    tables: dict[str, ClaimedTable] = {}
    for name, info in section.model_fields.items():
        for mark in info.metadata:
            if isinstance(mark, ClaimedTable):
                tables[name] = mark
    return tables


def items_of(section: object) -> Mapping[Any, object]:
    """Return what stands in a section, a mapping or a tuple, by key; nothing stands in anything else."""
    if isinstance(section, BaseModel):
        return {key: getattr(section, key) for key in type(section).model_fields}
    if isinstance(section, dict):
        return cast("Mapping[Any, object]", section)
    if isinstance(section, tuple):
        return dict(enumerate(cast("tuple[object, ...]", section)))
    return {}
