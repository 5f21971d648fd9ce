"""The paper's claims, checked against bounds that were fixed before any result was seen."""

import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from mobnet.core.columns import CLAIMS, VERDICTS
from mobnet.core.joints import JointLayout
from mobnet.evaluation.measure.results import Results, read_results
from mobnet.evaluation.number.intervals import summarise
from mobnet.evaluation.number.number import Number, number_text
from mobnet.evaluation.number.quantities import QUANTITIES
from mobnet.evaluation.tables.layout import Line, Table, long_table, tex_escape, write_table
from mobnet.settings.claims import Bounds, Claim
from mobnet.settings.evaluation import Statistics

log = logging.getLogger(__name__)

HEADER = ("Claim", "Printed in", "Paper", "Ours", "{:.0%}", "Differs", "Holds if", "Verdict")
CAPTION = r"\claimscaption"  # the paper's
COLUMNS = r">{\raggedright\arraybackslash}p{.385\linewidth}>{\raggedright\arraybackslash}p{.12\linewidth}rrrlll"


@dataclass(frozen=True)
class Verdict:
    """A claim, our number and what follows.

    Attributes:
        ours: our number; none where the tests are too short to hold what it is about, or all trainings diverged.
        differs: whether the interval leaves out equality, `yes` or `no`; empty without interval or comparison.
        verdict: one of `VERDICTS`, from the value alone.
    """

    name: str
    claim: Claim
    ours: Number
    differs: str
    verdict: str

    @property
    def cause(self) -> str:
        """Why it is not reproduced, as far as it was tested."""
        return "" if self.verdict == VERDICTS[0] else self.claim.cause

    def record(self) -> tuple[str | int | float | None, ...]:
        """Return the row of claims.csv."""
        claim, ours = self.claim, self.ours
        return (
            self.name, claim.printed, claim.says, ours.published, *ours.with_ends, ours.runs, ours.unit, self.differs,
            rule_text(claim.reproduced), self.verdict, self.cause,
        )  # fmt: skip

    def line(self) -> list[str]:
        """Return the texts of a row of the table."""
        claim, unit = self.claim, "" if self.claim.unit == "-" else f" {self.claim.unit}"
        own = [claim.says, claim.printed, number_text(claim.published), *self.ours.texts()]
        return [*own, self.differs, rule_text(claim.reproduced) + unit, self.verdict]


def claims(
    claims: Mapping[str, Claim], statistics: Statistics, seed: int, layout: JointLayout, scores: Mapping[str, Path],
    folders: Sequence[Path], table_dir: Path,
) -> None:  # fmt: skip
    """Judge every claim and write claims.csv, .tex and .md. A claim that fails is a result, not an error.

    Raises:
        ConfigError: a cell of a claim is not well formed.
        DataError: a run that a claim needs is missing.
    """
    results = read_results(layout, scores.values(), folders)
    verdicts = [judge(name, claim, results, statistics, seed) for name, claim in claims.items()]
    header = [text.format(statistics.confidence) for text in HEADER]
    lines = [verdict.line() for verdict in verdicts]
    full = [[*line, verdict.cause] for line, verdict in zip(lines, verdicts, strict=True)]
    table = Table(CLAIMS, [each.record() for each in verdicts], [*header, "Cause"], full, left=len(header) + 1)
    tex = long_table(COLUMNS, CAPTION, header, list(with_causes(verdicts, lines)))
    write_table(table_dir / "claims", table, tex)
    for each in verdicts:
        log.info("%s: %s (%s, %s)", each.name, each.verdict, each.ours.text(), rule_text(each.claim.reproduced))


def with_causes(verdicts: Sequence[Verdict], lines: Sequence[Line]) -> Iterator[Line]:
    """Yield the lines of claims, each followed by a line across all columns with its cause, where it has one."""
    across = rf"\multicolumn{{{len(HEADER)}}}{{@{{\quad}}p{{.96\linewidth}}}}"
    for verdict, line in zip(verdicts, lines, strict=True):
        yield line
        if verdict.cause:
            yield rf"{across}{{\emph{{{tex_escape(verdict.cause)}}}}} \\"


def judge(name: str, claim: Claim, results: Results, statistics: Statistics, seed: int) -> Verdict:
    """Return our number for a claim, its interval, and the verdict on the number itself."""
    quantity = QUANTITIES[claim.quantity]
    grids = [results.grid(cell) for cell in claim.cells]
    held = [grid for grid in grids if grid is not None]
    measured = len(held) == len(grids)
    ours = summarise(held, statistics, seed, quantity.made, claim.unit) if measured else Number(None, unit=claim.unit)
    ours = replace(ours, published=claim.published)
    return Verdict(name, claim, ours, differs(ours, quantity.equality), verdict_of(ours, claim))


def verdict_of(ours: Number, claim: Claim) -> str:
    """Return one of `VERDICTS` for our number, in the claim's unit, such as [N m] or [-]."""
    if ours.value is None:
        return VERDICTS[-1]
    met = (inside(ours.value, claim.reproduced), inside(ours.value, claim.direction), True)
    return VERDICTS[met.index(True)]


def differs(ours: Number, equality: float | None) -> str:
    """Return whether an interval leaves out equality [unit], `yes` or `no`; nothing where one of them is missing."""
    if ours.low is None or ours.high is None or equality is None:
        return ""
    return "no" if ours.low <= equality <= ours.high else "yes"


def inside(value: float, bounds: Bounds) -> bool:
    """Return whether a number lies in a closed range of its unit, [N m] or [-], None being no bound."""
    low, high = bounds
    return (low is None or value >= low) and (high is None or value <= high)


def rule_text(bounds: Bounds) -> str:
    """Return a range as text."""
    low, high = bounds
    if low is None:
        return "any" if high is None else f"at most {high:g}"
    return f"at least {low:g}" if high is None else f"{low:g} to {high:g}"
