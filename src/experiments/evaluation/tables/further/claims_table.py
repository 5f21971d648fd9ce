"""Table of the paper's claims, judged against their bounds."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from experiments.evaluation.measure.claims.verdicts import Judged
from experiments.evaluation.number.number import number_text
from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import GAP, Line, Table, long_table, tex_escape, write_table
from experiments.settings.claim_ranges import ANY, range_text, shown_range
from experiments.settings.table_columns import CLAIMS
from experiments.settings.verdicts import STAND_INS

HEADER = ("Claim", "Printed in", "Original", "Ours", "{:.0%}", "Claimed", "Size", "Sign", "Verdict")
# Columns of the Markdown table; in TeX they are lines below the claim.
REMARK, OTHER = "Cause, or what would decide", "By the other reading"
CAPTION = r"\claimscaption"  # the paper's
COLUMNS = r">{\raggedright\arraybackslash}p{.36\linewidth}>{\raggedright\arraybackslash}p{.13\linewidth}rrrllll"


def claim_table(judged: Sequence[Judged], confidence: float, table_dir: Path) -> None:
    """Write claims.csv, .md and .tex; the TeX file has no rows of single joints.

    `confidence` is that of the intervals, a share [-].
    """
    header = [text.format(confidence) for text in HEADER]
    lines = [[*line_of(each), each.remark, each.other] for each in judged]
    records = [record_of(each) for each in judged]
    table = Table(CLAIMS, records, [*header, REMARK, OTHER], lines, left=len(header) + 2)
    shown = [each for each in judged if not each.row.joint]
    write_table(table_dir / "claims", table, long_table(COLUMNS, CAPTION, header, list(with_remarks(shown))))


def record_of(each: Judged) -> tuple[Field, ...]:
    """Return the row of a claim in claims.csv."""
    row = each.row
    claim = each.row.claim
    ours = each.ours
    signed = each.found.signed.with_ends if each.ranges.sign else (None, None, None)
    without = each.found.without.with_ends if each.found.without else (None, None, None)
    return (
        row.name,
        row.statement,
        each.score,
        claim.printed,
        says(each),
        claim.quantity,
        ours.published,
        *ours.with_ends,
        *ours.spread,
        ours.unit,
        *(each.ranges.size or ANY),
        *signed,
        *(each.ranges.sign or ANY),
        each.size,
        each.sign,
        each.verdict,
        *without,
        each.cause,
        each.remark,
        each.other,
        "yes" if each.is_beyond_reach else "",
        *(each.control.get(name, "") for name in STAND_INS),
    )


def says(each: Judged) -> str:
    """Return what a claim says, with its joint where it is about one of several."""
    text = each.row.claim.says
    return f"{text.removesuffix('.')}, {each.row.joint}." if each.row.joint else text


def line_of(each: Judged) -> list[str]:
    """Return the texts of a row of the table."""
    claim = each.row.claim
    unit = "" if each.ours.unit == "-" else f" {each.ours.unit}"
    ours = [number_text(claim.published), *each.ours.texts()]
    return [
        says(each),
        claim.printed,
        *ours,
        range_text(shown_range(each.ranges)) + unit,
        each.size,
        each.sign,
        each.verdict,
    ]


def with_remarks(judged: Sequence[Judged]) -> Iterator[Line]:
    """Yield the lines of claims, a gap between statements, each followed by lines with what is remarked on it."""
    across = rf"\multicolumn{{{len(HEADER)}}}{{@{{\quad}}p{{.96\linewidth}}}}"
    before = ""
    for each in judged:
        if before and each.row.statement != before:
            yield GAP
        before = each.row.statement
        yield line_of(each)
        for text in filter(None, (each.remark, each.other)):
            yield rf"{across}{{\emph{{{tex_escape(text)}}}}} \\"
