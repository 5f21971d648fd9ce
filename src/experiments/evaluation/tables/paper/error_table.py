"""Tables of errors beside the printed numbers: a row is a method in a test, a column a joint or a mean."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice, pairwise, product
from pathlib import Path

from experiments.evaluation.compare.rmse import RAW
from experiments.evaluation.measure.estimates.scores import AVERAGE
from experiments.evaluation.number.grid import Column, Wanted, columns_of, number_of
from experiments.evaluation.number.number import Number, number_text, published_row
from experiments.evaluation.number.rows import Field, read_scores
from experiments.evaluation.tables.layout import PART, Line, Table, in_blocks, text_table, write_table
from experiments.settings.published import Floor, PublishedTable
from experiments.settings.runs import Statistics
from experiments.settings.tables import ErrorTable
from mobnet.core.columns import ERRORS, Score
from mobnet.core.joints import JointLayout

# Where they simulated, and where they measured.
OURS, PAPER = ("ours", "ours, simulated"), ("original", "original, robot")
RAW_LABEL = "raw truth"  # of the line of errors against it
ERROR = "rmse"  # how metrics begin that are such errors


@dataclass(frozen=True)
class TableRow:
    """A method in a test.

    Attributes:
        labels: what stands before the method, such as the uncertainty level, (k,).
        run: scenario, level and method.
        metric: of columns that have none of their own.
        numbers: column -> its number [N m], V1..V3 [N], or the metric's unit.
        raw: the same against the truth before the low-pass; empty where the metric is no error.
        short: whether intervals are left out of the text.
    """

    labels: tuple[str, ...]
    run: tuple[str, str, str]
    metric: str
    numbers: Mapping[Column, Number]
    raw: Mapping[Column, Number] = field(default_factory=dict)
    short: bool = False


@dataclass(frozen=True)
class TableLook:
    """How a table is laid out.

    Attributes:
        robot: whether the printed numbers were measured on the robot.
        floor: level and method of the row that later averages are compared with, or None.
        confidence: of the intervals, a share [-].
    """

    settings: ErrorTable
    robot: bool
    floor: Floor | None
    confidence: float


def error_table(
    settings: ErrorTable,
    name: str,
    statistics: Statistics,
    layout: JointLayout,
    published: PublishedTable | None,
    scores: Sequence[Path],
    table_dir: Path,
) -> None:
    """Write a table of errors by test, method and joint [N m], as CSV, TeX and Markdown.

    Raises:
        DataError: a run that the table needs is missing.
        ConfigError: a column is not well formed.
    """
    columns = columns_of(layout, settings.columns)
    read = read_scores(*scores)
    rows = list[TableRow]()
    for test in settings.rows:
        for method in (*test.methods, *test.further):
            run = test.scenario, test.level, method
            printed = published_row(published, test.paper, method) if published and test.paper else {}
            own = [score for score in read if (score.scenario, score.level, score.method) == run]
            numbers = numbers_of(columns, run, test.metric, own, statistics, printed)
            # only errors have a second truth to be taken against, and the paper prints none against it
            errors = [column for column in columns if is_error(column.metrics or (test.metric,))]
            raw = numbers_of(errors, run, test.metric, own, statistics, {}, RAW)
            known = {column: number for column, number in raw.items() if number.value is not None}
            rows.append(TableRow(test.labels, run, test.metric, numbers, known, method in test.further))
    robot, floor = (published.robot, published.floor) if published else (False, None)
    write_error_table(table_dir / name, rows, TableLook(settings, robot, floor, statistics.confidence))


def write_error_table(stem: Path, rows: Sequence[TableRow], look: TableLook) -> None:
    """Write a table of errors; in TeX one that is wider than a page becomes some, one below the other."""
    records: list[Sequence[Field]] = []
    for row in rows:
        records += records_of(row, row.numbers)
        records += records_of(row, row.raw, RAW)
    names = [column.name for column in rows[0].numbers]
    texts = []
    for first, end in pairwise([0, *map(names.index, look.settings.parts), len(names)]):
        part = [replace(row, numbers=cut(row.numbers, first, end), raw=cut(row.raw, first, end)) for row in rows]
        header = header_of(part[0], look)
        align = "l" * (len(header) - end + first) + "r" * (end - first)
        texts.append(text_table(align, header, table_lines(part, look, stacked=bool(look.settings.parts))))
    header = header_of(rows[0], look)
    lines = table_lines(rows, look)
    write_table(stem, Table(ERRORS, records, header, lines, len(header) - len(names)), PART.join(texts))


def records_of(row: TableRow, numbers: Mapping[Column, Number], ending: str = "") -> Iterator[Sequence[Field]]:
    """Yield the rows of CSV of a method in a test; the ending chooses the truth, as that of `cell_of`."""
    for column, ours in numbers.items():
        metrics = "+".join(name + ending for name in column.metrics or (row.metric,))
        yield (*row.run, column.name, metrics, *ours.with_ends, *ours.spread, ours.unit, ours.published)


def cut(numbers: Mapping[Column, Number], first: int, end: int) -> dict[Column, Number]:
    """Return the numbers of some columns, counted from 0 on [N m]."""
    return dict(islice(numbers.items(), first, end))


def numbers_of(
    columns: Sequence[Column],
    run: tuple[str, str, str],
    metric: str,
    scores: Sequence[Score],
    statistics: Statistics,
    printed: Mapping[str, float | None],
    ending: str = "",
) -> dict[Column, Number]:
    """Return the number of each column [N m], as `cell_of` does; `printed` is a column's name -> the paper's number."""
    numbers = {}
    for column in columns:
        numbers[column] = cell_of(column, run, metric, scores, statistics, printed.get(column.name), ending)
    return numbers


def cell_of(
    column: Column,
    run: tuple[str, str, str],
    metric: str,
    scores: Sequence[Score],
    statistics: Statistics,
    published: float | None,
    ending: str = "",
) -> Number:
    """Return the number of a column [N m] over the runs of a method in a test; none where a run has too few pushes.

    The ending chooses the truth that errors are taken against.
    """
    metrics = tuple(name + ending for name in column.metrics or (metric,))
    held = {score.metric for score in scores}
    if held and not held.issuperset(metrics):
        return Number(None, unit=column.unit, published=published)
    scenario, level, method = run
    wanted = []
    for (limb, joint), name in product(column.joints, metrics):
        wanted.append(Wanted(scenario, limb, level, method, joint, name))
    return number_of(scores, wanted, statistics, published=published)


def is_error(metrics: Sequence[str]) -> bool:
    """Return whether all of some metrics are errors that are measured against the raw truth, too."""
    return all(name.startswith(ERROR) for name in metrics)


def header_of(row: TableRow, look: TableLook) -> list[str]:
    """Return the heads of the columns; where torques [N m] and forces stand side by side, forces have their unit."""
    units = {column.name: number.unit for column, number in row.numbers.items()}
    mixed = len(set(units.values())) > 1
    heads = [f"{name} [N]" if mixed and unit == "N" else name for name, unit in units.items()]
    return [*look.settings.header, "Method", "", *heads]


def table_lines(rows: Sequence[TableRow], look: TableLook, stacked: bool = False) -> list[Line]:
    """Return the lines of text [N m], row by row; a rule stands where the first label changes.

    `stacked`: whether the ends of an interval stand one below the other.
    """
    blocks = []
    over = None
    for row in rows:
        blocks.append((row.labels, row_lines(row, over, look, stacked)))
        if look.floor and row.run[1:] == (look.floor.level, look.floor.method):
            over = row
    return in_blocks(blocks, nested=True)


def row_lines(row: TableRow, over: TableRow | None, look: TableLook, stacked: bool) -> list[list[str]]:
    """Return a method's lines [N m]: ours, its interval, ours against the raw truth, and the paper's, if it has any."""
    ours = list(row.numbers.values())
    share = f"{look.confidence:.0%}"
    lines = [[OURS[look.robot], *with_increase(row, over, "value")]]
    if not row.short and any(number.low is not None for number in ours):
        lines += (
            [
                [f"{share} from", *(number_text(number.low) for number in ours)],
                [f"{share} to", *(number_text(number.high) for number in ours)],
            ]
            if stacked
            else [[share, *(number.interval() for number in ours)]]
        )
    if row.raw:
        lines.append([RAW_LABEL, *(number_text(number.value) for number in row.raw.values())])
    if any(number.published is not None for number in ours):
        lines.append([PAPER[look.robot], *with_increase(row, over, "published")])
    method = look.settings.names.get(row.run[2], row.run[2])
    return [["" if k else method, *line] for k, line in enumerate(lines)]


def with_increase(row: TableRow, over: TableRow | None, name: str) -> list[str]:
    """Return the numbers of a row [N m]; its average carries the increase over a floor, as the paper prints it."""
    texts = []
    for column, number in row.numbers.items():
        value = getattr(number, name)
        base = over and getattr(over.numbers[column], name)
        texts.append(number_text(value))
        if column.name == AVERAGE and value is not None and base is not None:
            texts[-1] += f" ({value - base:+.2f})"
    return texts
