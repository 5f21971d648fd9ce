"""Where claims stand beside the paper's numbers or beside their bounds, and the worst claim of each statement.

Of a claim with a number of the paper it is our number over the paper's; of a cut both are what remains of the error.
Without such a number it is how far ours lies on the claimed side of the claim's bound, as a share of the farthest end
of its interval.
"""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Mapping
from typing import Any

import pandas as pd

from experiments.evaluation.measure.claims.verdicts import WORST_FIRST, bounds_of
from experiments.evaluation.number.laws import number_from
from experiments.evaluation.number.number import is_missing
from experiments.intervals.bounds import Bounds
from experiments.settings.verdicts import VERDICTS

OVER_PAPER, BEYOND_BOUND = "ours over the original's", "beyond the bound"  # what an axis has
POSITION = ("at", "at_low", "at_high", "band_from", "band_to")  # columns: our number, its interval, and a range [-]
Claimed = Mapping[Any, Any]  # a claim as `judged` returns it
Ends = tuple[float | None, float | None]


def statements_of(claims: pd.DataFrame) -> pd.DataFrame:
    """Return the statements of judged claims, score by score, those that count against us first.

    Returns:
        A row for each statement: the columns of its worst claim, whose verdict it has, of how many `claims` it is one,
        and where that stands: its `axis`, and `POSITION` on it.
    """
    ranked = claims.assign(rank=claims["verdict"].map(WORST_FIRST.index))
    ranked["claims"] = ranked.groupby("statement")["claim"].transform("size")
    worst = ranked.loc[ranked.groupby("statement", sort=False)["rank"].idxmin()]
    scores = list(claims["score"].unique())
    order = worst.assign(score_rank=worst["score"].map(scores.index), shown=worst["verdict"].map(VERDICTS.index))
    worst = worst.loc[order.sort_values(["score_rank", "shown"], kind="stable").index].reset_index(drop=True)
    positions = pd.DataFrame([position_of(row) for row in worst.to_dict("records")], columns=["axis", *POSITION])
    return pd.concat([worst, positions.astype(dict.fromkeys(POSITION, float))], axis=1)


def position_of(row: Claimed) -> dict[str, Any]:
    """Return where a claim stands: its axis, and `POSITION` on it."""
    if is_missing(row["published"]):
        return {"axis": BEYOND_BOUND, **beyond_bound(row)}
    return {"axis": OVER_PAPER, **over_paper(row)}


def over_paper(row: Claimed) -> dict[str, float | None]:
    """Return where our number is over the paper's [-]; of a cut, where what remains of an error is."""
    published = row["published"] or 1.0
    is_cut = row["quantity"] == "cut"

    def over(number: float | None) -> float | None:
        if number is None:
            return None
        return (1.0 - number) / (1.0 - published) if is_cut else number / published

    (value, low, high) = map(over, number_from(row).with_ends)
    (first, last) = map(over, bounds_of(row))
    values = (value, *in_order(low, high, is_cut), *in_order(first, last, is_cut))
    return dict(zip(POSITION, values, strict=True))


def in_order(low: float | None, high: float | None, turned: bool) -> Ends:
    """Return two ends [-], the other way round where the axis is turned."""
    return (high, low) if turned else (low, high)


def beyond_bound(row: Claimed) -> dict[str, float | None]:
    """Return how far our number lies on the claimed side of its bound, as a share of the farthest end [-]."""
    margins: list[float | None] = []
    for number in number_from(row).with_ends:
        margins.append(None if number is None else margin(number, bounds_of(row)))
    sizes = [abs(each) for each in margins if each is not None]
    scale = max(sizes, default=0.0) or 1.0
    value, low, high = (None if each is None else each / scale for each in margins)
    if value is not None and low is not None and high is not None:  # in a two-sided range the middle lies farthest in
        low, high = min(low, high), max(low, high, value)
    return dict(zip(POSITION, (value, low, high, 0.0, None), strict=True))


def margin(number: float, bounds: Bounds) -> float:
    """Return how far a number lies inside a range, below zero outside [its unit]."""
    low, high = bounds
    return min(number - low if low is not None else float("inf"), high - number if high is not None else float("inf"))
