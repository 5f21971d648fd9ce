"""Table of the standard deviations' calibration."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mobnet.core.files import write_text
from mobnet.evaluation.measure.calibration import STAGES, Grid, case_name
from mobnet.evaluation.number.intervals import summarise
from mobnet.evaluation.number.rows import write_rows
from mobnet.evaluation.tables.layout import RULE, Line, markdown_table, number, span, text_table

log = logging.getLogger(__name__)

COVERAGE, NLL, CRPS = "coverage", "nll", "crps"


@dataclass(frozen=True)
class Trust:
    """One measure of one limb in one test: a row of calibration.csv.

    Attributes:
        test: scenario, or `validation`.
        level: uncertainty level; empty for held-out data.
        pushed: joint that is pushed where only samples around pushes count, else empty.
        method: estimator.
        limb: limb of section 4.1.
        measure: `coverage`, `nll` or `crps`, a mean over the limb's joints.
        share: nominal share of the coverage [-]; None for the others.
        run_count: networks times tests.
        before: mean over runs with the standard deviation as learned [unit].
        before_low: lower end of its interval [unit]; None with a single run.
        before_high: upper end [unit].
        after: mean over runs with the scaled standard deviation [unit].
        low: lower end of its interval [unit]; None with a single run.
        high: upper end [unit].
        unit: unit of the limb's torques and of the CRPS; coverage is a share [-], likelihood in [nats].
    """

    test: str
    level: str
    pushed: str
    method: str
    limb: str
    measure: str
    share: float | None
    run_count: int
    before: float
    before_low: float | None
    before_high: float | None
    after: float
    low: float | None
    high: float | None
    unit: str


def trust_table(config: Mapping[str, Any], grids: Sequence[Grid], out_dir: Path) -> None:
    """Write calibration.csv, .tex and .md; the latter two hold some methods only.

    Args:
        config: resolved configuration: `seed`, `evaluation.calibration` and what intervals need.
        grids: of held-out data, then of the tests.
        out_dir: gets the three files.
    """
    settings = config["evaluation"]["calibration"]
    rows = [row for grid in grids for row in trust_rows(config, grid, settings["levels"])]
    write_rows(out_dir / "calibration.csv", Trust, rows)
    write_table([row for row in rows if row.method in settings["methods"]], config["evaluation"], out_dir)
    log.info("%s: %d rows", out_dir / "calibration.csv", len(rows))


def write_table(rows: Sequence[Trust], evaluation: Mapping[str, Any], out_dir: Path) -> None:
    """Write the rows as TeX and Markdown; `evaluation` holds the bar's share and the confidence [-]."""
    settings = evaluation["calibration"]
    header, lines = table_header(settings, evaluation["confidence"]), table_lines(rows, settings)
    columns = "lll" + "r" * (len(header) - 4) + "l"
    write_text(out_dir / "calibration.tex", text_table(columns, header, lines))
    write_text(out_dir / "calibration.md", markdown_table(header, lines, left=3))


def trust_rows(config: Mapping[str, Any], grid: Grid, levels: Sequence[float]) -> Iterator[Trust]:
    """Yield the measures of a limb's runs with their intervals: coverage of nominal shares [-], then NLL and CRPS."""
    head = grid.test, grid.level, grid.pushed, grid.method, grid.limb
    measures = [*((COVERAGE, level, k) for k, level in enumerate(levels)), (NLL, None, -2), (CRPS, None, -1)]
    for measure, share, place in measures:
        before, after = (summarise([grid.values[:, :, stage, place]], config) for stage in range(len(STAGES)))
        yield Trust(
            *head, measure, share, after.count, before.value, before.low, before.high, after.value, after.low,
            after.high, grid.unit,
        )  # fmt: skip


def table_header(settings: Mapping[str, Any], confidence: float) -> list[str]:
    """Return the header: coverage of the bar's share as learned, of each level scaled [-], then NLL [nats] and CRPS."""
    share = f"{settings['share']:.0%}"
    return [
        "Test", "Method", "Limb", f"{share}, as learned", *(f"{level:.0%}" for level in settings["levels"]),
        f"{confidence:.0%} of {share}", "NLL, as learned", "NLL", "CRPS, as learned", "CRPS",
        f"{share} within {settings['tolerance']:.0%}",
    ]  # fmt: skip


def table_lines(rows: Sequence[Trust], settings: Mapping[str, Any]) -> list[Line]:
    """Return the rows of text, one for each limb and unit of a method in a test, a rule between tests."""
    lines: list[Line] = []
    groups: dict[tuple[str, ...], list[Trust]] = {}
    for row in rows:
        groups.setdefault((case_name(row.test, row.pushed), row.method, row.limb, row.unit), []).append(row)
    before = None
    for (test, method, limb, _), group in groups.items():
        if before not in (None, test):
            lines.append(RULE)
        lines.append(["" if test == before else test, method, limb, *limb_texts(group, settings)])
        before = test
    return lines


def limb_texts(rows: Sequence[Trust], settings: Mapping[str, Any]) -> list[str]:
    """Return the numbers of a limb as texts: coverage in %, NLL [nats], CRPS with its unit, and the bar's verdict."""
    covered = {row.share: row for row in rows if row.measure == COVERAGE}
    nll, crps = (next(row for row in rows if row.measure == measure) for measure in (NLL, CRPS))
    bar = covered[settings["share"]]
    ends = [None if end is None else 100.0 * end for end in (bar.low, bar.high)]
    return [
        f"{bar.before:.1%}", *(f"{covered[level].after:.1%}" for level in settings["levels"]), span(*ends, digits=1),
        number(nll.before), number(nll.after), number(crps.before, 3), f"{crps.after:.3f} {crps.unit}",
        verdict(bar, settings),
    ]  # fmt: skip


def verdict(bar: Trust, settings: Mapping[str, Any]) -> str:
    """Return whether the scaled coverage keeps the bar [-], `yes` or `no`; under collision there is none."""
    if bar.pushed:
        return ""
    return "yes" if abs(bar.after - settings["share"]) <= settings["tolerance"] else "no"
