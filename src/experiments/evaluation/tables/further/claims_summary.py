"""How many statements have each verdict, by score: what counts against us stands first.

The paper's statements and our own are counted apart.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.measure.claims.verdicts import worst
from experiments.evaluation.tables.layout import RULE, Line, Table, write_table
from experiments.intervals.bounds import within
from experiments.settings.table_columns import CLAIMED
from experiments.settings.verdicts import (
    BEYOND,
    HELD,
    JUDGED_WITH,
    NEAR,
    NOT_REPRODUCED,
    OPEN,
    OURS,
    PAPER,
    PRINTED,
    REPRODUCED,
    REPRODUCED_WITH,
    SCORED,
    SIGN_ONLY,
    SIGN_VERDICTS,
    SIZE_VERDICTS,
    STAND_INS,
    UNEXPLAINED,
    VERDICTS,
)
from mobnet.core.rows import read_texts

ALL = "all"  # verdicts together
NEAR_FACTOR = 1.5
USED = (
    *("statement", "score", "quantity", "size", "sign", "verdict"),
    *("published", "value", "low", "high", "cause", "beyond_reach"),
    *STAND_INS.values(),
)
SHOWN = {
    "observer": "observer",
    "networks": "networks",
    "no number": "no number",
    PAPER: "the original's, all",
    OURS: "our own",
}
Row = Mapping[str, str]
Counts = Mapping[tuple[str, str], tuple[int, int, int]]  # score, outcome -> statements, by their first claim, claims


def claims_summary(claims_csv: Path, table_dir: Path) -> None:
    """Write claims_summary.csv, .tex and .md: statements, and in the CSV file also claims, by score and verdict.

    A statement is one or several claims; its verdict is the worst of theirs. Beside the verdicts stands how many
    statements would be reproduced with methods that know nothing in the place of their networks, how many fail without
    a cause, how many open ones no affordable number of runs decides, and in how many claims the paper's number lies in
    our interval or near ours.
    """
    rows = read_texts(claims_csv, USED)
    counts: dict[tuple[str, str], tuple[int, int, int]] = {}
    for score in (*SCORED, PAPER):
        for name, numbers in outcomes_of(rows, score).items():
            counts[score, name] = numbers
    records = [(*place, *numbers) for place, numbers in counts.items()]
    lines: list[Line] = []
    for name in VERDICTS:
        lines.append([name, *(_begun(counts[score, name]) for score in SHOWN)])
    lines += [
        RULE,
        [ALL, *(str(counts[score, ALL][0]) for score in SHOWN)],
        *([REPRODUCED_WITH.format(name), *(_control(counts, score, name) for score in SHOWN)] for name in STAND_INS),
        [f"fail {UNEXPLAINED}", *(str(counts[score, UNEXPLAINED][0]) for score in SHOWN)],
        [f"{OPEN}, {BEYOND}", *(str(counts[score, BEYOND][0]) for score in SHOWN)],
        [f"claims {HELD}", *(_share(counts, score, HELD) for score in SHOWN)],
        [f"claims {NEAR}", *(_share(counts, score, NEAR) for score in SHOWN)],
    ]
    header = ["Statements (by first claim)", *SHOWN.values()]
    write_table(table_dir / "claims_summary", Table(CLAIMED, records, header, lines))


def _begun(count: tuple[int, int, int]) -> str:
    """Return how many statements there are, by their first claim in parentheses."""
    statements, firsts, _ = count
    return f"{statements} ({firsts})"


def _control(counts: Counts, score: str, name: str) -> str:
    """Return how many statements a method in the place of their networks reproduces, of those that it is judged on."""
    judged = counts[score, JUDGED_WITH.format(name)][0]
    return f"{counts[score, REPRODUCED_WITH.format(name)][0]} of {judged}" if judged else "-"


def _share(counts: Counts, score: str, name: str) -> str:
    """Return how many claims with a printed number have an outcome; a dash where the paper prints none."""
    printed = counts[score, PRINTED][2]
    return f"{counts[score, name][2]} of {printed}" if printed else "-"


def outcomes_of(rows: Sequence[Row], score: str) -> dict[str, tuple[int, int, int]]:
    """Return outcome -> how many statements of a score have it, how many by their first claim, and how many claims.

    `rows` have columns `CLAIMS`. The outcomes are the verdicts, those on the size and on the sign ("size inside"), all
    of them, those that a method in the place of the network is judged on and those that it reproduces, the claims that
    fail without a cause, those of open statements that no affordable number of runs decides, those that the paper
    prints a number of beside an interval of ours, and those whose interval holds this number or whose own number is
    near it. A statement fails with a cause if each of its claims that fail has one.
    """
    of_score = [row for row in rows if is_of(row, score)]
    by_statement: dict[str, list[Row]] = {}
    for row in of_score:
        by_statement.setdefault(row["statement"], []).append(row)
    by_name = list(by_statement.values())
    statements = Counter[str]()
    still_open: set[str] = set()
    for name, of_statement in by_statement.items():
        verdict = worst([row["verdict"] for row in of_statement])
        statements[verdict] += 1
        if verdict == OPEN:
            still_open.add(name)
    firsts = Counter(claims[0]["verdict"] for claims in by_name)
    claims = Counter(row["verdict"] for row in of_score)
    counts = {verdict: (statements[verdict], firsts[verdict], claims[verdict]) for verdict in VERDICTS}
    counts[ALL] = (len(by_name), len(by_name), len(of_score))
    printed = [row for row in of_score if row["published"] and row["low"] and row["high"]]
    selected = {
        UNEXPLAINED: [row for row in of_score if row["verdict"] in (NOT_REPRODUCED, SIGN_ONLY) and not row["cause"]],
        BEYOND: [row for row in of_score if row["statement"] in still_open and row["beyond_reach"]],
        PRINTED: printed,
        HELD: [row for row in printed if is_held(row)],
        NEAR: [row for row in printed if is_near(row)],
    }
    for kind, words in (("size", SIZE_VERDICTS), ("sign", SIGN_VERDICTS)):
        for word in words:
            selected[f"{kind} {word}"] = [row for row in of_score if row[kind] == word]
    first = {claims[0]["statement"]: claims[0] for claims in by_name}
    for name, column in STAND_INS.items():
        selected[JUDGED_WITH.format(name)] = [row for row in of_score if row[column]]
        selected[REPRODUCED_WITH.format(name)] = [row for row in of_score if row[column] == REPRODUCED]
    for name, some in selected.items():
        begun = [row for row in some if first[row["statement"]] is row]
        counts[name] = (len({row["statement"] for row in some}), len(begun), len(some))
    for name, column in STAND_INS.items():
        # As for a network, all claims of a statement have to be reproduced.
        whole = sum(all(row[column] == REPRODUCED for row in claims) for claims in by_name)
        _, firsts, single = counts[REPRODUCED_WITH.format(name)]
        counts[REPRODUCED_WITH.format(name)] = (whole, firsts, single)
    return counts


def is_of(row: Row, score: str) -> bool:
    """Return whether a claim counts in a score; all but our own are the paper's."""
    return row["score"] != OURS if score == PAPER else row["score"] == score


def is_held(row: Row) -> bool:
    """Return whether the interval of a claim, a row of columns `CLAIMS`, holds the number that the paper prints."""
    published, low, high = (float(row[name]) for name in ("published", "low", "high"))
    return within((published, published), (low, high))


def is_near(row: Row) -> bool:
    """Return whether our number lies within a factor `NEAR_FACTOR` of the paper's; of a cut, what remains does."""
    published = float(row["published"])
    value = float(row["value"])
    if row["quantity"] in ("cut", "square cut"):
        published = 1.0 - published
        value = 1.0 - value
    if published == 0.0:
        return value == 0.0
    return 1.0 / NEAR_FACTOR <= value / published <= NEAR_FACTOR
