"""The published numbers, judged again by the claims of today: no run is needed where only rules or words changed.

`python -m experiments.site.judge_again` writes the claims, their figures and their summary in
docs/results, and what the README says of them. A number that is made otherwise than when it was published is not
measured until the next run. `tests/paper/docs` compares the published verdicts with these.
"""

import logging
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas as pd

from experiments.evaluation.figures.further.forest import STEMS, forest
from experiments.evaluation.measure.claims.cells import Evidence
from experiments.evaluation.measure.claims.scale import KnownMethods, control_of, weaknesses_of
from experiments.evaluation.measure.claims.verdicts import (
    ClaimNumbers,
    Row,
    claims_frame,
    judged,
    rows_of,
    score_of,
)
from experiments.evaluation.measure.claims.verdicts import numbers_of as measured_numbers
from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.further.claims_summary import claims_summary
from experiments.evaluation.tables.further.claims_table import claim_table
from experiments.evaluation.tables.further.claims_tolerance import claims_tolerance
from experiments.evaluation.tables.further.ten_first import ten_first
from experiments.settings.claims import Cell, Claim, numbers_of
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from experiments.settings.table_columns import SPREAD
from experiments.settings.verdicts import STAND_INS
from experiments.site.readme import tell_readme
from experiments.site.snapshot import (
    PICTURES,
    SNAPSHOT,
    note_entry,
    run_renewal,
    save_small,
    store_drawn,
)
from mobnet.core.rows import read_texts

log = logging.getLogger(__name__)
TABLE = (".csv", ".md", ".tex")  # endings of a published table
AGAIN = "judged after the run by rules of verdicts that CHANGELOG.md names"  # what the note of a snapshot says
Text = Mapping[str, str]


def judged_again(settings: Settings, published: Path) -> pd.DataFrame:
    """Return every claim with its published number and the verdicts by the present rules.

    Args:
        settings: the claims of today.
        published: a folder of published results, with claims.csv and the tables whose fields claims name.

    Raises:
        DataError: a table is missing or damaged.
    """
    before = {row["claim"]: row for row in read_texts(published / "claims.csv")}
    rows = list(rows_of(settings.claims))
    names: set[str] = set()
    for row in rows:
        for cell in _cells_of(row.claim):
            if cell.table:
                names.add(cell.table)
    tables = {name: read_texts(published / f"{name}.csv") for name in sorted(names)}
    evidence = Evidence(settings.layout, {}, {}, pd.DataFrame(), tables)
    statistics = settings.evaluation.statistics
    known = KnownMethods(settings.methods, settings.detection.detectors, settings.published.original_methods)
    again: list[dict[str, Any]] = []
    for row in rows:
        # What stands in for a network in the scores was judged in the run; a run before 0.7.0 did not do so.
        former = before.get(row.name, {})
        numbers = _numbers(row, former, evidence, settings)
        score = score_of(row.claim, settings.methods)
        control = {name: former[column] for name, column in STAND_INS.items() if former.get(column)}
        if is_of_tables(row.claim):
            control = control_of(row.claim, evidence, statistics, known)
        weaknesses = weaknesses_of(row.claim, score, numbers.ours, control, known)
        again.append(judged(row, numbers, score, statistics, control, weaknesses))
    return claims_frame(again)


def _numbers(row: Row, before: Text, evidence: Evidence, settings: Settings) -> ClaimNumbers:
    """Return the numbers of a claim, made of published tables where all its cells are fields of them."""
    claim = row.claim
    if is_of_tables(claim):
        return measured_numbers(claim, evidence, settings.evaluation.statistics)
    # A number that is made otherwise than when it was published is not measured until the next run.
    same = before if before.get("quantity") == claim.quantity else {}
    ours = _number(same, ("value", "low", "high"), claim)
    ours = replace(ours, networks=_counts(same, SPREAD[0]), walks=_counts(same, SPREAD[1]))
    stds = [_float(same, name) for name in SPREAD[2:]]
    ours = replace(ours, published=claim.published, std_networks=stds[0], std_walks=stds[1])
    signed = _number(same, ("sign_value", "sign_low", "sign_high"), claim) if claim.sign_of else ours
    without = _number(same, ("without", "without_low", "without_high"), claim) if claim.cause else None
    return ClaimNumbers(ours, signed, without)


def is_of_tables(claim: Claim) -> bool:
    """Return whether all numbers of a claim are made of fields of tables."""
    return all(cell.table for cell in _cells_of(claim))


def _cells_of(claim: Claim) -> list[Cell]:
    """Return the cells of all numbers that a claim needs."""
    cells: list[Cell] = []
    for number in numbers_of(claim):
        cells += number.cells
    return cells


def _number(row: Text, names: Sequence[str], claim: Claim) -> Number:
    """Return a number with its interval from columns of a row of claims.csv [unit of the claim]."""
    value, low, high = (_float(row, name) for name in names)
    return Number(value, low, high, unit=claim.unit)


def _float(row: Text, name: str) -> float | None:
    return float(row[name]) if row.get(name) else None


def _counts(row: Text, name: str) -> tuple[int, ...]:
    """Return how many networks or walks each part of a number has, `3+1` in the file."""
    return tuple(map(int, row[name].split("+"))) if row.get(name) else ()


def write_again(settings: Settings, published: Path) -> None:
    """Write the claims of published results, their figures and their summary by the present rules."""
    again = judged_again(settings, published)
    confidence = settings.evaluation.statistics.confidence
    with tempfile.TemporaryDirectory(dir=published.parent, prefix=".claims") as name:
        folder = Path(name)
        claim_table(again, confidence, folder)
        claims_summary(folder / "claims.csv", folder)
        claims_tolerance(folder / "claims.csv", folder)
        ten_first(settings.claims, folder / "claims.csv", settings.evaluation.statistics, folder)
        for path in sorted(folder.iterdir()):
            if path.suffix in TABLE:
                path.replace(published / path.name)
        forest(again, confidence, folder)
        for stem in STEMS.values():
            store_drawn(folder / f"{stem}.csv", published)
            for ending in PICTURES:
                picture = folder / f"{stem}{ending}"
                if picture.is_file():
                    save_small(picture, published / picture.name)
    note_entry(published, "claims", AGAIN)
    log.info("%s: %d claims are judged again", published, len(again))


def judge_published() -> None:
    """Judge the published claims, and renew what the README and the guide tell of results."""
    write_again(load_settings(), SNAPSHOT)
    tell_readme(SNAPSHOT)


def main() -> int:
    """Judge the published claims again; return the exit status."""
    return run_renewal(judge_published, log)


if __name__ == "__main__":
    sys.exit(main())
