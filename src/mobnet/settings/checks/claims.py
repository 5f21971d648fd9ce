"""What must hold for claims: cells are whole, run and scored, units are those of the cells, bounds and causes fit."""

import re
from collections.abc import Iterator, Mapping
from string import Formatter
from typing import get_args

from mobnet.core.errors import misfit, not_accepted
from mobnet.core.metrics import unit_of_metric
from mobnet.settings.checks.quoted import quoted_problems
from mobnet.settings.checks.results import Results
from mobnet.settings.claims import Bounds, Cell, Claim, MadeNumber, TrainingMetric
from mobnet.settings.reading import Place

NO_UNIT = ("ratio", "cut", "square cut", "gap ratio", "least ratio", "share")  # quantities without a unit
DIFFER = ("ratio", "cut", "square cut", "difference", "below", "above", "trend")  # their cells are all different
POSSIBLE: Mapping[str, Bounds] = {
    "value": (0.0, None), "ratio": (0.0, None), "cut": (None, 1.0), "square cut": (None, 1.0), "gap ratio": (0.0, None),
    "least ratio": (0.0, None), "share": (0.0, 1.0),
}  # fmt: skip
NUMBERED = ("about", "larger", "little")  # rules that need the paper's number
TYPED = re.compile(r"(?<![A-Za-z0-9-])\.?\d")  # a number; LL3 and FTS-e2e are names
Problem = tuple[Place, str]


def claim_problems(results: Results) -> Iterator[Problem]:
    """Yield claims about what is not measured, and bounds and causes that do not fit."""
    for name, claim in results.settings.claims.items():
        for place, text in _made_problems(results, claim):
            yield ("claims", name, *place), text
        for key, number in claim.numbers.items():
            for place, text in _made_problems(results, number):
                yield ("claims", name, "numbers", key, *place), text
        for check in (_unit_problems, _statement_problems, _joint_problems, quoted_problems):
            for place, text in check(results, claim):
                yield ("claims", name, *place), text
        for place, text in (*_bound_problems(claim), *_cause_problems(claim)):
            yield ("claims", name, *place), text


def metrics_of(cell: Cell) -> tuple[str, ...]:
    """Return the metrics of a cell."""
    return (cell.metric,) if isinstance(cell.metric, str) else cell.metric or ("rmse",)


def _is_training(cell: Cell) -> bool:
    """Return whether a cell is about trainings."""
    return metrics_of(cell)[0] in get_args(TrainingMetric)


def _made_problems(results: Results, made: MadeNumber) -> Iterator[Problem]:
    """Yield faults of the cells of a number, also against each other."""
    for index, cell in enumerate(made.cells):
        yield from ((("cells", index, *key), text) for key, text in _cell_problems(results, cell))
    units = set[str]().union(*(_units(results, cell) for cell in made.cells))
    if len(units) > 1:
        yield ("cells",), misfit(f"cells in {' and '.join(sorted(units))}", "cells in one unit")
    if made.quantity in DIFFER and len(set(map(repr, made.cells))) < len(made.cells):
        yield ("cells",), misfit("the same cell twice", f"cells that differ, of {made.quantity!r}")
    if (made.quantity == "share") != (metrics_of(made.cells[0]) == ("diverged",)):
        yield ("quantity",), misfit(made.quantity, "'share' for the metric 'diverged', and only for it")


def _cell_problems(results: Results, cell: Cell) -> Iterator[Problem]:
    """Yield keys of a cell that are missing, too many, or about runs that do not exist."""
    wanted = {"method"} if _is_training(cell) else {"scenario", "level", "method", "joint"}
    wanted = {"table", "where", "column"} if cell.table else wanted
    given = {key for key, value in cell if value and key != "metric"}
    if given != wanted:
        yield (
            (),
            misfit(f"a cell with {', '.join(sorted(given)) or 'nothing'}", f"{', '.join(sorted(wanted))}, all of them"),
        )
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


def _units(results: Results, cell: Cell) -> set[str]:
    """Return the units of a cell's numbers; none of a table's."""
    if cell.table:
        return set()
    if _is_training(cell):
        return {"N m" if metrics_of(cell) == ("validation RMSE",) else "-"}
    units = {results.layout.unit(joint) for joint in results.joints_of_cell(cell)}
    return {unit_of_metric(metric, unit) for metric in metrics_of(cell) for unit in units}


def _unit_problems(results: Results, claim: Claim) -> Iterator[Problem]:
    """Yield a unit that is not that of the cells."""
    units = set[str]().union(*(_units(results, cell) for cell in claim.cells))
    unit = "-" if claim.quantity in NO_UNIT else next(iter(units), claim.unit)
    if claim.unit != unit:
        yield ("unit",), misfit(repr(claim.unit), repr(unit))


def _statement_problems(results: Results, claim: Claim) -> Iterator[Problem]:
    """Yield a statement that is not named after a claim that begins it."""
    first = results.settings.claims.get(claim.statement or "")
    if claim.statement and (first is None or first.statement):
        accepted = [name for name, other in results.settings.claims.items() if not other.statement]
        yield ("statement",), not_accepted("claim that begins a statement", claim.statement, accepted)


def _joint_problems(results: Results, claim: Claim) -> Iterator[Problem]:
    """Yield joints of a claim that its cells do not have, and numbers of joints where there is none of all."""
    for index, cell in enumerate(claim.cells if claim.by_joint else ()):
        held = results.joints_of_cell(cell)
        for joint in claim.by_joint:
            if joint not in held:
                yield ("by_joint", joint), not_accepted(f"joint of cell {index + 1}", joint, held)
    if claim.by_joint and claim.published is None:
        yield ("published",), misfit(claim.published, "the paper's number, where it prints those of joints")


def _bound_problems(claim: Claim) -> Iterator[Problem]:
    """Yield bounds that no number can meet, that leave out the paper's number, or that do not lie in each other."""
    possible = POSSIBLE.get(claim.quantity, (None, None))
    for key in ("bar", "side"):
        for index, end in enumerate(getattr(claim, key) or ()):
            if end is not None and not _inside((end, end), possible):
                low, high = ("any" if bound is None else bound for bound in possible)
                yield (key, index), misfit(end, f"{low} to {high}, the numbers that {claim.quantity!r} can be")
    printed = claim.published
    numbers = {("published",): printed} | {("by_joint", joint): value for joint, value in claim.by_joint.items()}
    for place, value in numbers.items():
        if value is not None and not _inside((value, value), possible):
            yield place, misfit(value, f"0 or more, a number that {claim.quantity!r} can be")
    for key in ("bar", "side"):
        bounds = getattr(claim, key)
        if printed is not None and bounds and not _inside((printed, printed), bounds):
            yield (key,), misfit(list(bounds), f"a range with the paper's number, {printed}")
    if claim.bar and claim.side and claim.rule == "sign" and not _inside(claim.bar, claim.side):
        yield ("side",), misfit(list(claim.side), f"a range around bar, {list(claim.bar)}")
    if printed is None and claim.rule in NUMBERED:
        yield ("rule",), misfit(claim.rule, "'sign' or 'similar' where the paper prints no number")
    if claim.rule == "sign" and (claim.bar is None or printed is not None):
        yield ("rule",), misfit(claim.rule, "'sign' with a bar and without a number of the paper")


def _cause_problems(claim: Claim) -> Iterator[Problem]:
    """Yield numbers that are typed in a cause, and names in its braces that are not those of its numbers."""
    try:
        parts = [*Formatter().parse(claim.cause)]
        for _, name, form, _ in parts:
            format(0.5, form or "") if name is not None else None
    except ValueError as error:
        yield ("cause",), misfit(claim.cause, f"a text in which names of numbers stand in braces ({error})")
        return
    named = {name for _, name, _, _ in parts if name is not None}
    if named != claim.numbers.keys():
        yield ("cause",), not_accepted("names in braces", sorted(named), [f"those of numbers, {sorted(claim.numbers)}"])
    typed = [text for text, *_ in parts if TYPED.search(text)]
    if typed:
        yield ("cause",), misfit(typed[0].strip(), "a text without numbers: each is one of numbers, in braces")


def _inside(inner: Bounds, outer: Bounds) -> bool:
    """Return whether a closed range lies inside another one; None is no bound."""
    lower = outer[0] is None or (inner[0] is not None and inner[0] >= outer[0])
    return lower and (outer[1] is None or (inner[1] is not None and inner[1] <= outer[1]))
