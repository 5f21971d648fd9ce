"""Claims of the paper, by which rule they have bounds, and what numbers and causes are made of."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal, cast

from pydantic import AfterValidator, Field, model_validator

from experiments.settings.runs import Metric
from experiments.settings.verdicts import NOT_PRINTED
from mobnet.core.errors import not_accepted
from mobnet.formats.base import (
    Item,
    JointName,
    LevelName,
    LimbOrJointName,
    LowerName,
    MethodName,
    Real,
    ScaleName,
    ScenarioName,
    Section,
    Some,
    Text,
    distinct,
)
from mobnet.formats.reading import Place, mapping

MOST_FIRST = 10  # statements that stand before all others
SHORT_CELL = ("level", "method", "joint")
Quantity = Literal[
    "value",
    "ratio",
    "cut",
    "square cut",
    "difference",
    "gap ratio",
    "gap difference",
    "below",
    "above",
    "least ratio",
    "trend",
    "share",
]
TAKES: Mapping[Quantity, tuple[int, int]] = {  # how many cells: at least, and in steps of; a step of 0 is exactly
    "value": (1, 0),
    "ratio": (2, 0),
    "cut": (2, 0),
    "square cut": (2, 0),
    "difference": (2, 0),
    "gap ratio": (4, 0),
    "gap difference": (4, 0),
    "below": (2, 1),
    "above": (2, 1),
    "least ratio": (2, 2),
    "trend": (3, 1),
    "share": (1, 0),
}
Rule = Literal["about", "known", "at most", "larger", "similar", "little", "share", "bar", "sign"]
WITHOUT_NUMBER: tuple[Rule, ...] = ("similar", "bar", "sign")  # rules of claims for which the paper prints no number
TrainingMetric = Literal[
    "validation loss",
    "validation RMSE",
    "validation loss on windows",
    "training loss at the end",
    "validation loss at the end",
    "diverged",
]
ClaimName = Annotated[str, Field(pattern="^[a-z0-9][a-z0-9-]*$", max_length=50)]


def _ordered(bounds: tuple[float | None, float | None]) -> tuple[float | None, float | None]:
    """Check that a range has its lower end first and an end at all; None is no bound."""
    low, high = bounds
    if (low is None and high is None) or (low is not None and high is not None and low > high):
        raise ValueError("accepted: [low, high] with low <= high, null for no bound at one of them")
    return bounds


Day = Annotated[str, Field(pattern=r"^\d{4}-\d{2}-\d{2}$")]
Bound = Annotated[Real, Field(ge=-1000, le=1000)]
Bounds = Annotated[tuple[Bound | None, Bound | None], AfterValidator(_ordered)]
Several = Annotated[Some[Item], AfterValidator(distinct)]


class Cell(Section):
    """A result that a number is made of; several joints or metrics are averaged.

    It is a number of the scores, or of the trainings, which have a method and a metric of their own, or a field of a
    table: its `column` in the row that has the texts of `where`.
    """

    scenario: ScenarioName | None = None
    level: LevelName | None = None
    method: MethodName | None = None
    joint: LimbOrJointName | Several[LimbOrJointName] | None = None
    metric: TrainingMetric | Metric | Several[Metric] | None = None
    table: LowerName | None = None
    where: dict[LowerName, Text] = {}
    column: LowerName | None = None

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


def _spelt_number(entry: Any) -> Any:
    """Return what a number is made of with short cells as mappings, and what they share, `at`, in each."""
    shared: Any = mapping(entry).get("at", {})
    typed = mapping(entry).get("cells")
    if not isinstance(shared, Mapping) or not isinstance(typed, list):
        return entry
    cells: list[Any] = [_spelt_cell(cell) for cell in cast("list[Any]", typed)]
    rest = {key: value for key, value in mapping(entry).items() if key != "at"}
    shared_keys = mapping(cast("Any", shared))
    return {**rest, "cells": [{**shared_keys, **cell} if mapping(cell) else cell for cell in cells]}


def _spelt_claim(entry: Any) -> Any:
    """Return a claim with its cells, those that its sign is of, and those of its cause spelt out."""
    spelt = dict(mapping(_spelt_number(entry)))
    if mapping(spelt.get("sign_of")):
        spelt["sign_of"] = _spelt_number(spelt["sign_of"])
    cause = mapping(spelt.get("cause"))
    if mapping(cause.get("without")):
        spelt["cause"] = {**cause, "without": _spelt_number(cause["without"])}
    return spelt or entry


def spelt_out(claims: Any) -> Any:
    """Return claims, as they were typed, with all their cells as mappings."""
    return {name: _spelt_claim(entry) for name, entry in mapping(claims).items()} or claims


def where_typed(place: Place, claims: Mapping[str, Any]) -> Place:
    """Return where something of a cell was typed: in the cell, in what cells share, or by its order."""
    if "cells" not in place[2:-2]:
        return place
    before = place[: place.index("cells", 2)]
    entry: Any = claims
    for key in before[1:]:
        entry = entry[key]
    index, key, *rest = place[len(before) + 1 :]
    cell = entry["cells"][index]
    shared = mapping(entry.get("at"))
    if isinstance(cell, list) and key in SHORT_CELL:
        return (*before, "cells", index, SHORT_CELL.index(str(key)))
    typed = _spelt_cell(cell)
    return (*before, "at", key, *rest) if key in shared and key not in typed else place


class MadeNumber(Section):
    """A number that is made of cells, such as one with or without a cause."""

    quantity: Quantity
    cells: Some[Cell]

    @model_validator(mode="before")
    @classmethod
    def _fill_in(cls, entry: Any) -> Any:
        """Spell out short cells, and put what the cells share, `at`, into each."""
        return _spelt_number(entry)

    @model_validator(mode="after")
    def _takes_its_cells(self) -> MadeNumber:
        """Check that there are as many cells as the quantity takes."""
        least, step = TAKES[self.quantity]
        more = len(self.cells) - least
        if more < 0 or (more % step if step else more):
            accepted = f"{least}, {least + step}, ..." if step else str(least)
            raise ValueError(f"{len(self.cells)} cells are not accepted; accepted: {accepted} of {self.quantity!r}")
        return self


class Cause(Section):
    """What makes a claim's number what it is, and the number `without` it.

    `since` is the day of the commit that named it, `seen` whether results of the claim had been seen by then.
    """

    says: Text
    since: Day
    seen: bool
    without: MadeNumber


class OtherReading(Section):
    """What else the paper may mean: cells of tables with these texts in `where`. It is shown, and not judged."""

    says: Text
    where: Annotated[dict[LowerName, Text], Field(min_length=1)]


class Claim(MadeNumber):
    """What the paper says, where it is printed, and what must hold here.

    Claims of one `statement`, which has the name of its first claim, count once. `by_joint` makes a claim of each
    joint: its cells have this joint, and the paper prints this number. `sign` is the range of the claimed sign, where
    the rule does not make it, and `sign_of` the number that has it, where that is not the claim's own. `decided_at` are
    the scales whose walks decide it, where not all do that decide claims; elsewhere it stays open. `about` is the
    method that it speaks for, where that is not MOB-Net or else the first network that it names. `described` is why it
    is shown and never judged. `first` is its place among the ten statements that stand before all others, `picture` the
    figure that shows it.
    """

    statement: ClaimName | None = None
    about: MethodName | None = None
    printed: Text
    says: Text
    unit: Literal["N m", "N", "N s", "%", "ms", "-"]
    published: Bound | None
    by_joint: dict[JointName, Bound] = {}
    rule: Rule
    bar: Bounds | None = None
    sign: Bounds | None = None
    sign_of: MadeNumber | None = None
    decided_at: tuple[ScaleName, ...] = ()
    cause: Cause | None = None
    other: OtherReading | None = None
    described: Text | None = None
    first: Annotated[int, Field(ge=1, le=MOST_FIRST)] | None = None
    picture: LowerName | None = None

    @model_validator(mode="after")
    def _has_what_its_rule_needs(self) -> Claim:
        """Check that a rule has the paper's number, a bar or a sign, as it needs, and no second one."""
        wanted = {"bar": self.bar, "sign": self.sign}.get(self.rule, True)
        if wanted is None:
            raise ValueError(f"rule {self.rule!r} without `{self.rule}` is not accepted; accepted: with a range")
        if self.published is None and self.rule not in WITHOUT_NUMBER:
            raise ValueError(not_accepted("rule without a number of the paper", self.rule, WITHOUT_NUMBER))
        if self.rule == "sign" and (self.bar or self.published is not None):
            raise ValueError("rule 'sign' with a bar or a number of the paper is not accepted; accepted: `sign` alone")
        if self.sign_of and not self.sign:
            raise ValueError("`sign_of` without `sign` is not accepted; accepted: with the range of the sign")
        if self.printed == NOT_PRINTED and self.published is not None:
            raise ValueError(f"a number of the paper in a claim that is {NOT_PRINTED} is not accepted; accepted: null")
        return self

    @model_validator(mode="after")
    def _takes_its_cause_away(self) -> Claim:
        """Check that the number without a cause is of the claim's quantity."""
        if self.cause and self.cause.without.quantity != self.quantity:
            raise ValueError(not_accepted("quantity of a cause", self.cause.without.quantity, [self.quantity]))
        return self


def by_other_reading(claim: Claim) -> Claim | None:
    """Return a claim with the cells of the other reading; None where the paper has no second one."""
    if claim.other is None:
        return None
    cells = of_reading(claim, claim.other)
    sign_of = claim.sign_of
    if sign_of is not None:
        sign_of = sign_of.model_copy(update={"cells": of_reading(sign_of, claim.other)})
    return claim.model_copy(update={"cells": cells, "sign_of": sign_of, "cause": None, "other": None})


def of_reading(made: MadeNumber, other: OtherReading) -> tuple[Cell, ...]:
    """Return the cells of a number by another reading."""
    cells_of_reading: list[Cell] = []
    for cell in made.cells:
        cells_of_reading.append(cell.model_copy(update={"where": {**cell.where, **other.where}}))
    return tuple(cells_of_reading)


def numbers_of(claim: Claim) -> list[MadeNumber]:
    """Return the numbers that a claim needs: its own, that of its sign, and that without its cause."""
    further = [claim.sign_of, claim.cause.without if claim.cause else None]
    return [claim, *(number for number in further if number is not None)]
