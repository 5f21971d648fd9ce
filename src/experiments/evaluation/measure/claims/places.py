"""Where claims stand beside the paper's numbers or beside their bounds, and the worst claim of each statement.

Of a claim with a number of the paper it is our number over the paper's; of a cut both are what remains of the error.
Without such a number it is how far ours lies on the claimed side of the claim's bound, as a share of the farthest end
of its interval.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from experiments.evaluation.measure.claims.verdicts import WORST_FIRST, Judged
from experiments.intervals.bounds import Bounds
from experiments.settings.claim_ranges import shown_range
from experiments.settings.verdicts import VERDICTS

OVER_PAPER, BEYOND_BOUND = "ours over the original's", "beyond the bound"  # what an axis has


@dataclass(frozen=True)
class ClaimPosition:
    """Where a claim stands on its axis [-]: our number with its interval, and the range of the claimed size or sign."""

    judged: Judged
    axis: str
    values: tuple[float | None, float | None, float | None]
    band: Bounds


@dataclass(frozen=True)
class StatementPosition:
    """A statement of the paper or of ours: its worst claim, whose verdict it has, of so many."""

    worst: ClaimPosition
    claims: int

    @property
    def record(self) -> tuple[str | float | None, ...]:
        """Return the row of the figure's CSV file."""
        judged = self.worst.judged
        of = judged.score, judged.row.statement, self.claims, judged.row.name, judged.verdict, self.worst.axis
        return (*of, *self.worst.values, *self.worst.band)


def statements_of(judged: Sequence[Judged]) -> list[StatementPosition]:
    """Return the statements of claims, score by score, those that count against us first."""
    found: dict[str, list[Judged]] = {}
    for each in judged:
        found.setdefault(each.row.statement, []).append(each)
    worst = [(min(own, key=lambda each: WORST_FIRST.index(each.verdict)), len(own)) for own in found.values()]
    scores = list(dict.fromkeys(each.score for each in judged))
    ordered = sorted(worst, key=lambda each: (scores.index(each[0].score), VERDICTS.index(each[0].verdict)))
    return [StatementPosition(place_of(each), count) for each, count in ordered]


def place_of(judged: Judged) -> ClaimPosition:
    """Return where a claim stands."""
    return beyond_bound(judged) if judged.row.claim.published is None else over_paper(judged)


def over_paper(judged: Judged) -> ClaimPosition:
    """Return where our number is over the paper's [-]; of a cut, where what remains of an error is."""
    published = judged.row.claim.published or 1.0
    is_cut = judged.row.claim.quantity == "cut"

    def over(number: float | None) -> float | None:
        if number is None:
            return None
        return (1.0 - number) / (1.0 - published) if is_cut else number / published

    (value, low, high) = map(over, judged.ours.with_ends)
    (first, last) = map(over, shown_range(judged.ranges))
    return ClaimPosition(judged, OVER_PAPER, (value, *in_order(low, high, is_cut)), in_order(first, last, is_cut))


def in_order(low: float | None, high: float | None, turned: bool) -> tuple[float | None, float | None]:
    """Return two ends [-], the other way round where the axis is turned."""
    return (high, low) if turned else (low, high)


def beyond_bound(judged: Judged) -> ClaimPosition:
    """Return how far our number lies on the claimed side of its bound, as a share of the farthest end [-]."""
    found = [None if number is None else margin(number, shown_range(judged.ranges)) for number in judged.ours.with_ends]
    held = [each for each in found if each is not None]
    scale = max(map(abs, held), default=0.0) or 1.0
    value, low, high = (None if each is None else each / scale for each in found)
    if value is not None and low is not None and high is not None:  # in a two-sided range the middle lies farthest in
        low, high = min(low, high), max(low, high, value)
    return ClaimPosition(judged, BEYOND_BOUND, (value, low, high), (0.0, None))


def margin(number: float, bounds: Bounds) -> float:
    """Return how far a number lies inside a range, below zero outside [its unit]."""
    low, high = bounds
    return min(number - low if low is not None else float("inf"), high - number if high is not None else float("inf"))
