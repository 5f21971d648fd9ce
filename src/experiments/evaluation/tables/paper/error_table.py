"""Tables of errors beside the printed numbers: a row is a method in a test, a column a joint or a mean."""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import pandas as pd

from experiments.evaluation.compare.rmse import RAW
from experiments.evaluation.number.frames import read_scores, records_of
from experiments.evaluation.number.laws import measured
from experiments.evaluation.number.number import interval_text, is_missing, number_text, published_value
from experiments.evaluation.number.scored import AVERAGE, columns_of, number_of, runs_of
from experiments.evaluation.tables.layout import PART, Line, Table, in_blocks, text_table, write_table
from experiments.settings.published import Floor, PublishedTable
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import ERRORS, RUN
from experiments.settings.tables import ErrorTable
from mobnet.core.joints import JointLayout

# Where they simulated, and where they measured.
OURS, PAPER = ("ours", "ours, simulated"), ("original", "original, robot")
RAW_LABEL = "raw truth"  # of the line of errors against it
ERROR = "rmse"  # how metrics begin that are such errors
PLACE = ["line", "truth", "column"]  # of a number: its method in a test, the ending of its metrics, its column


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
    cells = cells_of(settings, columns_of(layout, settings.columns))
    numbers = numbers_of(cells, read_scores(*scores), statistics)
    numbers["published"] = [
        published_value(published, str(row.paper), str(row.method), str(row.column))
        if published and row.paper and not row.truth
        else None
        for row in numbers.itertuples()
    ]
    robot, floor = (published.robot, published.floor) if published else (False, None)
    write_error_table(table_dir / name, numbers, settings, robot, floor, statistics.confidence)


def cells_of(settings: ErrorTable, columns: pd.DataFrame) -> pd.DataFrame:
    """Return what a table asks for, a row for each method in a test, truth, column, joint and metric."""
    lines: list[dict[str, object]] = []
    for test in settings.rows:
        for method in (*test.methods, *test.further):
            run = dict(zip(RUN, (test.scenario, test.level, method), strict=True))
            is_short = method in test.further
            line = {"labels": test.labels, "paper": test.paper or "", "short": is_short, "own_metric": test.metric}
            lines.append({"line": len(lines), **run, **line})
    cells = pd.DataFrame(lines).merge(columns, how="cross")
    cells["metric"] = cells["metric"].where(cells["metric"] != "", cells["own_metric"])
    # Only errors have a second truth to be taken against.
    cells["is_error"] = cells["metric"].str.startswith(ERROR)
    are_errors = cells.groupby(["line", "column"], observed=True)["is_error"].transform("all")
    errors = cells[are_errors]
    # Of `errors` and not of `cells`, whose rows an empty frame would take over.
    raw = errors.assign(truth=RAW, metric=errors["metric"] + RAW)
    both = pd.concat([cells.assign(truth=""), raw])
    return both.sort_values("line", kind="stable", ignore_index=True)


def numbers_of(cells: pd.DataFrame, scores: pd.DataFrame, statistics: Statistics) -> pd.DataFrame:
    """Return a row for each number of a table [N m], V1..V3 [N], or the metric's unit.

    There is none where a test is too short for what is asked, such as a push; against the raw truth the row is left
    out, too.
    """
    walked = pd.MultiIndex.from_frame(cells[[*RUN]]).isin(pd.MultiIndex.from_frame(scores[[*RUN]]))
    measures = [*RUN, "metric"]
    is_scored = pd.MultiIndex.from_frame(cells[measures]).isin(pd.MultiIndex.from_frame(scores[measures]))
    cells = cells.assign(lacks=walked & ~is_scored)
    of_number = cells.groupby(PLACE, observed=True)
    is_there = ~of_number["lacks"].transform("any")
    metrics = of_number["metric"].agg(lambda names: "+".join(names.unique())).rename("metric")
    runs = runs_of(scores, cells[is_there])
    errors = measured(runs, PLACE, {"error": lambda same: number_of(same, statistics)}).drop(columns="published")
    asked = cells.drop_duplicates(PLACE).drop(columns="metric")
    numbers = asked.merge(metrics, on=PLACE).merge(errors, how="left", on=PLACE)
    numbers["unit"] = numbers["unit"].fillna(numbers["torque_unit"])
    return numbers[(numbers["truth"] == "") | numbers["value"].notna()]


def write_error_table(
    stem: Path, numbers: pd.DataFrame, settings: ErrorTable, robot: bool, floor: Floor | None, confidence: float
) -> None:
    """Write a table of errors; in TeX one that is wider than a page becomes some, one below the other.

    Args:
        stem: path without an ending.
        numbers: a row for each number, as `numbers_of` returns them, with the paper's.
        settings: of the table.
        robot: whether the printed numbers were measured on the robot.
        floor: level and method of the row that later averages are compared with, or None.
        confidence: of the intervals, a share [-].
    """
    names = list(numbers["column"].unique())
    texts: list[str] = []
    for first, end in pairwise([0, *map(names.index, settings.parts), len(names)]):
        part = numbers[numbers["column"].isin(names[first:end])]
        header = header_of(settings, part)
        align = "l" * (len(header) - end + first) + "r" * (end - first)
        lines = table_lines(settings, part, robot, floor, confidence, stacked=bool(settings.parts))
        texts.append(text_table(align, header, lines))
    header = header_of(settings, numbers)
    lines = table_lines(settings, numbers, robot, floor, confidence)
    records = records_of(numbers.rename(columns={"joint": "first_joint", "column": "joint"}), ERRORS)
    write_table(stem, Table(ERRORS, records, header, lines, len(header) - len(names)), PART.join(texts))


def header_of(settings: ErrorTable, numbers: pd.DataFrame) -> list[str]:
    """Return the heads of the columns; where torques [N m] and forces stand side by side, forces have their unit."""
    units = numbers.drop_duplicates("column").set_index("column")["unit"]
    is_mixed = units.nunique() > 1
    heads = [f"{name} [N]" if is_mixed and unit == "N" else str(name) for name, unit in units.items()]
    return [*settings.header, "Method", "", *heads]


def table_lines(
    settings: ErrorTable,
    numbers: pd.DataFrame,
    robot: bool,
    floor: Floor | None,
    confidence: float,
    *,
    stacked: bool = False,
) -> list[Line]:
    """Return the lines of text [N m], row by row; a rule stands where the first label changes.

    `stacked`: whether the ends of an interval stand one below the other.
    """
    blocks: list[tuple[Sequence[str], list[list[str]]]] = []
    over = None
    for _, row in numbers.groupby("line"):
        first = row.iloc[0]
        ours = row[row["truth"] == ""]
        lines = row_lines(ours, row[row["truth"] == RAW], over, robot, f"{confidence:.0%}", stacked=stacked)
        method = str(settings.names.get(first["method"], first["method"]))
        blocks.append((first["labels"], [["" if k else method, *line] for k, line in enumerate(lines)]))
        if floor and (first["level"], first["method"]) == (floor.level, floor.method):
            over = ours
    return in_blocks(blocks, nested=True)


def row_lines(
    ours: pd.DataFrame, raw: pd.DataFrame, over: pd.DataFrame | None, robot: bool, share: str, *, stacked: bool
) -> list[list[str]]:
    """Return a method's lines [N m]: ours, its interval, ours against the raw truth, and the paper's, if it has any."""
    lines = [[OURS[robot], *with_increase(ours, over, "value")]]
    if not ours["short"].any() and ours["low"].notna().any():
        if stacked:
            lines.append([f"{share} from", *map(number_text, ours["low"])])
            lines.append([f"{share} to", *map(number_text, ours["high"])])
        else:
            lines.append([share, *map(interval_text, ours["low"], ours["high"])])
    if len(raw):
        lines.append([RAW_LABEL, *map(number_text, raw["value"])])
    if ours["published"].notna().any():
        lines.append([PAPER[robot], *with_increase(ours, over, "published")])
    return lines


def with_increase(row: pd.DataFrame, over: pd.DataFrame | None, name: str) -> list[str]:
    """Return the numbers of a row [N m]; its average carries the increase over a floor, as the paper prints it."""
    texts = dict(zip(row["column"], map(number_text, row[name]), strict=True))
    if over is not None and AVERAGE in texts:
        value, base = (part.set_index("column")[name][AVERAGE] for part in (row, over))
        if not is_missing(value) and not is_missing(base):
            texts[AVERAGE] += f" ({value - base:+.2f})"
    return list(texts.values())
