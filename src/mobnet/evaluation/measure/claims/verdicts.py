"""The paper's claims against our numbers: verdicts that follow from intervals, and causes that numbers show.

With the range in which a claim is reproduced and the wider one of its direction, both closed, our interval is

    reproduced      inside the first range
    direction       inside the second one, and not inside the first
    not reproduced  outside the second one
    inconclusive    partly inside the second one, or there is no interval
"""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import get_args

from mobnet.core.columns import LEARNED, OBSERVER, SIGN_ONLY, VERDICTS
from mobnet.evaluation.measure.claims.bounds import Ranges, apart, ranges_of, within
from mobnet.evaluation.measure.claims.cells import Evidence, listed
from mobnet.evaluation.number.number import Number
from mobnet.evaluation.number.quantities import QUANTITIES
from mobnet.settings.claims import CAUSED, Claim, MadeNumber, TrainingMetric
from mobnet.settings.methods import Method
from mobnet.settings.runs import Statistics

NOT_REPRODUCED, INCONCLUSIVE, DIRECTION, REPRODUCED, NOT_MEASURED = VERDICTS
DETECTOR = re.compile("-(OR|mean|sigma)$")  # what the name of a detector has behind that of its method
WORST_FIRST: Sequence[str] = (NOT_REPRODUCED, NOT_MEASURED, INCONCLUSIVE, DIRECTION, REPRODUCED)


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
class Judged:
    """A claim with our number, what it is held against, and what follows.

    Attributes:
        score: one of `SCORED`: about the observer alone, about networks, or without a number of the paper.
        ours: our number; none where the tests are too short to hold what it is about, or all trainings diverged.
        verdict: one of `VERDICTS`.
        cause: why it is not reproduced, as far as numbers say; empty where it is, and where they do not.
    """

    row: Row
    score: str
    ours: Number
    ranges: Ranges
    verdict: str
    cause: str


def rows_of(claims: Mapping[str, Claim]) -> Iterator[Row]:
    """Yield every claim, each followed by those of its joints, which have neither a bar of their own nor a cause."""
    for name, claim in claims.items():
        statement = claim.statement or name
        yield Row(name, statement, claim)
        for joint, printed in claim.by_joint.items():
            cells = tuple(cell.model_copy(update={"joint": joint}) for cell in claim.cells)
            own = {"cells": cells, "published": printed, "bar": None, "side": None, "cause": "", "numbers": {}}
            yield Row(f"{name}-{joint}", statement, claim.model_copy(update=own), joint)


def judge(row: Row, results: Evidence, statistics: Statistics, methods: Mapping[str, Method]) -> Judged:
    """Return our number for a claim with its interval, and the verdict."""
    claim, ranges = row.claim, ranges_of(row.claim)
    ours = replace(made_number(claim, results, statistics, claim.unit), published=claim.published)
    verdict = verdict_of(ours, ranges)
    cause = "" if verdict == REPRODUCED else cause_of(claim, results, statistics)
    return Judged(row, score_of(claim, methods), ours, ranges, verdict, cause)


def made_number(made: MadeNumber, results: Evidence, statistics: Statistics, unit: str = "-") -> Number:
    """Return what cells make, with its interval [unit]; no number where a cell has none."""
    first = made.cells[0]
    if made.quantity == "value" and first.table and results.is_one(first):
        return replace(results.entry(first), unit=unit)
    cells = [results.grids(cell) for cell in made.cells]
    held = [cell for cell in cells if cell is not None]
    if len(held) < len(cells):
        return Number(None, unit=unit)
    return QUANTITIES[made.quantity](held, statistics, unit)


def verdict_of(ours: Number, ranges: Ranges) -> str:
    """Return one of `VERDICTS` for our number [its unit]."""
    if ours.value is None:
        return NOT_MEASURED
    if ours.low is None or ours.high is None:
        return INCONCLUSIVE
    interval = ours.low, ours.high
    if within(interval, ranges.reproduced):
        return REPRODUCED
    if within(interval, ranges.side):
        return DIRECTION
    return NOT_REPRODUCED if apart(interval, ranges.side) else INCONCLUSIVE


def score_of(claim: Claim, methods: Mapping[str, Method]) -> str:
    """Return in which score a claim counts, one of `SCORED`."""
    if claim.published is None:
        return SIGN_ONLY
    trained = any(listed(cell.metric or "")[0] in get_args(TrainingMetric) for cell in claim.cells)
    names = [cell.method or DETECTOR.sub("", cell.where.get("detector", "")) for cell in claim.cells]
    named = [methods[name] for name in names if name in methods]
    return LEARNED if trained or any(method.limbs for method in named) else OBSERVER


def cause_of(claim: Claim, results: Evidence, statistics: Statistics) -> str:
    """Return a cause with the number where it is given and where it is taken away; empty if it does not change.

    It changes if the two intervals have no number in common.
    """
    if not claim.cause:
        return ""
    given, without = (made_number(claim.numbers[name], results, statistics, claim.unit) for name in CAUSED)
    if given.low is None or given.high is None or not apart((given.low, given.high), (without.low, without.high)):
        return ""
    unit = "" if claim.unit == "-" else f" {claim.unit}"
    with_it, without_it = (" ".join(number.texts()) + unit for number in (given, without))
    return f"{claim.cause}: {with_it} with it, {without_it} without it."


def worst(verdicts: Sequence[str]) -> str:
    """Return the verdict on a statement, which is that on the worst of its claims."""
    return min(verdicts, key=WORST_FIRST.index)
