"""What must hold for claims: their cells are whole, and are of what is scored, trained or in a table.

Units, bounds and quoted numbers, which only who words a claim can get wrong, are checked by tests/paper/settings.
"""

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import get_args

from experiments.settings.checks.results import Results
from experiments.settings.claims import Cell, TrainingMetric
from experiments.settings.settings import Settings
from mobnet.core.errors import misfit, not_accepted
from mobnet.formats.reading import Place, Problem

MACROS = re.compile(
    r"\\(?:claimed|claimedshare|found|foundshare|foundspan|verdict|cause|holds)\{([\w-]+)\}"
)  # of `evaluation.report.numbers`


def claim_problems(results: Results) -> Iterator[Problem]:
    """Yield claims about what is not measured."""
    claims = results.settings.claims
    numbers: dict[Place, Sequence[Cell]] = {("claims", name): claim.cells for name, claim in claims.items()}
    for name, claim in claims.items():
        if claim.sign_of:
            numbers["claims", name, "sign_of"] = claim.sign_of.cells
        if claim.cause:
            numbers["claims", name, "cause", "without"] = claim.cause.without.cells
    for place, cells in numbers.items():
        for index, cell in enumerate(cells):
            yield from (((*place, "cells", index, *key), text) for key, text in _cell_problems(results, cell))


def metrics_of(cell: Cell) -> tuple[str, ...]:
    """Return the metrics of a cell."""
    return (cell.metric,) if isinstance(cell.metric, str) else cell.metric or ("rmse",)


def _is_training(cell: Cell) -> bool:
    """Return whether a cell is about trainings."""
    return metrics_of(cell)[0] in get_args(TrainingMetric)


def _cell_problems(results: Results, cell: Cell) -> Iterator[Problem]:
    """Yield keys of a cell that are missing, too many, or about runs that do not exist."""
    wanted = {"method"} if _is_training(cell) else {"scenario", "level", "method", "joint"}
    wanted = {"table", "where", "column"} if cell.table else wanted
    given = {key for key, value in cell if value and key != "metric"}
    if given != wanted:
        cell_keys = f"a cell with {', '.join(sorted(given)) or 'nothing'}"
        yield (), misfit(cell_keys, f"{', '.join(sorted(wanted))}, all of them")
    elif cell.table:
        accepted = results.claimed_tables()
        if cell.table not in accepted:
            yield ("table",), not_accepted("table", cell.table, accepted)
            return
        for name in sorted({str(cell.column), *cell.where}.difference(accepted[cell.table])):
            yield ("column" if name == cell.column else "where",), not_accepted("column", name, accepted[cell.table])
    elif _is_training(cell):
        accepted = results.claimed_trainings()
        if cell.method not in accepted:
            yield ("method",), not_accepted("method of Figure 17 or 20", cell.method, accepted)
    else:
        yield from _score_problems(results, cell)


def _score_problems(results: Results, cell: Cell) -> Iterator[Problem]:
    """Yield metrics of a cell of the scores that are not there."""
    for metric in metrics_of(cell):
        if text := results.not_scored(str(cell.scenario), metric):
            yield ("metric",), text


def text_problems(settings: Settings, text: Path) -> Iterator[tuple[Place, str]]:
    """Yield the claims that a TeX file names and the configuration lacks; TeX would miss them at the end of a run."""
    for name in dict.fromkeys(MACROS.findall(text.read_text(encoding="utf-8"))):
        if name not in settings.claims:
            yield ("claims", name), not_accepted(f"claim in {text.name}", name, settings.claims)
