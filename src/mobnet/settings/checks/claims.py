"""What must hold for claims: cells are whole, run and scored, units are those of the cells, bounds fit the numbers."""

from collections.abc import Iterator, Mapping
from typing import get_args

from mobnet.core.errors import misfit, not_accepted
from mobnet.settings.checks.results import Results, metric_unit
from mobnet.settings.claims import Bounds, Cell, Claim, TrainingMetric
from mobnet.settings.reading import Place

RATIOS = ("ratio", "cut", "gap ratio", "least ratio", "falls")  # quantities without a unit
DIFFER = ("ratio", "cut", "difference", "below", "above", "falls")  # quantities whose cells are all different
POSSIBLE: Mapping[str, Bounds] = {
    "value": (0.0, None), "ratio": (0.0, None), "cut": (None, 1.0), "gap ratio": (0.0, None),
    "least ratio": (0.0, None), "falls": (-1.0, 1.0),
}  # fmt: skip
UNITS = {"validation RMSE": "N m"}  # of measures of a training that have one
Problem = tuple[Place, str]


def claim_problems(results: Results) -> Iterator[Problem]:
    """Yield claims about what is not measured, and bounds that do not fit."""
    for name, claim in results.settings.claims.items():
        units = set[str]()
        for index, cell in enumerate(claim.cells):
            for key, text in _cell_problems(results, cell):
                yield ("claims", name, "cells", index, *key), text
            units |= _units(results, cell)
        for place, text in _number_problems(claim, units):
            yield ("claims", name, *place), text


def metrics_of(cell: Cell) -> tuple[str, ...]:
    """Return the metrics of a cell."""
    return (cell.metric,) if isinstance(cell.metric, str) else cell.metric or ("rmse",)


def _cell_problems(results: Results, cell: Cell) -> Iterator[Problem]:
    """Yield keys of a cell that are missing, too many, or about runs that do not exist."""
    metrics = metrics_of(cell)
    is_training = metrics[0] in get_args(TrainingMetric)
    wanted = {"method"} if is_training else {"scenario", "level", "method", "joint"}
    given = {key for key, value in cell if value is not None and key != "metric"}
    if given != wanted:
        yield (
            (),
            misfit(f"a cell with {', '.join(sorted(given)) or 'nothing'}", f"{', '.join(sorted(wanted))}, all of them"),
        )
    elif is_training:
        accepted = results.claimed_trainings()
        if cell.method not in accepted:
            yield ("method",), not_accepted("method of Figure 17 or 20", cell.method, accepted)
    else:
        scenario, method = str(cell.scenario), str(cell.method)
        joints = (cell.joint,) if isinstance(cell.joint, str) else cell.joint or ()
        if text := results.not_run(scenario, str(cell.level), method):
            yield ("level" if text.startswith("level") else "method",), text
        elif text := results.not_estimated(method, [one for name in joints for one in results.joints(name)]):
            yield ("method",), text
        for metric in metrics:
            if text := results.not_scored(scenario, metric):
                yield ("metric",), text


def _units(results: Results, cell: Cell) -> set[str]:
    """Return the units of a cell's numbers."""
    metrics, names = metrics_of(cell), (cell.joint,) if isinstance(cell.joint, str) else cell.joint or ()
    if metrics[0] in get_args(TrainingMetric):
        return {UNITS.get(metrics[0], "-")}
    units = {results.layout.unit(joint) for name in names for joint in results.joints(name)}
    return {metric_unit(metric, unit) for metric in metrics for unit in units}


def _number_problems(claim: Claim, units: set[str]) -> Iterator[Problem]:
    """Yield a unit that is not that of the cells, and numbers that do not lie inside each other."""
    if len(units) > 1:
        yield ("cells",), misfit(f"cells in {' and '.join(sorted(units))}", "cells in one unit")
    unit = "-" if claim.quantity in RATIOS else next(iter(units), claim.unit)
    if claim.unit != unit:
        yield ("unit",), misfit(repr(claim.unit), repr(unit))
    possible = POSSIBLE.get(claim.quantity, (None, None))
    for key in ("reproduced", "direction"):
        for index, end in enumerate(getattr(claim, key)):
            if end is not None and not _inside((end, end), possible):
                low, high = ("any" if bound is None else bound for bound in possible)
                yield (key, index), misfit(end, f"{low} to {high}, the numbers that {claim.quantity!r} can be")
    if claim.quantity in DIFFER and len(set(map(repr, claim.cells))) < len(claim.cells):
        yield ("cells",), misfit("the same cell twice", f"cells that differ, of {claim.quantity!r}")
    if claim.published is not None and not _inside((claim.published, claim.published), claim.reproduced):
        yield (
            ("reproduced",),
            misfit(list(claim.reproduced), f"a range with the paper's number, {claim.published}"),
        )
    if not _inside(claim.reproduced, claim.direction):
        yield ("direction",), misfit(list(claim.direction), f"a range around reproduced, {list(claim.reproduced)}")


def _inside(inner: Bounds, outer: Bounds) -> bool:
    """Return whether a closed range lies inside another one; None is no bound."""
    lower = outer[0] is None or (inner[0] is not None and inner[0] >= outer[0])
    return lower and (outer[1] is None or (inner[1] is not None and inner[1] <= outer[1]))
