"""How many statements of the paper have each verdict, by score: what counts against us stands first."""

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from mobnet.core.columns import CLAIMED, INSIDE, PRINTED, SCORED, UNEXPLAINED, VERDICTS
from mobnet.core.rows import read_texts
from mobnet.evaluation.measure.claims.bounds import within
from mobnet.evaluation.measure.claims.verdicts import NOT_REPRODUCED, worst
from mobnet.evaluation.tables.layout import RULE, Line, Table, write_table

ALL = "all"  # verdicts or scores together
USED = ("statement", "score", "verdict", "published", "low", "high", "cause")  # columns of claims.csv
Rows = Sequence[Mapping[str, str]]
Counts = Mapping[tuple[str, str], tuple[int, int]]  # score, outcome -> statements, claims


def claims_summary(claims_csv: Path, table_dir: Path) -> None:
    """Write claims_summary.csv, .tex and .md: statements, and in the CSV file also claims, by score and verdict.

    A statement is one or several claims; its verdict is the worst of theirs. Beside the verdicts stands how many
    statements fail without a cause, and in how many claims the paper's number lies in our interval.
    """
    rows = read_texts(claims_csv, USED)
    counts = {(score, name): found for score in (*SCORED, ALL) for name, found in outcomes_of(rows, score).items()}
    records = [(*place, *numbers) for place, numbers in counts.items()]
    first, *others = (*VERDICTS, ALL)
    shown = (first, UNEXPLAINED, *others)
    lines: list[Line] = [
        [score, *(str(counts[score, name][0]) for name in shown),
         f"{counts[score, INSIDE][1]} of {counts[score, PRINTED][1]}"]
        for score in (*SCORED, ALL)
    ]  # fmt: skip
    lines.insert(len(SCORED), RULE)
    header = ["Statements about", first, f"of these {UNEXPLAINED}", *others, "claims with the paper's number inside"]
    write_table(table_dir / "claims_summary", Table(CLAIMED, records, header, lines))


def outcomes_of(rows: Rows, score: str) -> dict[str, tuple[int, int]]:
    """Return outcome -> how many statements and claims of a score have it, of rows of columns `CLAIMS`.

    The outcomes are the verdicts, all of them, and those claims that fail without a cause in their statement, that the
    paper prints a number of beside an interval of ours, and whose interval holds this number.
    """
    own = [row for row in rows if score in (row["score"], ALL)]
    by_statement: dict[str, list[Mapping[str, str]]] = {}
    for row in own:
        by_statement.setdefault(row["statement"], []).append(row)
    statements = Counter(worst([row["verdict"] for row in held]) for held in by_statement.values())
    claims = Counter(row["verdict"] for row in own)
    caused = {row["statement"] for row in own if row["cause"]}
    printed = [row for row in own if row["published"] and row["low"] and row["high"]]
    selected = {
        UNEXPLAINED: [row for row in own if row["verdict"] == NOT_REPRODUCED and row["statement"] not in caused],
        PRINTED: printed,
        INSIDE: [row for row in printed if is_inside(row)],
    }
    return {
        **{verdict: (statements[verdict], claims[verdict]) for verdict in VERDICTS},
        ALL: (len(by_statement), len(own)),
        **{name: (len({row["statement"] for row in held}), len(held)) for name, held in selected.items()},
    }


def is_inside(row: Mapping[str, str]) -> bool:
    """Return whether the interval of a claim, a row of columns `CLAIMS`, holds the number that the paper prints."""
    published, low, high = (float(row[name]) for name in ("published", "low", "high"))
    return within((published, published), (low, high))
