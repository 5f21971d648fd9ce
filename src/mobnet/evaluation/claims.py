"""The paper's claims, checked against bounds that were fixed before any result was seen."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.config import read_yaml
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.files import write_text
from mobnet.evaluation.intervals import Summary, first, summarise
from mobnet.evaluation.markup import markdown_table, number, span, text_table
from mobnet.evaluation.rows import Score, read_rows, write_rows
from mobnet.evaluation.runs import Wanted, run_grid

log = logging.getLogger(__name__)

Bounds = tuple[float | None, float | None]
QUANTITIES: Mapping[str, tuple[int, Callable[[NDArray[np.float64]], NDArray[np.float64]]]] = {  # cells taken, rule
    "value": (1, first),
    "ratio": (2, lambda means: means[0] / means[1]),
    "cut": (2, lambda means: 1.0 - means[0] / means[1]),
}


@dataclass(frozen=True)
class Claim:
    """What the paper says and what must hold here.

    Attributes:
        name: short name.
        printed: where the paper says it.
        says: the claim in our words.
        quantity: a name of `QUANTITIES`.
        cells: (level, method, joint) of the scores, as many as the quantity takes.
        unit: unit of the number.
        published: the paper's number [unit]; None where it gives none.
        reproduced: range [unit] in which ours counts as the paper's; None is no bound.
        direction: wider range [unit] in which ours points the paper's way.
        metric: a name of `metrics.METRICS`.
    """

    name: str
    printed: str
    says: str
    quantity: str
    cells: tuple[tuple[str, str, str], ...]
    unit: str
    published: float | None
    reproduced: Bounds
    direction: Bounds
    metric: str = "rmse"


@dataclass(frozen=True)
class Verdict:
    """A claim, our number and what follows: a row of claims.csv. Numbers are in `unit`."""

    claim: str
    printed: str
    says: str
    published: float | None
    value: float
    low: float | None
    high: float | None
    seed_count: int
    unit: str
    rule: str
    verdict: str


def claims(config: Mapping[str, Any], claims_yaml: Path, scores_csv: Path, out_dir: Path) -> None:
    """Judge every claim and write claims.csv, .tex and .md. A claim that fails is a result, not an error.

    Args:
        config: resolved configuration; `evaluation.table_05` names the scenario and the limb.
        claims_yaml: the claims.
        scores_csv: scores of that scenario.
        out_dir: where the three files go.

    Raises:
        ConfigError: a claim is not well formed.
        DataError: a run that a claim needs is missing.
    """
    scores = read_rows(scores_csv, Score)
    verdicts = [judge(config, claim, scores) for claim in read_claims(claims_yaml)]
    header = ["Claim", "Printed in", "Paper", "Ours", "", "Holds if", "Verdict"]
    lines = [claim_line(verdict) for verdict in verdicts]
    write_rows(out_dir / "claims.csv", Verdict, verdicts)
    columns = r">{\raggedright\arraybackslash}p{.33\linewidth}>{\raggedright\arraybackslash}p{.15\linewidth}rrrll"
    write_text(out_dir / "claims.tex", text_table(columns, header, lines))
    write_text(out_dir / "claims.md", markdown_table(header, lines, left=len(header)))
    for verdict in verdicts:
        log.info("%s: %s (%.3g, %s)", verdict.claim, verdict.verdict, verdict.value, verdict.rule)


def read_claims(path: Path) -> list[Claim]:
    """Read claims.

    Raises:
        ConfigError: a key is unknown or missing, or the quantity does not fit the cells; the message names the claim.
    """
    entries = read_yaml(path)
    for name, entry in entries.items():
        fault = claim_fault(entry)
        if fault:
            raise ConfigError(f"{path}: {name}: {fault}")
    return [Claim(name=name, **entry) for name, entry in entries.items()]


def claim_fault(entry: Mapping[str, Any]) -> str | None:
    """Return what is wrong with a claim's entry and what is accepted, or None."""
    fault = keys_fault(entry)
    if fault:
        return fault
    if entry["quantity"] not in QUANTITIES:
        return not_accepted("quantity", entry["quantity"], QUANTITIES)
    count = QUANTITIES[entry["quantity"]][0]
    if len(entry["cells"]) != count:
        return f"{len(entry['cells'])} cells; {entry['quantity']} takes {count}"
    return bounds_fault("reproduced", entry["reproduced"]) or bounds_fault("direction", entry["direction"])


def keys_fault(entry: Mapping[str, Any]) -> str | None:
    """Return which key of a claim's entry is unknown or missing, or None."""
    accepted = [field.name for field in fields(Claim) if field.name != "name"]
    unknown = [key for key in entry if key not in accepted]
    if unknown:
        return not_accepted("key", unknown[0], accepted)
    missing = [key for key in accepted if key not in entry and key != "metric"]
    return f"key {missing[0]!r} is missing" if missing else None


def bounds_fault(key: str, bounds: Sequence[float | None]) -> str | None:
    """Return what is wrong with a range [low, high], in [N m] or [-], or None."""
    known = [bound for bound in bounds if bound is not None]
    if len(bounds) == 2 and known == sorted(known):
        return None
    return f"{key}: {bounds} is not accepted; accepted: [low, high] with low <= high, null for no bound"


def judge(config: Mapping[str, Any], claim: Claim, scores: Sequence[Score]) -> Verdict:
    """Return our number for a claim, its interval, and the verdict on the number itself.

    Raises:
        DataError: a run is missing.
    """
    table = config["evaluation"]["table_05"]
    grids = [run_grid(scores, Wanted(table["scenario"], table["limb"], *cell, claim.metric)) for cell in claim.cells]
    ours: Summary = summarise(grids, config, QUANTITIES[claim.quantity][1])
    return Verdict(
        claim.name, claim.printed, claim.says, claim.published, ours.value, ours.low, ours.high, ours.count,
        claim.unit, rule_text(claim.reproduced), verdict_of(ours.value, claim),
    )  # fmt: skip


def verdict_of(value: float, claim: Claim) -> str:
    """Return `reproduced`, `direction only` or `not reproduced` for our number, [N m] or [-] as the claim says."""
    if inside(value, claim.reproduced):
        return "reproduced"
    return "direction only" if inside(value, claim.direction) else "not reproduced"


def inside(value: float, bounds: Bounds) -> bool:
    """Return whether a number lies in a closed range of its unit, [N m] or [-], None being no bound."""
    low, high = bounds
    return (low is None or value >= low) and (high is None or value <= high)


def rule_text(bounds: Bounds) -> str:
    """Return a range as text."""
    low, high = bounds
    if low is None:
        return f"at most {high:g}"
    return f"at least {low:g}" if high is None else f"{low:g} to {high:g}"


def claim_line(verdict: Verdict) -> list[str]:
    """Return the texts of a row of the table."""
    unit = "" if verdict.unit == "-" else f" {verdict.unit}"
    digits = 2 if verdict.unit == "-" or verdict.value >= 1 else 3
    return [
        verdict.says,
        verdict.printed,
        number(verdict.published),
        number(verdict.value, digits),
        span(verdict.low, verdict.high, digits),
        verdict.rule + unit,
        verdict.verdict,
    ]
