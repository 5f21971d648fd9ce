"""Table of the paper's claims, judged against their bounds."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Iterator, Sequence
from pathlib import Path

import pandas as pd

from experiments.evaluation.measure.claims.verdicts import bounds_of, unit_text
from experiments.evaluation.number.frames import records_of
from experiments.evaluation.number.laws import number_from
from experiments.evaluation.number.number import number_text
from experiments.evaluation.tables.layout import GAP, Line, Table, long_table, tex_escape, write_table
from experiments.evaluation.tables.look import Row
from experiments.intervals.bounds import range_text
from experiments.settings.table_columns import CLAIMS

HEADER = ("Claim", "Printed in", "Original", "Ours", "{:.0%}", "Claimed", "Size", "Sign", "Verdict")
# Columns of the Markdown table; in TeX they are lines below the claim.
REMARK, OTHER = "Cause, or what would decide", "By the other reading"
CAPTION = r"\claimscaption"  # the paper's
COLUMNS = r">{\raggedright\arraybackslash}p{.36\linewidth}>{\raggedright\arraybackslash}p{.13\linewidth}rrrllll"


def claim_table(claims: pd.DataFrame, confidence: float, table_dir: Path) -> None:
    """Write claims.csv, .md and .tex; the TeX file has no rows of single joints.

    The claims are judged; `confidence` is that of the intervals, a share [-].
    """
    header = [text.format(confidence) for text in HEADER]
    rows = claims.to_dict("records")
    lines = [[*line_of(row), row["remark"], row["other_reading"]] for row in rows]
    table = Table(CLAIMS, records_of(claims, CLAIMS), [*header, REMARK, OTHER], lines, left=len(header) + 2)
    shown = [row for row in rows if not row["joint"]]
    write_table(table_dir / "claims", table, long_table(COLUMNS, CAPTION, header, list(with_remarks(shown))))


def line_of(row: Row) -> list[str]:
    """Return the texts of a row of the table."""
    ours = [number_text(row["published"]), *number_from(row).texts()]
    bounds = range_text(bounds_of(row)) + unit_text(row["unit"])
    return [row["says"], row["printed"], *ours, bounds, row["size"], row["sign"], row["verdict"]]


def with_remarks(rows: Sequence[Row]) -> Iterator[Line]:
    """Yield the lines of claims, a gap between statements, each followed by lines with what is remarked on it."""
    across = rf"\multicolumn{{{len(HEADER)}}}{{@{{\quad}}p{{.96\linewidth}}}}"
    before = ""
    for row in rows:
        if before and row["statement"] != before:
            yield GAP
        before = row["statement"]
        yield line_of(row)
        for text in filter(None, (row["remark"], row["other_reading"])):
            yield rf"{across}{{\emph{{{tex_escape(text)}}}}} \\"
