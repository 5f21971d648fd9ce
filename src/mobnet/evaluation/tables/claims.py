"""The paper's claims, checked against bounds that were fixed before any result was seen."""

from __future__ import annotations

import logging
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mobnet.core.files import write_text
from mobnet.evaluation.measure.results import Results, read_results
from mobnet.evaluation.number.claim import Claim, inside, read_claims, rule_text
from mobnet.evaluation.number.intervals import Summary, summarise
from mobnet.evaluation.number.quantities import QUANTITIES
from mobnet.evaluation.number.rows import write_rows
from mobnet.evaluation.tables.layout import Line, long_table, markdown_table, number, span, tex_escape

log = logging.getLogger(__name__)

REPRODUCED = "reproduced"
VERDICTS = (REPRODUCED, "direction only", "not reproduced", "not measured")
HEADER = ("Claim", "Printed in", "Paper", "Ours", "{:.0%}", "Differs", "Holds if", "Verdict")
CAPTION = r"\claimscaption"  # the paper's
COLUMNS = r">{\raggedright\arraybackslash}p{.385\linewidth}>{\raggedright\arraybackslash}p{.12\linewidth}rrrlll"


@dataclass(frozen=True)
class Verdict:
    """A claim, our number and what follows: a row of claims.csv.

    Attributes:
        claim: short name.
        printed: where the paper says it.
        says: the claim in our words.
        published: the paper's number [unit]; None where it gives none.
        value: ours [unit]; None where the tests are too short to hold what it is about, or all trainings diverged.
        low: lower end of its interval [unit]; None with a single run or none.
        high: upper end of its interval [unit]; None with a single run or none.
        seed_count: runs behind it.
        unit: unit of the numbers.
        differs: whether the interval leaves out equality, `yes` or `no`; empty without interval or comparison.
        rule: when the claim counts as reproduced.
        verdict: one of `VERDICTS`, from the value alone.
        cause: why it is not reproduced, as far as it was tested.
    """

    claim: str
    printed: str
    says: str
    published: float | None
    value: float | None
    low: float | None
    high: float | None
    seed_count: int
    unit: str
    differs: str
    rule: str
    verdict: str
    cause: str


def claims(
    config: Mapping[str, Any], claims_yaml: Path, scores: Iterable[Path], folders: Iterable[str], out_dir: Path
) -> None:
    """Judge every claim and write claims.csv, .tex and .md. A claim that fails is a result, not an error.

    Args:
        config: resolved configuration: `robot` and what intervals need.
        claims_yaml: the claims.
        scores: files of scores of all tests that the claims name.
        folders: of the trained networks whose losses they name.
        out_dir: where the three files go.

    Raises:
        ConfigError: a claim is not well formed.
        DataError: a run that a claim needs is missing.
    """
    results = read_results(Path(config["robot"]), scores, folders)
    verdicts = [judge(config, claim, results) for claim in read_claims(claims_yaml)]
    header = [text.format(config["evaluation"]["confidence"]) for text in HEADER]
    lines = [claim_line(verdict) for verdict in verdicts]
    full = [[*line, verdict.cause] for line, verdict in zip(lines, verdicts, strict=True)]
    write_rows(out_dir / "claims.csv", Verdict, verdicts)
    write_text(out_dir / "claims.tex", long_table(COLUMNS, CAPTION, header, list(with_causes(verdicts, lines))))
    write_text(out_dir / "claims.md", markdown_table([*header, "Cause"], full, left=len(header) + 1))
    for verdict in verdicts:
        log.info("%s: %s (%s, %s)", verdict.claim, verdict.verdict, number(verdict.value), verdict.rule)


def with_causes(verdicts: Sequence[Verdict], lines: Sequence[Line]) -> Iterator[Line]:
    """Yield the lines of claims, each followed by a line across all columns with its cause, where it has one."""
    across = rf"\multicolumn{{{len(HEADER)}}}{{@{{\quad}}p{{.96\linewidth}}}}"
    for verdict, line in zip(verdicts, lines, strict=True):
        yield line
        if verdict.cause:
            yield rf"{across}{{\emph{{{tex_escape(verdict.cause)}}}}} \\"


def judge(config: Mapping[str, Any], claim: Claim, results: Results) -> Verdict:
    """Return our number for a claim, its interval, and the verdict on the number itself.

    Raises:
        ConfigError: a cell is not well formed.
        DataError: a run is missing.
    """
    quantity = QUANTITIES[claim.quantity]
    grids = [results.grid(cell) for cell in claim.cells]
    held = [grid for grid in grids if grid is not None]
    ours = summarise(held, config, quantity.made) if len(held) == len(grids) else None
    verdict = verdict_of(ours, claim)
    numbers = (ours.value, ours.low, ours.high, ours.count) if ours else (None, None, None, 0)
    return Verdict(
        claim.name, claim.printed, claim.says, claim.published, *numbers, claim.unit, differs(ours, quantity.equality),
        rule_text(claim.reproduced), verdict, "" if verdict == REPRODUCED else claim.cause,
    )  # fmt: skip


def verdict_of(ours: Summary | None, claim: Claim) -> str:
    """Return one of `VERDICTS` for our number, in the claim's unit, such as [N m] or [-]."""
    if ours is None:
        return "not measured"
    met = (inside(ours.value, claim.reproduced), inside(ours.value, claim.direction), True)
    return VERDICTS[met.index(True)]


def differs(ours: Summary | None, equality: float | None) -> str:
    """Return whether an interval leaves out equality [unit], `yes` or `no`; nothing where one of them is missing."""
    if ours is None or ours.low is None or ours.high is None or equality is None:
        return ""
    return "no" if ours.low <= equality <= ours.high else "yes"


def claim_line(verdict: Verdict) -> list[str]:
    """Return the texts of a row of the table."""
    unit = "" if verdict.unit == "-" else f" {verdict.unit}"
    own = [verdict.says, verdict.printed, number(verdict.published), *ours_text(verdict)]
    return [*own, verdict.differs, verdict.rule + unit, verdict.verdict]


def ours_text(verdict: Verdict) -> tuple[str, str]:
    """Return our number and its interval as text; small ones with a unit get a digit more."""
    digits = 2 if verdict.unit == "-" or abs(verdict.value or 0.0) >= 1 else 3
    return number(verdict.value, digits), span(verdict.low, verdict.high, digits)
