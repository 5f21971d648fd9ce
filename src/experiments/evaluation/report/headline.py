"""The table of errors that comes first: in the README, and on the page on which the report opens."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from mobnet.core.rows import read_texts

AVERAGE = {"metric": "rmse", "joint": "avg"}
FORWARD = {"scenario": "forward_walk", "level": "all_uncertainty", **AVERAGE}
WALK = {"scenario": "walk_test", **AVERAGE}
# title, tables that have its numbers, the first of them first, and the place of these in each
COLUMNS = (
    ("friction by the original's law", ("table_05",), FORWARD),
    ("robots with unknown gears", ("table_07", "table_10"), WALK),
)
FILMED = "MOB-Net-pushed"  # the network of the film of the first screen
BEST = "with our best friction formula"
FORMULAS = {"MOB-fric-load": "friction that grows with the load", "MOB-fric-dahl": "friction with a memory"}
METHODS = {  # what a row is called -> its method, or those of which it shows the best one in each column
    "estimate nothing": ("zero",),
    "momentum observer": ("MOB",),
    BEST: tuple(FORMULAS),
    "MOB-Net": ("MOB-Net",),
    f"{FILMED}, trained with a push in nearly every swing": (FILMED,),
}
Row = Mapping[str, str]


def headline(results: Path) -> str:
    """Return a table of errors in two tests [N m], the original's in parentheses."""
    lines = [["error on a walking leg [N m], ours (original)", *(title for title, *_ in COLUMNS)]]
    lines.append(["---", *["---:"] * len(COLUMNS)])
    tests = _errors_of(results)
    for shown, methods in METHODS.items():
        lines.append([shown, *(_cell(best) for best in _smallest(tests, methods))])
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def best_formulas(results: Path) -> str:
    """Return which formula is our best one in each test."""
    names = [FORMULAS[row["method"]] for row in _smallest(_errors_of(results), METHODS[BEST]) if row is not None]
    return ", then ".join(dict.fromkeys(names))


def _errors_of(results: Path) -> list[list[Row]]:
    """Return for each test the rows of all methods that ran."""
    tests: list[list[Row]] = []
    for _, tables, place in COLUMNS:
        rows: list[Row] = []
        for table in tables:
            rows += read_texts(results / f"{table}.csv")
        tests.append([row for row in rows if row["value"] and place.items() <= row.items()])
    return tests


def _smallest(tests: Sequence[Sequence[Row]], methods: Sequence[str]) -> list[Row | None]:
    """Return for each test the row with the smallest error of some methods; None where none of them ran."""
    best: list[Row | None] = []
    for rows in tests:
        known = [row for row in rows if row["method"] in methods]
        best.append(min(known, key=lambda row: float(row["value"]), default=None))
    return best


def _cell(row: Row | None) -> str:
    """Return the number of a row, and the original's, if it prints one; a dash where no method ran."""
    if row is None:
        return "-"
    published = row["published"]
    return f"{float(row['value']):.1f}" + (f" ({float(published):.1f})" if published else "")
