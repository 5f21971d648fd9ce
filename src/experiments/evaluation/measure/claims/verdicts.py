"""The paper's claims, and ours, against our numbers: verdicts that follow from intervals, and causes that explain.

Two verdicts follow from an interval and the closed ranges of a claim's size and of its sign: within its range a size is
`inside` and a sign the `same`, apart from it a size is `outside` and a sign `opposite`, and else both are `open`, which
a number without an interval always is. `verdict_of` joins them to one word.
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import get_args

from experiments.evaluation.measure.claims.cells import Evidence, listed
from experiments.evaluation.measure.claims.deciding import Effort, effort_of, text_of
from experiments.evaluation.number.number import Number
from experiments.intervals.bounds import Bounds, verdict_on
from experiments.intervals.quantities import QUANTITIES, difference_of
from experiments.settings.claim_ranges import Ranges, ranges_of, shown_range
from experiments.settings.claims import Claim, MadeNumber, TrainingMetric, by_other_reading
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
)
from mobnet.settings.methods import Method

DETECTOR = re.compile("-(OR|mean|sigma|ratio)$")  # what the name of a detector has behind that of its method
NO_CAUSE = "No cause found."
TO_MEASURE = "Not measured: the run lacks a test or training for it, or defined the number otherwise."
NOT_COUNTED = "Not counted as reproduced: {}."
NOT_JUDGED = "Described, not judged: {}"
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


@dataclass(frozen=True)
class Judged:
    """A claim with our numbers, what they are held against, and what follows.

    Attributes:
        score: one of `SCORED`: about the observer alone, about networks, without a number of the paper, or ours.
        found: our numbers; none where the tests are too short to hold what it is about, or all trainings diverged.
        size: one of `SIZE_VERDICTS`, or empty where no size is claimed.
        sign: one of `SIGN_VERDICTS`, or empty where no sign is claimed.
        verdict: both together, one of `VERDICTS`.
        is_explained: whether the claim fails and would not without its cause.
        efforts: what decides the size and the sign, of those that are open.
        control: the verdict that it would have with each method of `STAND_INS` in its network's place, of those that
            could be judged.
        weaknesses: why a description is not counted as reproduced.
    """

    row: Row
    score: str
    found: ClaimNumbers
    ranges: Ranges
    size: str
    sign: str
    verdict: str
    is_explained: bool
    efforts: tuple[Effort, ...] = ()
    control: Mapping[str, str] = field(default_factory=dict[str, str])
    weaknesses: tuple[str, ...] = ()

    @property
    def ours(self) -> Number:
        """Our number, beside the paper's."""
        return self.found.ours

    @property
    def cause(self) -> str:
        """Why it is not reproduced, as far as a number says; empty where it is, and where none does."""
        if not self.is_explained or self.row.claim.cause is None or self.found.without is None:
            return ""
        cause = self.row.claim.cause
        unit = "" if self.ours.unit == "-" else f" {self.ours.unit}"
        without = " ".join(self.found.without.texts()) + unit
        seen = "after" if cause.seen else "before"
        return f"{cause.says}: {without} without it (named {cause.since}, {seen} results had been seen)."

    @property
    def other(self) -> str:
        """Our number by the other reading of the paper and what its verdict would be; it counts nowhere."""
        reading = self.row.claim.other
        if reading is None or self.found.other is None or self.found.other.ours.value is None:
            return ""
        _, _, verdict = verdicts_of(self.found.other, self.ranges)
        unit = "" if self.ours.unit == "-" else f" {self.ours.unit}"
        number = " ".join(self.found.other.ours.texts()).strip()
        return f"With {reading.says}: {number}{unit}, {verdict}."

    @property
    def remark(self) -> str:
        """What stands below the claim: the cause of one that fails, or that none is found, or what decides an open one.

        Below a description stands why it is not counted. It is empty where nothing is open and nothing fails.
        """
        if self.verdict == NOT_MEASURED:
            return TO_MEASURE
        if self.row.claim.described:
            return NOT_JUDGED.format(self.row.claim.described)
        if self.verdict == DESCRIPTION:
            return NOT_COUNTED.format("; ".join(self.weaknesses))
        if self.verdict in (NOT_REPRODUCED, SIGN_ONLY):
            return f"Cause: {self.cause}" if self.cause else NO_CAUSE
        return text_of(self.efforts, self.row.claim.decided_at)

    @property
    def is_beyond_reach(self) -> bool:
        """Whether the claim is open and no affordable number of runs decides its size or its sign."""
        return self.verdict == OPEN and all(effort.is_beyond for effort in self.efforts)


def rows_of(claims: Mapping[str, Claim]) -> Iterator[Row]:
    """Yield every claim, followed by those of its joints, which have no bar; a cause is of each joint by itself."""
    for name, claim in claims.items():
        statement = claim.statement or name
        yield Row(name, statement, claim)
        for joint, printed in claim.by_joint.items():
            own: dict[str, object] = {"cells": of_joint(claim, joint), "published": printed, "bar": None}
            if claim.cause:
                without = claim.cause.without
                without = without.model_copy(update={"cells": of_joint(without, joint)})
                own["cause"] = claim.cause.model_copy(update={"without": without})
            yield Row(f"{name}-{joint}", statement, claim.model_copy(update=own), joint)


def of_joint(made: MadeNumber, joint: str) -> tuple[object, ...]:
    """Return the cells of a number, of one joint."""
    return tuple(cell.model_copy(update={"joint": joint}) for cell in made.cells)


def judge(row: Row, results: Evidence, statistics: Statistics, methods: Mapping[str, Method]) -> Judged:
    """Return our numbers for a claim with their intervals, and the verdicts that follow from them alone."""
    return judged(row, found_of(row.claim, results, statistics), score_of(row.claim, methods), statistics)


def found_of(claim: Claim, results: Evidence, statistics: Statistics) -> ClaimNumbers:
    """Return the numbers that a claim needs [its unit]."""
    ours = made_number(claim, results, statistics, claim.unit)
    signed = made_number(claim.sign_of, results, statistics, claim.unit) if claim.sign_of else ours
    without = made_number(claim.cause.without, results, statistics, claim.unit) if claim.cause else None
    other = by_other_reading(claim)
    found = found_of(other, results, statistics) if other else None
    return ClaimNumbers(replace(ours, published=claim.published), signed, without, found)


def judged(row: Row, found: ClaimNumbers, score: str, statistics: Statistics) -> Judged:
    """Return a claim with the verdicts that follow from its numbers, and what would decide those that are open."""
    ranges = ranges_of(row.claim)
    size, sign, verdict = verdicts_of(found, ranges)
    explained = False
    if verdict in (NOT_REPRODUCED, SIGN_ONLY) and found.without is not None:
        explained = is_within(found.without, shown_range(ranges))
    efforts: list[Effort] = []
    if size == OPEN and ranges.size:
        efforts.append(effort_of(row.claim, found.ours, ranges.size, "size", statistics))
    if sign == OPEN and ranges.sign:
        efforts.append(effort_of(row.claim.sign_of or row.claim, found.signed, ranges.sign, "sign", statistics))
    return Judged(row, score, found, ranges, size, sign, verdict, explained, tuple(efforts))


def verdicts_of(found: ClaimNumbers, ranges: Ranges) -> tuple[str, str, str]:
    """Return the verdict on the size, that on the sign, each empty where there is none, and both as one."""
    if found.ours.value is None:
        return "", "", NOT_MEASURED
    size = _word(found.ours, ranges.size, (INSIDE, OUTSIDE)) if ranges.size else ""
    sign = _word(found.signed, ranges.sign, (SAME, OPPOSITE)) if ranges.sign else ""
    return size, sign, verdict_of(size, sign)


def _word(number: Number, bounds: Bounds, words: tuple[str, str]) -> str:
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
    held = [cell for cell in cells if cell is not None]
    if len(held) < len(cells):
        return Number(None, unit=unit)
    return QUANTITIES[made.quantity](held, statistics, unit)


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
