"""A table as rows, which are written once: the CSV file holds them, and what a reader sees is a view of them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from experiments.evaluation.number.grid import AVERAGE, Lookup, Wanted
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import Line, Table, in_blocks, percent, write_table
from experiments.settings.runs import LimbRuns
from mobnet.core.columns import METHODS, SPREAD
from mobnet.core.joints import JointLayout

NONE = Number(None)
KEYS = ("scenario", "level", "robot", "set", "data")  # fields with names of the configuration, whose _ is a space


@dataclass(frozen=True)
class NumberRow:
    """A number at a place.

    Attributes:
        place: field -> what it holds, such as level, detector and quantity; one that is no column of the file is there
            for the view alone.
        number: the number.
        is_filed: whether the row is one of the CSV file's; the others are shown only.
    """

    place: Mapping[str, Field]
    number: Number = NONE
    is_filed: bool = True

    def holds(self, wanted: Mapping[str, Field]) -> bool:
        """Return whether its place has all of some fields."""
        return wanted.items() <= self.place.items()

    def labels(self, names: Sequence[str]) -> list[str]:
        """Return fields of its place as texts."""
        texts: list[str] = []
        for name in names:
            value = self.place[name]
            text = f"{value:g}" if isinstance(value, float) else str(value)
            texts.append(text.replace("_", " ") if name in KEYS else text)
        return texts


@dataclass(frozen=True)
class ViewColumn:
    """A column that a reader sees: of each line it shows the first row whose place has the fields `of`.

    Attributes:
        head: head of the column.
        of: fields of the row that is shown; none: the only row of its line.
        digits: of the number.
        ends: head of a second column, which has the number's interval; empty where there is none.
        text: what is shown in place of the number, made from the row; from an empty one where a line has none.
    """

    head: str
    of: Mapping[str, Field] = field(default_factory=dict[str, Field])
    digits: int = 2
    ends: str = ""
    text: Callable[[NumberRow], str] | None = None

    @property
    def heads(self) -> list[str]:
        """The heads of the column and, where it has one, of that of its interval."""
        return [self.head, self.ends] if self.ends else [self.head]

    def shows(self, row: NumberRow) -> bool:
        """Return whether its place has the fields of the column."""
        return row.holds(self.of)

    def texts(self, rows: Sequence[NumberRow]) -> list[str]:
        """Return its cells in a line of some rows."""
        shown = next((row for row in rows if self.shows(row)), NumberRow({}))
        text = self.text(shown) if self.text else shown.number.text(self.digits)
        return [text, shown.number.interval(self.digits)] if self.ends else [text]


@dataclass(frozen=True)
class View:
    """What a reader sees of rows: rows with equal labels are a line, and lines stand in the order of their first rows.

    Attributes:
        labels: field -> head of the leading columns, which say what a line is of. A row that lacks one of these fields
            is in no line.
        columns: columns of numbers. A line of which none shows a row is left out.
        blocks: fields; lines that have them in common stand together, and a rule stands between such blocks. One that
            is a label, as the first ones are, stands in the first line of its block alone.
        nested: whether labels of a block are left out while they stay the same, as `in_blocks` does.
        left: columns that are set flush left, if these are not the labels.
        note: text below the table.
    """

    labels: Mapping[str, str]
    columns: Sequence[ViewColumn]
    blocks: Sequence[str] = ()
    nested: bool = False
    left: int | None = None
    note: str = ""

    @property
    def titles(self) -> list[str]:
        """The fields of blocks that are labels."""
        return [name for name in self.blocks if name in self.labels]

    @property
    def header(self) -> list[str]:
        """The heads of all columns."""
        header = list(self.labels.values())
        for column in self.columns:
            header += column.heads
        return header

    def shows(self, rows: Sequence[NumberRow]) -> bool:
        """Return whether a column shows one of some rows."""
        return any(column.shows(row) for column in self.columns for row in rows)

    def cells(self, rows: Sequence[NumberRow]) -> list[str]:
        """Return the cells of a line of some rows, without those of its block."""
        cells = rows[0].labels([name for name in self.labels if name not in self.blocks])
        for column in self.columns:
            cells += column.texts(rows)
        return cells


@dataclass
class Rows:
    """The rows of a table, and the names of the columns of its CSV file."""

    columns: Sequence[str]
    held: list[NumberRow] = field(default_factory=list[NumberRow])

    def add(self, number: Number = NONE, /, **place: Field) -> None:
        """Add a row."""
        self.held.append(NumberRow(place, number))

    def show(self, number: Number = NONE, /, **place: Field) -> None:
        """Add a row that is shown only."""
        self.held.append(NumberRow(place, number, is_filed=False))

    @property
    def records(self) -> list[list[Field]]:
        """The rows of the CSV file."""
        return [self._record(row) for row in self.held if row.is_filed]

    def number(self, **wanted: Field) -> Number:
        """Return the number of the first row whose place has some fields; none where there is no such row."""
        return next((row.number for row in self.held if row.holds(wanted)), NONE)

    def table(self, view: View) -> Table:
        """Return the table with what a view shows of it."""
        left = len(view.labels) if view.left is None else view.left
        return Table(self.columns, self.records, view.header, self.lines(view), left=left, note=view.note)

    def write(self, stem: Path, view: View, tex: str = "") -> None:
        """Write the table as `stem.csv`, .tex and .md; `tex` is that of `write_table`."""
        write_table(stem, self.table(view), tex)

    def lines(self, view: View) -> list[Line]:
        """Return the lines of a view."""
        blocks: dict[tuple[Field, ...], dict[tuple[Field, ...], list[NumberRow]]] = {}
        for row in self.held:
            if row.place.keys() >= view.labels.keys():
                block = tuple(row.place[name] for name in view.blocks)
                line = tuple(row.place[name] for name in view.labels)
                blocks.setdefault(block, {}).setdefault(line, []).append(row)
        titled: list[tuple[list[str], list[list[str]]]] = []
        for by_line in blocks.values():
            lines = [view.cells(rows) for rows in by_line.values() if view.shows(rows)]
            if lines:
                first = next(iter(by_line.values()))[0]
                titled.append((first.labels(view.titles), lines))
        return in_blocks(titled, nested=view.nested)

    def _record(self, row: NumberRow) -> list[Field]:
        """Return the fields of a row in the CSV file."""
        number = row.number
        spread = dict(zip(SPREAD, number.spread, strict=True))
        value, low, high = number.with_ends
        own = {"value": value, "low": low, "high": high, "unit": number.unit, "published": number.published}
        held: Mapping[str, Field] = {**own, **spread, **row.place}
        return [held[name] for name in self.columns]


def field_text(name: str, layout: str = "") -> Callable[[NumberRow], str]:
    """Return the text of a field of a row's place, in a format such as `.2f`."""
    return lambda row: format(row.place.get(name, "-"), layout)


def interval(row: NumberRow) -> str:
    """Return the interval of the number of a row."""
    return row.number.interval()


def share_percent(row: NumberRow) -> str:
    """Return the number of a row, a share [-], in %."""
    return percent(row.number)


def measured(
    lookup: Lookup, layout: JointLayout, tests: Sequence[tuple[str, LimbRuns]], metrics: Sequence[str]
) -> Rows:
    """Return metrics of titled tests, columns METHODS: of each joint of the tests' limbs, and the limbs' averages.

    A view also has the `title`. Metrics of which there is no number are shown only.
    """
    rows = Rows(METHODS)
    for title, test in tests:
        for method in test.methods:
            for limb in test.limbs:
                for joint in (*layout.limb(limb), AVERAGE):
                    for metric in metrics:
                        wanted = Wanted(test.scenario, limb, test.level, method, joint, metric)
                        number = lookup.number([wanted])
                        add = rows.show if number.value is None else rows.add
                        add(number, title=title, **vars(wanted))
    return rows


def by_limb(title: str, columns: Sequence[ViewColumn]) -> View:
    """Return a view of what is measured with a line for each method, blocks by limb, under a head of the titles."""
    return View({"title": title, "limb": "Limb", "method": "Method"}, columns, blocks=("title", "limb"))


def average(metric: str) -> dict[str, Field]:
    """Return the fields of a metric's mean over the joints of a limb."""
    return {"joint": AVERAGE, "metric": metric}
