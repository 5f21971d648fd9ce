"""The paper's claims, and ours, against our numbers: verdicts that follow from intervals, and causes that explain.

Two verdicts follow from an interval and the closed ranges of a claim's size and of its sign: within its range a size is
`inside` and a sign the `same`, apart from it a size is `outside` and a sign `opposite`, and else both are `open`, which
a number without an interval always is. `verdict_of` joins them to one word.
"""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, get_args

import pandas as pd

from experiments.evaluation.measure.claims.cells import Evidence, listed
from experiments.evaluation.measure.claims.deciding import Effort, effort_of, text_of
from experiments.evaluation.number.laws import fields_of
from experiments.evaluation.number.number import Number, is_missing
from experiments.intervals.bounds import ANY, Bounds, verdict_on
from experiments.intervals.quantities import QUANTITIES, difference_of
from experiments.settings.claim_ranges import Ranges, ranges_of, shown_range
from experiments.settings.claims import MOST_FIRST, Claim, MadeNumber, TrainingMetric, by_other_reading
from experiments.settings.runs import Statistics
from experiments.settings.verdicts import (
    DESCRIPTION,
    INSIDE,
    NETWORKS,
    NO_NUMBER,
    NOT_MEASURED,
    NOT_PRINTED,
    NOT_REPRODUCED,
    OBSERVER,
    OPEN,
    OPPOSITE,
    OURS,
    OUTSIDE,
    REPRODUCED,
    SAME,
    SIGN_AT_LEAST,
    SIGN_ONLY,
    STAND_INS,
)
from mobnet.settings.methods import Method

DETECTOR = re.compile("-(OR|mean|sigma|ratio)$")  # what the name of a detector has behind that of its method
NO_CAUSE = "No cause found."
TO_MEASURE = "Not measured: the run lacks a test or training for it, or defined the number otherwise."
NOT_COUNTED = "Not counted as reproduced: {}."
NOT_JUDGED = "Described, not judged: {}"
REALS = (  # columns of numbers
    *("published", "value", "low", "high", "std_networks", "std_walks", "from", "to"),
    *("sign_value", "sign_low", "sign_high", "sign_from", "sign_to", "without", "without_low", "without_high"),
    *("shown_from", "shown_to"),
)
SHOWN_RANGE = ("shown_from", "shown_to")
WORST_FIRST = (NOT_REPRODUCED, SIGN_ONLY, NOT_MEASURED, OPEN, DESCRIPTION, SIGN_AT_LEAST, REPRODUCED)


@dataclass(frozen=True)
class Row:
    """A claim, or one of its joints, before it is judged.

    Attributes:
        statement: name of the claim that begins its statement; a statement counts once.
        joint: which joint it is about where the claim is made of each of several, else empty.
    """

    name: str
    statement: str
    claim: Claim
    joint: str = ""


@dataclass(frozen=True)
class ClaimNumbers:
    """The numbers of a claim: our own, the one whose sign is claimed, and the one without the claim's cause, if any.

    `other` has them by another reading of the paper, where it can be read in two ways.
    """

    ours: Number
    signed: Number
    without: Number | None = None
    other: "ClaimNumbers | None" = None


def rows_of(claims: Mapping[str, Claim]) -> Iterator[Row]:
    """Yield every claim, followed by those of its joints, which have no bar; a cause is of each joint by itself.

    The ten statements that stand first come first, in their order.
    """
    places = places_of(claims)
    names = sorted(claims, key=lambda name: places[claims[name].statement or name])
    for name in names:
        claim = claims[name]
        statement = claim.statement or name
        yield Row(name, statement, claim)
        for joint, printed in claim.by_joint.items():
            of_one: dict[str, object] = {"cells": of_joint(claim, joint), "published": printed, "bar": None}
            if claim.cause:
                without = claim.cause.without
                without = without.model_copy(update={"cells": of_joint(without, joint)})
                of_one["cause"] = claim.cause.model_copy(update={"without": without})
            yield Row(f"{name}-{joint}", statement, claim.model_copy(update=of_one), joint)


def places_of(claims: Mapping[str, Claim]) -> dict[str, int]:
    """Return the place of each statement among those that stand first; all others share the place behind them."""
    places: dict[str, int] = {}
    for name, claim in claims.items():
        statement = claim.statement or name
        places[statement] = min(places.get(statement, MOST_FIRST + 1), claim.first or MOST_FIRST + 1)
    return places


def of_joint(made: MadeNumber, joint: str) -> tuple[object, ...]:
    """Return the cells of a number, of one joint."""
    return tuple(cell.model_copy(update={"joint": joint}) for cell in made.cells)


def numbers_of(claim: Claim, results: Evidence, statistics: Statistics) -> ClaimNumbers:
    """Return the numbers that a claim needs [its unit]."""
    ours = made_number(claim, results, statistics, claim.unit)
    signed = made_number(claim.sign_of, results, statistics, claim.unit) if claim.sign_of else ours
    without = made_number(claim.cause.without, results, statistics, claim.unit) if claim.cause else None
    other = by_other_reading(claim)
    by_other = numbers_of(other, results, statistics) if other else None
    return ClaimNumbers(replace(ours, published=claim.published), signed, without, by_other)


def judged(
    row: Row,
    numbers: ClaimNumbers,
    score: str,
    statistics: Statistics,
    control: Mapping[str, str] | None = None,
    weaknesses: Sequence[str] = (),
) -> dict[str, Any]:
    """Return a claim with the verdicts that follow from its numbers, and what would decide those that are open.

    Args:
        row: the claim.
        numbers: our numbers; none where the tests are too short to hold what it is about, or all trainings diverged.
        score: one of `SCORED`.
        statistics: of the intervals.
        control: the verdict that it would have with each method of `STAND_INS` in its network's place, of those that
            could be judged.
        weaknesses: why it is not counted where it would be reproduced: it is a description then. A claim that is
            described is one whatever its number.

    Returns:
        The columns `CLAIMS`, its `joint`, and the ends of the range that pictures and tables show.
    """
    claim = row.claim
    ours = numbers.ours
    ranges = ranges_of(claim)
    size, sign, verdict = verdicts_of(numbers, ranges)
    is_weak = verdict == REPRODUCED and weaknesses
    if is_weak or (claim.described and verdict != NOT_MEASURED):
        verdict = DESCRIPTION
    efforts: list[Effort] = []
    if size == OPEN and ranges.size:
        efforts.append(effort_of(claim, ours, ranges.size, "size", statistics))
    if sign == OPEN and ranges.sign:
        efforts.append(effort_of(claim.sign_of or claim, numbers.signed, ranges.sign, "sign", statistics))
    cause = cause_of(claim, numbers, ranges) if verdict in (NOT_REPRODUCED, SIGN_ONLY) else ""
    is_beyond_reach = verdict == OPEN and all(effort.is_beyond for effort in efforts)
    no_ends = (None, None, None)
    return {
        "claim": row.name,
        "statement": row.statement,
        "joint": row.joint,
        "score": score,
        "printed": claim.printed,
        "says": f"{claim.says.removesuffix('.')}, {row.joint}." if row.joint else claim.says,
        "quantity": claim.quantity,
        **fields_of(ours),
        **_ends(("from", "to"), ranges.size or ANY),
        **_ends(("sign_value", "sign_low", "sign_high"), numbers.signed.with_ends if ranges.sign else no_ends),
        **_ends(("sign_from", "sign_to"), ranges.sign or ANY),
        **_ends(SHOWN_RANGE, shown_range(ranges)),
        "size": size,
        "sign": sign,
        "verdict": verdict,
        **_ends(("without", "without_low", "without_high"), numbers.without.with_ends if numbers.without else no_ends),
        "cause": cause,
        "remark": remark_of(claim, verdict, cause, efforts, weaknesses),
        "other_reading": other_reading(claim, numbers, ranges),
        "beyond_reach": "yes" if is_beyond_reach else "",
        **{column: (control or {}).get(name, "") for name, column in STAND_INS.items()},
    }


def claims_frame(rows: Sequence[Mapping[str, Any]]) -> pd.DataFrame:
    """Return claims, each as `judged` returns it, as a frame; a number that is missing is NaN."""
    table = pd.DataFrame(rows)
    return table.astype(dict.fromkeys(REALS, float))


def _ends(names: Sequence[str], values: Sequence[float | None]) -> dict[str, float | None]:
    """Return values in columns of these names."""
    return dict(zip(names, values, strict=True))


def cause_of(claim: Claim, numbers: ClaimNumbers, ranges: Ranges) -> str:
    """Return why a claim that fails is not reproduced, as far as a number says: it would not fail without its cause."""
    if claim.cause is None or numbers.without is None or not is_within(numbers.without, shown_range(ranges)):
        return ""
    without = " ".join(numbers.without.texts()) + unit_text(numbers.ours.unit)
    seen = "after" if claim.cause.seen else "before"
    return f"{claim.cause.says}: {without} without it (named {claim.cause.since}, {seen} results had been seen)."


def other_reading(claim: Claim, numbers: ClaimNumbers, ranges: Ranges) -> str:
    """Return our number by the other reading of the paper and what its verdict would be; it counts nowhere."""
    if claim.other is None or numbers.other is None or numbers.other.ours.value is None:
        return ""
    _, _, verdict = verdicts_of(numbers.other, ranges)
    number = " ".join(numbers.other.ours.texts()).strip()
    return f"With {claim.other.says}: {number}{unit_text(numbers.ours.unit)}, {verdict}."


def remark_of(claim: Claim, verdict: str, cause: str, efforts: Sequence[Effort], weaknesses: Sequence[str]) -> str:
    """Return what stands below a claim: the cause of one that fails, if one is found, or what decides an open one.

    Below a description stands why it is not counted. It is empty where nothing is open and nothing fails.
    """
    if verdict == NOT_MEASURED:
        return TO_MEASURE
    if claim.described:
        return NOT_JUDGED.format(claim.described)
    if verdict == DESCRIPTION:
        return NOT_COUNTED.format("; ".join(weaknesses))
    if verdict in (NOT_REPRODUCED, SIGN_ONLY):
        return f"Cause: {cause}" if cause else NO_CAUSE
    return text_of(efforts, claim.decided_at)


def bounds_of(row: Mapping[Any, Any]) -> Bounds:
    """Return the range of a judged claim that pictures and tables show [its unit]."""
    low, high = (None if is_missing(row[name]) else row[name] for name in SHOWN_RANGE)
    return low, high


def unit_text(unit: str) -> str:
    """Return a unit behind a number; nothing where there is none."""
    return "" if unit == "-" else f" {unit}"


def verdicts_of(numbers: ClaimNumbers, ranges: Ranges) -> tuple[str, str, str]:
    """Return the verdict on the size, that on the sign, each empty where there is none, and both as one."""
    if numbers.ours.value is None:
        return "", "", NOT_MEASURED
    size = _verdict(numbers.ours, ranges.size, (INSIDE, OUTSIDE)) if ranges.size else ""
    sign = _verdict(numbers.signed, ranges.sign, (SAME, OPPOSITE)) if ranges.sign else ""
    return size, sign, verdict_of(size, sign)


def _verdict(number: Number, bounds: Bounds, words: tuple[str, str]) -> str:
    """Return the first word for a number within a range [its unit], the second one for one apart from it, or `OPEN`."""
    return {"inside": words[0], "outside": words[1], "open": OPEN}[verdict_on(number, bounds)]


def is_within(number: Number, bounds: Bounds) -> bool:
    """Return whether the interval of a number lies in a range [its unit]."""
    return verdict_on(number, bounds) == "inside"


def verdict_of(size: str, sign: str) -> str:
    """Return one of `VERDICTS` for the verdicts on size and sign, of which one may be empty."""
    if sign == OPPOSITE or (size == OUTSIDE and sign != SAME):
        return NOT_REPRODUCED
    if size == OUTSIDE:
        return SIGN_ONLY
    if size == OPEN and sign == SAME:
        return SIGN_AT_LEAST
    return OPEN if OPEN in (size, sign) else REPRODUCED


def made_number(made: MadeNumber, results: Evidence, statistics: Statistics, unit: str = "-") -> Number:
    """Return what cells make, with its interval [unit]; no number where a cell has none."""
    if all(cell.table and results.is_one(cell) for cell in made.cells):
        entries = [results.entry(cell) for cell in made.cells]
        if made.quantity == "value":
            return replace(entries[0], unit=unit)
        if made.quantity == "difference":
            return difference_of(entries[0], entries[1], unit)
    cells = [results.grids(cell) for cell in made.cells]
    measured = [cell for cell in cells if cell is not None]
    if len(measured) < len(cells):
        return Number(None, unit=unit)
    return QUANTITIES[made.quantity](measured, statistics, unit)


def score_of(claim: Claim, methods: Mapping[str, Method]) -> str:
    """Return in which score a claim counts, one of `SCORED`."""
    if claim.printed == NOT_PRINTED:
        return OURS
    if claim.published is None:
        return NO_NUMBER
    trained = any(listed(cell.metric or "")[0] in get_args(TrainingMetric) for cell in claim.cells)
    names = [cell.method or DETECTOR.sub("", cell.where.get("detector", "")) for cell in claim.cells]
    named = [methods[name] for name in names if name in methods]
    return NETWORKS if trained or any(method.limbs for method in named) else OBSERVER


def worst(verdicts: Sequence[str]) -> str:
    """Return the verdict on a statement, which is that on the worst of its claims."""
    return min(verdicts, key=WORST_FIRST.index)
