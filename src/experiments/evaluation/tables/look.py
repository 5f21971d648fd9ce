"""What a reader sees of a frame of numbers: lines of labels and texts, which are written beside all rows as CSV."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd

from experiments.evaluation.number.frames import records_of, rows_of
from experiments.evaluation.number.number import interval_text, is_missing, number_text
from experiments.evaluation.number.scored import AVERAGE
from experiments.evaluation.tables.layout import Line, Table, in_blocks, write_table

KEYS = ("scenario", "level", "robot", "set", "data")  # labels with names of the configuration, whose _ is a space
Row = Mapping[Any, Any]  # column -> value


@dataclass(frozen=True)
class ShownColumn:
    """A column that a reader sees: of each line the first row that has some values.

    Attributes:
        head: head of the column.
        of: column of the frame -> value of the row that is shown; none: the only row of its line.
        digits: of the number.
        ends: head of a second column, which has the number's interval; empty where there is none.
        text: what is shown of the row in place of its number.
        none: what is shown in a line without such a row.
    """

    head: str
    of: Mapping[str, object] = field(default_factory=dict[str, object])
    digits: int = 2
    ends: str = ""
    text: Callable[[Row], str] | None = None
    none: str = "-"

    def texts(self, row: Row) -> list[str]:
        """Return what is shown of a row: its text and, where there is a column for it, its interval."""
        text = self.text(row) if self.text else number_text(row["value"], self.digits)
        return [text, interval(row, self.digits)] if self.ends else [text]


@dataclass(frozen=True)
class TableLook:
    """What a reader sees: rows with equal labels are a line, and lines stand in the order of their first rows.

    Attributes:
        labels: column of the frame -> head, of the leading columns, which say what a line is of.
        shown: columns of numbers. A line of which none shows a row is left out.
        blocks: columns of the frame; lines that have them in common stand together, and a rule stands between such
            blocks. One that is a label, as the first ones are, stands in the first line of its block alone.
        nested: whether labels of a block are left out while they stay the same, as `in_blocks` does.
        apart: columns of the frame that nobody sees; rows that differ in them are lines of their own.
        left: columns that are set flush left, if these are not the labels.
        align: TeX column specification where it is another one.
        note: text below the table.
    """

    labels: Mapping[str, str]
    shown: Sequence[ShownColumn]
    blocks: Sequence[str] = ()
    nested: bool = False
    apart: Sequence[str] = ()
    left: int | None = None
    align: str = ""
    note: str = ""

    @property
    def header(self) -> list[str]:
        """The heads of all columns."""
        header = list(self.labels.values())
        for column in self.shown:
            header += [column.head, column.ends] if column.ends else [column.head]
        return header


def write_look(
    stem: Path, rows: pd.DataFrame, columns: Sequence[str], look: TableLook, filed: pd.DataFrame | None = None
) -> None:
    """Write the columns of rows as `stem.csv`, and what a reader sees of them as .tex and .md.

    `filed` are the rows of the CSV file, if these are not all.
    """
    left = len(look.labels) if look.left is None else look.left
    records = records_of(rows if filed is None else filed, columns)
    lines = lines_of(rows, look)
    write_table(stem, Table(columns, records, look.header, lines, left, look.align, look.note))


def lines_of(rows: pd.DataFrame, look: TableLook) -> list[Line]:
    """Return the lines of a look; a row that lacks a label is in none."""
    names = [*look.labels, *(name for name in look.blocks if name not in look.labels)]
    rows = rows.dropna(subset=names).reset_index(drop=True)
    shown = pd.concat([rows_of(rows, **column.of) for column in look.shown])
    rows = rows[rows.index.isin(shown.index)]
    blocks: list[tuple[list[str], list[list[str]]]] = []
    line_by = [*look.labels, *look.apart]
    # A table without blocks is one of them.
    for _, block in rows.groupby(list(look.blocks) or (lambda _: 0), sort=False, observed=True):
        titles = [label_text(name, block[name].iloc[0]) for name in look.blocks if name in look.labels]
        lines = [cells_of(line, look) for _, line in block.groupby(line_by, sort=False, observed=True)]
        blocks.append((titles, lines))
    return in_blocks(blocks, nested=look.nested)


def cells_of(line: pd.DataFrame, look: TableLook) -> list[str]:
    """Return the cells of a line, without those of its block."""
    cells = [label_text(name, line[name].iloc[0]) for name in look.labels if name not in look.blocks]
    for column in look.shown:
        rows = rows_of(line, **column.of)
        if len(rows):
            cells += column.texts(rows.iloc[0].to_dict())
        else:
            cells += [column.none, ""] if column.ends else [column.none]
    return cells


def label_text(name: str, value: object) -> str:
    """Return a label as text."""
    text = f"{value:g}" if isinstance(value, float) else str(value)
    return text.replace("_", " ") if name in KEYS else text


def interval(row: Row, digits: int = 2) -> str:
    """Return the interval of the number of a row."""
    return interval_text(row["low"], row["high"], digits)


def percent(row: Row) -> str:
    """Return the number of a row, a share [-], in %."""
    return percent_text(row["value"])


def percent_text(share: float) -> str:
    """Return a share [-] in %, a dash where there is none."""
    return "-" if is_missing(share) else f"{100.0 * share:.1f}"


def column(name: str, layout: str = "") -> Callable[[Row], str]:
    """Return the text of a column of a row, in a format such as `.2f`."""
    return lambda row: format(row[name], layout)


def by_limb(title: str, shown: Sequence[ShownColumn]) -> TableLook:
    """Return a look at tests with a line for each method, blocks by limb, under a head of the titles."""
    return TableLook({"title": title, "limb": "Limb", "method": "Method"}, shown, blocks=("title", "limb"))


def average(metric: str) -> dict[str, object]:
    """Return the columns of a metric's mean over the joints of a limb."""
    return {"joint": AVERAGE, "metric": metric}
