"""A claim of the paper as `configs/claims.yaml` words it: what it is about, and within which bounds it holds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import MISSING, dataclass, fields
from pathlib import Path
from typing import Any

from mobnet.core.config import read_yaml
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.evaluation.number.quantities import QUANTITIES

Bounds = tuple[float | None, float | None]
CELL_KEYS = ("scenario", "level", "method", "joint", "metric")
SHORT_CELL = ("level", "method", "joint")


@dataclass(frozen=True)
class Claim:
    """What the paper says and what must hold here.

    Attributes:
        name: short name.
        printed: where the paper says it.
        says: the claim in our words.
        quantity: a name of `QUANTITIES`.
        cells: results that the number is made of, each some of `CELL_KEYS`, as many as the quantity takes.
        unit: unit of the number.
        published: the paper's number [unit]; None where it gives none.
        reproduced: range [unit] in which ours counts as the paper's; None is no bound.
        direction: wider range [unit] in which ours points the paper's way.
        cause: why ours is not reproduced, as far as it was tested.
    """

    name: str
    printed: str
    says: str
    quantity: str
    cells: tuple[Mapping[str, Any], ...]
    unit: str
    published: float | None
    reproduced: Bounds
    direction: Bounds
    cause: str = ""


REQUIRED = [field.name for field in fields(Claim) if field.default is MISSING and field.name != "name"]
ACCEPTED = [*REQUIRED, "at", "cause"]


def read_claims(path: Path) -> list[Claim]:
    """Read claims.

    Raises:
        ConfigError: a key is unknown or missing, or the quantity does not fit the cells; the message names the claim.
    """
    entries = read_yaml(path)
    for name, entry in entries.items():
        fault = claim_fault(entry)
        if fault:
            raise ConfigError(f"{path}: {name}: {fault}")
    return [claim_of(name, **entry) for name, entry in entries.items()]


def claim_of(name: str, cells: Sequence[Any], at: Mapping[str, Any] | None = None, **entry: Any) -> Claim:
    """Return a claim whose cells have what they share, `at`, filled in."""
    return Claim(name=name, cells=tuple({**(at or {}), **cell_of(cell)} for cell in cells), **entry)


def cell_of(cell: Any) -> dict[str, Any]:
    """Return what a cell says of itself: a method's name, [level, method, joint], or a mapping."""
    if isinstance(cell, str):
        return {"method": cell}
    return dict(cell) if isinstance(cell, Mapping) else dict(zip(SHORT_CELL, cell, strict=True))


def claim_fault(entry: Mapping[str, Any]) -> str | None:
    """Return what is wrong with a claim's entry and what is accepted, or None."""
    fault = keys_fault(entry) or cells_fault(entry["quantity"], entry["cells"], entry.get("at", {}))
    return fault or bounds_fault("reproduced", entry["reproduced"]) or bounds_fault("direction", entry["direction"])


def keys_fault(entry: Mapping[str, Any]) -> str | None:
    """Return which key of a claim's entry is unknown or missing, or None."""
    unknown = [key for key in entry if key not in ACCEPTED]
    if unknown:
        return not_accepted("key", unknown[0], ACCEPTED)
    missing = [key for key in REQUIRED if key not in entry]
    return f"key {missing[0]!r} is missing" if missing else None


def cells_fault(quantity: str, cells: Sequence[Any], at: Mapping[str, Any]) -> str | None:
    """Return what is wrong with the quantity or the cells of a claim, or None."""
    if quantity not in QUANTITIES:
        return not_accepted("quantity", quantity, QUANTITIES)
    takes = QUANTITIES[quantity].takes
    if len(cells) not in takes:
        accepted = str(takes.start) if len(takes) == 1 else f"{takes.start}, {takes.start + takes.step}, ..."
        return f"{len(cells)} cells; {quantity} takes {accepted}"
    odd = [cell for cell in cells if isinstance(cell, list) and len(cell) != len(SHORT_CELL)]
    if odd:
        return f"cell {odd[0]} is not accepted; accepted: [{', '.join(SHORT_CELL)}], a method or a mapping"
    unknown = [key for cell in (at, *map(cell_of, cells)) for key in cell if key not in CELL_KEYS]
    return not_accepted("key of a cell", unknown[0], CELL_KEYS) if unknown else None


def bounds_fault(key: str, bounds: Sequence[float | None]) -> str | None:
    """Return what is wrong with a range [low, high], in the claim's unit such as [N m], or None."""
    known = [bound for bound in bounds if bound is not None]
    if len(bounds) == 2 and known == sorted(known):
        return None
    return f"{key}: {bounds} is not accepted; accepted: [low, high] with low <= high, null for no bound"


def inside(value: float, bounds: Bounds) -> bool:
    """Return whether a number lies in a closed range of its unit, [N m] or [-], None being no bound."""
    low, high = bounds
    return (low is None or value >= low) and (high is None or value <= high)


def rule_text(bounds: Bounds) -> str:
    """Return a range as text."""
    low, high = bounds
    if low is None:
        return "any" if high is None else f"at most {high:g}"
    return f"at least {low:g}" if high is None else f"{low:g} to {high:g}"
