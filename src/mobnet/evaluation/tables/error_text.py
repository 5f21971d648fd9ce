"""Tables of errors as TeX and Markdown, laid out as in the paper."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from mobnet.evaluation.measure.scores import AVERAGE
from mobnet.evaluation.number.rows import Cell
from mobnet.evaluation.tables.layout import GAP, RULE, Line, markdown_table, number, span, text_table

OURS, PAPER = ("ours", "ours, simulated"), ("paper", "paper, robot")  # where they simulated, and where they measured
PART = "\\par\\medskip\n"  # between the parts of a table that is wider than a page


@dataclass(frozen=True)
class TableRow:
    """A method in a test.

    Attributes:
        labels: what stands before the method, such as the uncertainty level, (k,).
        cells: a cell a column [N m], (C,).
    """

    labels: tuple[str, ...]
    cells: tuple[Cell, ...]

    def part(self, first: int, end: int) -> TableRow:
        """Return the row with a span of its columns only."""
        return TableRow(self.labels, self.cells[first:end])

    def runs(self, floor: Mapping[str, str]) -> bool:
        """Return whether this is the row of a level and a method."""
        return all(getattr(self.cells[0], key) == name for key, name in floor.items())


@dataclass(frozen=True)
class Look:
    """How a table is laid out.

    Attributes:
        header: heads of the labels, (k,).
        robot: whether the printed numbers were measured on the robot.
        floor: level and method of the row that later averages are compared with, or None.
        confidence: of the intervals, a share [-].
        parts: columns that begin a further tabular in TeX; intervals then stand on two lines.
        names: what methods are called, where it is not their name.
    """

    header: tuple[str, ...]
    robot: bool
    floor: Mapping[str, str] | None
    confidence: float
    parts: tuple[str, ...] = ()
    names: Mapping[str, str] = field(default_factory=dict)


def look_of(spec: Mapping[str, Any], entry: Mapping[str, Any], confidence: float) -> Look:
    """Return how a table is laid out, from its configuration, what the paper prints, and a share [-]."""
    parts, names = tuple(spec.get("parts", ())), spec.get("names", {})
    return Look(tuple(spec["header"]), entry.get("robot", False), entry.get("floor"), confidence, parts, names)


def table_tex(rows: Sequence[TableRow], look: Look) -> str:
    """Return a table [N m] as a TeX tabular, or, where it is wider than a page, as some one below the other."""
    names = [cell.joint for cell in rows[0].cells]
    texts = []
    for first, end in pairwise([0, *map(names.index, look.parts), len(names)]):
        part = [row.part(first, end) for row in rows]
        header = header_of(part, look)
        columns = "l" * (len(header) - end + first) + "r" * (end - first)
        texts.append(text_table(columns, header, table_lines(part, look, stacked=bool(look.parts))))
    return PART.join(texts)


def table_markdown(rows: Sequence[TableRow], look: Look) -> str:
    """Return a table [N m] as Markdown."""
    header = header_of(rows, look)
    return markdown_table(header, table_lines(rows, look), left=len(header) - len(rows[0].cells))


def header_of(rows: Sequence[TableRow], look: Look) -> list[str]:
    """Return the heads of the columns; where torques [N m] and forces stand side by side, forces have their unit."""
    cells = rows[0].cells
    mixed = len({cell.unit for cell in cells}) > 1
    return [*look.header, "Method", "", *(f"{c.joint} [N]" if mixed and c.unit == "N" else c.joint for c in cells)]


def table_lines(rows: Sequence[TableRow], look: Look, stacked: bool = False) -> list[Line]:
    """Return the lines of text, row by row; a rule stands where the first label changes.

    Args:
        rows: methods in tests, numbers in [N m].
        look: how they are laid out.
        stacked: whether the ends of an interval stand one below the other.
    """
    lines: list[Line] = []
    over: TableRow | None = None
    before: tuple[str, ...] = ()
    for row in rows:
        if lines:
            lines.append(GAP if row.labels[:1] == before[:1] else RULE)
        shown = ["" if row.labels[: k + 1] == before[: k + 1] else label for k, label in enumerate(row.labels)]
        lines += row_lines(row, shown, over, look, stacked)
        before = row.labels
        over = row if look.floor and row.runs(look.floor) else over
    return lines


def row_lines(
    row: TableRow, labels: Sequence[str], over: TableRow | None, look: Look, stacked: bool
) -> Iterator[list[str]]:
    """Yield a method's lines [N m]: ours, then its interval and the paper's numbers, if there are any."""
    found = [(OURS[look.robot], values(row, over, "value"))]
    if any(cell.low is not None for cell in row.cells):
        found += intervals(row, look.confidence, stacked)
    if any(cell.published is not None for cell in row.cells):
        found.append((PAPER[look.robot], values(row, over, "published")))
    method = row.cells[0].method
    first = [*labels, look.names.get(method, method)]
    for k, (kind, texts) in enumerate(found):
        yield [*([""] * len(first) if k else first), kind, *texts]


def intervals(row: TableRow, confidence: float, stacked: bool) -> list[tuple[str, list[str]]]:
    """Return the lines of a row's intervals [N m], what they are and their texts; `confidence` is a share [-]."""
    share = f"{confidence:.0%}"
    if not stacked:
        return [(share, [span(cell.low, cell.high) for cell in row.cells])]
    ends = [("from", [cell.low for cell in row.cells]), ("to", [cell.high for cell in row.cells])]
    return [(f"{share} {word}", [number(value) for value in found]) for word, found in ends]


def values(row: TableRow, over: TableRow | None, field: str) -> list[str]:
    """Return the numbers of a row [N m]; its average carries the increase over a floor, as the paper prints it."""
    texts = [number(getattr(cell, field)) for cell in row.cells]
    for k, cell in enumerate(row.cells):
        value, base = getattr(cell, field), over and getattr(over.cells[k], field)
        if cell.joint == AVERAGE and value is not None and base is not None:
            texts[k] += f" ({value - base:+.2f})"
    return texts
