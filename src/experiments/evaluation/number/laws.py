"""Laws make a number with its interval of a group of rows; `measured` applies them group by group."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import pandas as pd

from experiments.evaluation.number.number import Number, is_missing
from experiments.intervals.clusters import ClusterKey, mean_in, share_in
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import SPREAD

ENDS = ("value", "low", "high")
Law = Callable[[pd.DataFrame], Number]


def measured(
    rows: pd.DataFrame, by: Sequence[str], laws: Mapping[str, Law], *, each: str = "", of: str = ""
) -> pd.DataFrame:
    """Return a row for each group and law: the group's place, `quantity`, the number, and of how many rows it is.

    Args:
        rows: what is measured.
        by: columns whose values make a group. Groups stand in the order of their values (`frames.ordered`).
        laws: quantity -> its law.
        each: a further column of that kind, of which every group has all values, also one of which it has no row.
        of: a flag. Laws get the rows where it is set; a group in which it is set nowhere has its row all the same,
            since nothing found is a result, too.
    """
    records: list[dict[str, object]] = []
    for keys, group in rows.groupby(list(by), observed=True):
        place = dict(zip(by, keys, strict=True))
        for value in rows[each].cat.categories if each else [None]:
            same = group[group[each] == value] if each else group
            same = same[same[of]] if of else same
            place |= {each: value} if each else {}
            for quantity, law in laws.items():
                records.append({**place, "quantity": quantity, **fields_of(law(same)), "count": len(same)})
    places = [*by, each] if each else [*by]
    columns = [*places, "quantity", *ENDS, *SPREAD, "unit", "published", "count"]
    # The places of groups keep their types, and so the order of their values.
    return pd.DataFrame(records, columns=columns).astype({name: rows[name].dtype for name in places})


def fields_of(number: Number) -> dict[str, object]:
    """Return a number as columns of a frame."""
    ends = dict(zip(ENDS, number.with_ends, strict=True))
    spread = dict(zip(SPREAD, number.spread, strict=True))
    return {**ends, **spread, "unit": number.unit, "published": number.published}


def number_from(row: Mapping[Any, Any]) -> Number:
    """Return the number that stands in the columns of a row, as `fields_of` writes them; some of them may lack."""
    names = (*ENDS, "published", *SPREAD[2:])
    value, low, high, published, *stds = (None if is_missing(row.get(name)) else row[name] for name in names)
    networks, walks = (_counts(row.get(name)) for name in SPREAD[:2])
    return Number(value, low, high, row.get("unit", "-"), published, networks, walks, *stds)


def numbers_by(rows: pd.DataFrame, by: str) -> dict[Any, Number]:
    """Return what names a row, a value of the column `by` -> the number in it."""
    return {row[by]: number_from(row) for row in rows.to_dict("records")}


def _counts(text: str | float | None) -> tuple[int, ...]:
    """Return the counts that stand in a column, a plus between those of several; NaN is an empty field of a file."""
    return tuple(int(count) for count in text.split("+") if count) if isinstance(text, str) else ()


def counted(column: str, value: object) -> Law:
    """Return the law of how many rows have a value in a column."""
    return lambda same: Number(int((same[column] == value).sum()))


def share(flag: str, statistics: Statistics) -> Law:
    """Return the law of the share of a flag [-] among the rows of which it is known, with its interval."""

    def law(same: pd.DataFrame) -> Number:
        known = same.dropna(subset=flag)
        return share_in(known[flag].astype(bool).tolist(), clusters(known), statistics)

    return law


def mean(column: str, unit: str, statistics: Statistics) -> Law:
    """Return the law of the mean of a column [unit] over the rows that have a value, with its interval."""

    def law(same: pd.DataFrame) -> Number:
        known = same.dropna(subset=column)
        return mean_in(known[column].tolist(), clusters(known), statistics, unit)

    return law


def clusters(rows: pd.DataFrame) -> list[ClusterKey]:
    """Return robot and walk of each row, which rows have in common: intervals are over both."""
    return [ClusterKey(*place) for place in zip(rows["robot"], rows["seed"], strict=True)]
