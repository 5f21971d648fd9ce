"""Claims of the paper and the bounds within which ours count as reproduced."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, cast

from pydantic import AfterValidator, Field, model_validator

from mobnet.settings.base import (
    Item,
    LevelName,
    LimbOrJointName,
    MethodName,
    Real,
    Section,
    Some,
    TestName,
    Text,
    distinct,
)
from mobnet.settings.evaluation import Metric
from mobnet.settings.reading import Place, mapping

SHORT_CELL = ("level", "method", "joint")
Quantity = Literal["value", "ratio", "cut", "difference", "gap ratio", "below", "above", "falls", "least ratio"]
TAKES: Mapping[Quantity, tuple[int, int]] = {  # how many cells: at least, and in steps of; a step of 0 is exactly
    "value": (1, 0), "ratio": (2, 0), "cut": (2, 0), "difference": (2, 0), "gap ratio": (4, 0),
    "below": (2, 1), "above": (2, 1), "falls": (2, 1), "least ratio": (2, 2),
}  # fmt: skip
TrainingMetric = Literal[
    "validation loss",
    "validation RMSE",
    "validation loss on windows",
    "training loss at the end",
    "validation loss at the end",
]
ClaimName = Annotated[str, Field(pattern="^[a-z0-9][a-z0-9-]*$", max_length=50)]


def _ordered(bounds: tuple[float | None, float | None]) -> tuple[float | None, float | None]:
    """Check that a range has its lower end first and an end at all; None is no bound."""
    low, high = bounds
    if (low is None and high is None) or (low is not None and high is not None and low > high):
        raise ValueError("accepted: [low, high] with low <= high, null for no bound at one of them")
    return bounds


Bound = Annotated[Real, Field(ge=-1000, le=1000)]
Bounds = Annotated[tuple[Bound | None, Bound | None], AfterValidator(_ordered)]
Several = Annotated[Some[Item], AfterValidator(distinct)]


class Cell(Section):
    """A result that a claim's number is made of; several joints or metrics are averaged."""

    scenario: TestName | None = None
    level: LevelName | None = None
    method: MethodName | None = None
    joint: LimbOrJointName | Several[LimbOrJointName] | None = None
    metric: TrainingMetric | Metric | Several[Metric] | None = None

    @model_validator(mode="before")
    @classmethod
    def _names_something(cls, cell: Any) -> Any:
        """Check that no key is null: the key itself is left out."""
        for key in (name for name, value in mapping(cell).items() if value is None):
            raise ValueError(f"{key}: null is not accepted; accepted: a name, or no such key")
        return cell


def _spelt_cell(cell: Any) -> Any:
    """Return a cell, written as a method's name, as [level, method, joint] or as a mapping, as a mapping."""
    if isinstance(cell, str):
        return {"method": cell}
    if isinstance(cell, list) and len(names := cast("list[Any]", cell)) == len(SHORT_CELL):
        return dict(zip(SHORT_CELL, names, strict=True))
    return cast("Any", cell)


def _spelt_claim(entry: Any) -> Any:
    """Return a claim with its short cells as mappings, and what they share, `at`, in each."""
    shared: Any = mapping(entry).get("at", {})
    typed = mapping(entry).get("cells")
    if not isinstance(shared, Mapping) or not isinstance(typed, list):
        return entry
    cells: list[Any] = [_spelt_cell(cell) for cell in cast("list[Any]", typed)]
    rest, shared_keys = (
        {key: value for key, value in mapping(entry).items() if key != "at"},
        mapping(cast("Any", shared)),
    )
    return {**rest, "cells": [{**shared_keys, **cell} if mapping(cell) else cell for cell in cells]}


def spelt_out(claims: Any) -> Any:
    """Return claims, as they were typed, with all their cells as mappings."""
    return {name: _spelt_claim(entry) for name, entry in mapping(claims).items()} or claims


def place_of(place: Place, claims: Mapping[str, Any]) -> Place:
    """Return where something of a claim's cell was typed: in the cell, in what cells share, or by its order."""
    if len(place) < 5 or place[2] != "cells":
        return place
    _, name, _, index, key, *rest = place
    cell, shared = claims[str(name)]["cells"][index], mapping(claims[str(name)].get("at"))
    if isinstance(cell, list) and key in SHORT_CELL:
        return (*place[:4], SHORT_CELL.index(key))
    typed = _spelt_cell(cell)
    return ("claims", name, "at", key, *rest) if key in shared and key not in typed else place


class Claim(Section):
    """What the paper says, where it is printed, and what must hold here."""

    printed: Text
    says: Text
    quantity: Quantity
    cells: Some[Cell]
    unit: Literal["N m", "N", "-"]
    published: Bound | None
    reproduced: Bounds
    direction: Bounds
    cause: str = ""

    @model_validator(mode="before")
    @classmethod
    def _fill_in(cls, entry: Any) -> Any:
        """Spell out short cells, and put what the cells share, `at`, into each."""
        return _spelt_claim(entry)

    @model_validator(mode="after")
    def _takes_its_cells(self) -> Claim:
        """Check that there are as many cells as the quantity takes."""
        least, step = TAKES[self.quantity]
        more = len(self.cells) - least
        if more < 0 or (more % step if step else more):
            accepted = f"{least}, {least + step}, ..." if step else str(least)
            raise ValueError(f"{len(self.cells)} cells are not accepted; accepted: {accepted} of {self.quantity!r}")
        return self
