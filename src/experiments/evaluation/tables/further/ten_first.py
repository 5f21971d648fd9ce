"""The ten statements that a reader cares about, before all others: what the original says, and what holds here."""

from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from experiments.evaluation.measure.claims.verdicts import unit_text
from experiments.evaluation.number.frames import records_of
from experiments.evaluation.number.number import Number, is_missing, number_text
from experiments.evaluation.tables.layout import GAP, Line, Table, text_table, write_table
from experiments.evaluation.tables.look import Row
from experiments.settings.claims import Claim
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import TEN_FIRST
from mobnet.core.rows import read_texts

NUMBERS = ("published", "value", "low", "high")
HEADER = ("", "Statement", "Original", "Here", "{:.0%}", "Verdict")
REMARK, PICTURE = "Cause, or what would decide", "Picture"  # of the Markdown table; a page of TeX has no room for them
TEX_COLUMNS = r"rlrrll"


def ten_first(claims: Mapping[str, Claim], claims_csv: Path, statistics: Statistics, table_dir: Path) -> None:
    """Write ten_first.csv, .tex and .md: a row for each claim of these statements, in their order.

    Args:
        claims: all claims; those with a place among the ten are shown.
        claims_csv: the table of claims, judged.
        statistics: the confidence of the intervals.
        table_dir: folder of the tables.
    """
    rows = first_rows(claims, claims_csv)
    header = [text.format(statistics.confidence) for text in HEADER]
    lines: list[Line] = []
    tex: list[Line] = []
    for place, own in rows.groupby("place"):
        if tex:
            tex.append(GAP)
        for number, row in enumerate(own.to_dict("records")):
            cells = [str(place) if number == 0 else "", *cells_of(row)]
            tex.append(cells)
            lines.append([*cells, row["remark"], picture_link(row["picture"])])
    table = Table(TEN_FIRST, records_of(rows, TEN_FIRST), [*header, REMARK, PICTURE], lines, left=len(HEADER) + 2)
    write_table(table_dir / "ten_first", table, text_table(TEX_COLUMNS, header, tex))


def first_rows(claims: Mapping[str, Claim], claims_csv: Path) -> pd.DataFrame:
    """Return the rows of the table of claims that stand first, in their order, with `place` and `picture`."""
    places = {name: claim.first for name, claim in claims.items() if claim.first is not None}
    # The sort keeps the order of claims with the same place.
    names = sorted(places, key=lambda name: places[name])
    rows = pd.DataFrame(read_texts(claims_csv)).set_index("claim", drop=False).loc[names].copy()
    for name in NUMBERS:
        rows[name] = pd.to_numeric(rows[name])
    rows["place"] = [places[name] for name in names]
    rows["says"] = [claims[name].says for name in names]  # as it reads today, if the table is older
    rows["picture"] = [claims[name].picture or "" for name in names]
    return rows


def cells_of(row: Row) -> list[str]:
    """Return what is shown of a claim: what it says, the original's number, ours with its interval, and its verdict."""
    ours = Number(row["value"], row["low"], row["high"], unit=row["unit"])
    text, interval = ours.texts()
    if not is_missing(row["value"]):
        text += unit_text(row["unit"])
    return [row["says"], number_text(row["published"]), text, interval, row["verdict"]]


def picture_link(name: str) -> str:
    """Return a link to a figure that lies beside the table; empty where there is none."""
    return f"[{name}]({name}.png)" if name else ""
