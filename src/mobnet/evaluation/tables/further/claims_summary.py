"""How many statements of the paper have each verdict, by score: what counts against us stands first."""

from collections import Counter
from collections.abc import Mapping
from pathlib import Path

from mobnet.core.columns import CLAIMED, SCORED, VERDICTS
from mobnet.evaluation.measure.claims.verdicts import worst
from mobnet.evaluation.number.files import read_texts
from mobnet.evaluation.tables.layout import RULE, Line, Table, write_table

ALL = "all"  # verdicts or scores together
Counts = Mapping[tuple[str, str], tuple[int, int]]  # score, verdict -> statements, claims


def claims_summary(claims_csv: Path, table_dir: Path) -> None:
    """Write claims_summary.csv, .tex and .md: statements, and in the CSV file also claims, by score and verdict.

    A statement is one or several claims; its verdict is the worst of theirs.
    """
    rows = read_texts(claims_csv, ["statement", "score", "verdict"])
    counts = counts_of(rows)
    records = [(*place, *numbers) for place, numbers in counts.items()]
    lines: list[Line] = [
        [score, *(str(counts[score, verdict][0]) for verdict in (*VERDICTS, ALL))] for score in (*SCORED, ALL)
    ]
    lines.insert(len(SCORED), RULE)
    header = ["Statements about", *VERDICTS, ALL]
    write_table(table_dir / "claims_summary", Table(CLAIMED, records, header, lines))


def counts_of(rows: list[dict[str, str]]) -> Counts:
    """Return how many statements and claims there are of each score and verdict, of rows of columns `CLAIMS`."""
    verdicts: dict[tuple[str, str], list[str]] = {}
    for row in rows:
        verdicts.setdefault((row["score"], row["statement"]), []).append(row["verdict"])
    statements = Counter((score, worst(own)) for (score, _), own in verdicts.items())
    claims = Counter((row["score"], row["verdict"]) for row in rows)
    return {
        (score, verdict): (_sum(statements, score, verdict), _sum(claims, score, verdict))
        for score in (*SCORED, ALL)
        for verdict in (*VERDICTS, ALL)
    }


def _sum(counts: Mapping[tuple[str, str], int], score: str, verdict: str) -> int:
    """Return the sum of counts by score and verdict over one of each, or over all."""
    return sum(n for (own, is_), n in counts.items() if score in (own, ALL) and verdict in (is_, ALL))
