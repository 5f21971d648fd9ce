"""Numbers that claims quote from the paper's tables: they are those of section `published`, or made of them."""

from collections.abc import Callable, Iterator, Mapping, Sequence

from mobnet.core.errors import misfit
from mobnet.settings.checks.results import Results
from mobnet.settings.claims import Cell, Claim
from mobnet.settings.evaluation import ErrorTable
from mobnet.settings.reading import Place

Problem = tuple[Place, str]
MADE: Mapping[str, Callable[[Sequence[float]], float]] = {  # quantity -> what it is of the printed numbers of its cells
    "value": lambda cells: cells[0],
    "ratio": lambda cells: cells[0] / cells[1],
    "cut": lambda cells: 1.0 - cells[0] / cells[1],
    "difference": lambda cells: cells[0] - cells[1],
}


def quoted_problems(results: Results, claim: Claim) -> Iterator[Problem]:
    """Yield numbers of the paper in a claim that its printed tables do not give."""
    quoted: dict[Place, tuple[float | None, str | None]] = {("published",): (claim.published, None)}
    quoted |= {("by_joint", joint): (value, joint) for joint, value in claim.by_joint.items()}
    for place, (value, joint) in quoted.items():
        cells = [_printed(results, cell, joint) for cell in claim.cells if claim.quantity in MADE]
        known = [number for number in cells if number is not None]
        if value is None or not known or len(known) < len(cells):
            continue
        made, step = MADE[claim.quantity](known), 10.0 ** -len(repr(value).partition(".")[2])
        if abs(made - value) > step:
            yield place, misfit(value, f"{made:.4g}, as section published has it")


def _printed(results: Results, cell: Cell, joint: str | None) -> float | None:
    """Return the paper's number of a cell, or of one of its joints; None where no table prints it."""
    joints = [joint] if joint else results.joints_of_cell(cell)
    for name, table in results.settings.evaluation.tables.items():
        if name in results.settings.published.tables:
            found = _in_table(results, name, table, cell, joints)
            if found is not None:
                return found
    return None


def _in_table(results: Results, name: str, table: ErrorTable, cell: Cell, joints: Sequence[str]) -> float | None:
    """Return the number that the paper prints in a table of errors for the mean over some joints."""
    columns: list[Sequence[str]] = []
    for column in table.columns:
        whole = results.joints_of(column)
        columns += [[one] for one in whole] if isinstance(column, str) else [[] if column.metrics else whole]
    for row in table.rows:
        if (row.scenario, row.level, row.metric) == (cell.scenario, cell.level, cell.metric or "rmse"):
            printed = results.settings.published.tables[name].numbers.get(row.paper or "", {}).get(str(cell.method), ())
            for column, number in zip(columns, printed, strict=False):
                if sorted(column) == sorted(joints):
                    return number
    return None
