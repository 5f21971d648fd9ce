"""How many statements have each verdict by how far a size may lie from the printed one.

All claims with a printed number are judged by one rule here, whatever their own: the size is inside if our interval
lies within a factor of the printed number, of a cut what remains of the error does, and of an ideal set-up up to it.
The verdict on the sign stays. So the table shows what hangs on the tolerance, which no paper prints.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.measure.claims.verdicts import verdict_of, worst
from experiments.evaluation.tables.layout import RULE, Line, Table, write_table
from experiments.intervals.bounds import Bounds, apart, within
from experiments.settings.table_columns import TOLERANCE
from experiments.settings.verdicts import DESCRIPTION, INSIDE, NOT_MEASURED, OPEN, OURS, OUTSIDE, REPRODUCED, VERDICTS
from mobnet.core.rows import read_texts

# [own] Factors between which the claims' own rules lie.
FACTORS = (1.1, 1.25, 1.5, 2.0, 2.5, 3.0)
BY_RULE = "the claims' own"
CUTS = ("cut", "square cut")
Row = Mapping[str, str]


def claims_tolerance(claims_csv: Path, table_dir: Path) -> None:
    """Write claims_tolerance.csv, .tex and .md: statements by verdict, a row for each tolerance, from claims.csv."""
    rows = [row for row in read_texts(claims_csv) if row["published"] and row["score"] != OURS]
    shown = [name for name in VERDICTS if name != NOT_MEASURED]
    records: list[tuple[str, str, int, int, int]] = []
    lines: list[Line] = []
    for factor in (*FACTORS, None):
        judged = [row["verdict"] if factor is None else verdict_within(row, factor) for row in rows]
        title = BY_RULE if factor is None else f"{factor:g}"
        counts = counts_of(rows, judged)
        records += [(title, name, *counts[name]) for name in VERDICTS]
        if factor is None:
            lines.append(RULE)
        lines.append([title, *(f"{counts[name][0]} ({counts[name][1]})" for name in shown)])
    header = ["Within a factor of (by first claim)", *shown]
    write_table(table_dir / "claims_tolerance", Table(TOLERANCE, records, header, lines))


def verdict_within(row: Row, factor: float) -> str:
    """Return the verdict on a claim, a row of `CLAIMS`, whose size may lie within a factor of the printed one."""
    if row["verdict"] == NOT_MEASURED:
        return NOT_MEASURED
    bounds = range_within(row, factor)
    size = OPEN
    if row["low"] and row["high"]:
        interval = float(row["low"]), float(row["high"])
        size = INSIDE if within(interval, bounds) else OUTSIDE if apart(interval, bounds) else OPEN
    verdict = verdict_of(size, row["sign"])
    # A claim that is too weak to count by its own rule does not count by another one.
    return DESCRIPTION if verdict == REPRODUCED and row["verdict"] == DESCRIPTION else verdict


def range_within(row: Row, factor: float) -> Bounds:
    """Return the range within a factor of the printed number of a claim [its unit]."""
    published = float(row["published"])
    if row["quantity"] in CUTS:
        left = 1.0 - published
        return 1.0 - left * factor, 1.0 - left / factor
    ends = sorted((published / factor, published * factor))
    is_ideal = not row["from"] and bool(row["to"])
    return None if is_ideal else ends[0], ends[1]


def counts_of(rows: Sequence[Row], judged: Sequence[str]) -> dict[str, tuple[int, int, int]]:
    """Return verdict -> how many statements have it by the worst of their claims, by their first claim, and claims."""
    statements: dict[str, list[str]] = {}
    for row, verdict in zip(rows, judged, strict=True):
        statements.setdefault(row["statement"], []).append(verdict)
    counts: dict[str, tuple[int, int, int]] = {}
    for name in VERDICTS:
        whole = sum(worst(verdicts) == name for verdicts in statements.values())
        firsts = sum(verdicts[0] == name for verdicts in statements.values())
        counts[name] = (whole, firsts, judged.count(name))
    return counts
