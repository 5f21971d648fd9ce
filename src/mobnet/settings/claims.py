"""Claims of the paper and the bounds within which ours count as reproduced."""

from __future__ import annotations

from typing import Annotated, Any, cast

from pydantic import AfterValidator, model_validator

from mobnet.settings.base import LevelName, LimbOrJointName, MethodName, Real, Section, Some, TestName, Text

SHORT_CELL = ("level", "method", "joint")
TAKES = {  # quantity -> how many cells it takes: at least, and in steps of; a step of 0 is exactly
    "value": (1, 0), "ratio": (2, 0), "cut": (2, 0), "difference": (2, 0), "gap ratio": (4, 0),
    "below": (2, 1), "above": (2, 1), "falls": (2, 1), "least ratio": (2, 2),
}  # fmt: skip


def _ordered(bounds: tuple[float | None, float | None]) -> tuple[float | None, float | None]:
    """Check that a range has its lower end first; None is no bound."""
    low, high = bounds
    if low is not None and high is not None and low > high:
        raise ValueError("accepted: [low, high] with low <= high, null for no bound")
    return bounds


Bounds = Annotated[tuple[Real | None, Real | None], AfterValidator(_ordered)]


class Cell(Section):
    """A result that a claim's number is made of; several joints or metrics are averaged."""

    scenario: TestName | None = None
    level: LevelName | None = None
    method: MethodName | None = None
    joint: LimbOrJointName | tuple[LimbOrJointName, ...] | None = None
    metric: str | tuple[str, ...] | None = None


def spelt_out(cell: Any) -> dict[str, Any]:
    """Return a cell, written as a method's name, as [level, method, joint] or as a mapping, as a mapping."""
    if isinstance(cell, str):
        return {"method": cell}
    if isinstance(cell, dict):
        return cast("dict[str, Any]", cell)
    names = cast("list[Any]", cell) if isinstance(cell, list) else []
    if len(names) != len(SHORT_CELL):
        raise ValueError(f"cell {cell}: accepted: [{', '.join(SHORT_CELL)}], a method or a mapping")
    return dict(zip(SHORT_CELL, names, strict=True))


class Claim(Section):
    """What the paper says, where it is printed, and what must hold here; `quantity` is a key of `TAKES`."""

    printed: Text
    says: Text
    quantity: Text
    cells: Some[Cell]
    unit: Text
    published: Real | None
    reproduced: Bounds
    direction: Bounds
    cause: str = ""

    @model_validator(mode="before")
    @classmethod
    def _fill_in(cls, entry: Any) -> Any:
        """Spell out short cells, and put what the cells share, `at`, into each."""
        if not isinstance(entry, dict):
            return entry
        rest = cast("dict[str, Any]", entry).copy()
        shared, cells = cast("dict[str, Any]", rest.pop("at", None) or {}), rest.get("cells")
        if isinstance(cells, list):
            rest["cells"] = [{**shared, **spelt_out(cell)} for cell in cast("list[Any]", cells)]
        return rest

    @model_validator(mode="after")
    def _takes_its_cells(self) -> Claim:
        """Check that the quantity exists and takes as many cells."""
        if self.quantity not in TAKES:
            raise ValueError(f"quantity: {self.quantity!r} is not accepted; accepted: {', '.join(sorted(TAKES))}")
        least, step = TAKES[self.quantity]
        more = len(self.cells) - least
        if more < 0 or (more % step if step else more):
            accepted = f"{least}, {least + step}, ..." if step else str(least)
            raise ValueError(f"{len(self.cells)} cells; {self.quantity} takes {accepted}")
        return self
