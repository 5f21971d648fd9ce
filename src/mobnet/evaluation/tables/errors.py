"""Tables of the paper, ours beside the printed numbers: a row is a method in a test, a column a joint or a mean."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from mobnet.core.config import load_layout
from mobnet.core.files import write_text
from mobnet.evaluation.measure.averages import Column, columns_of
from mobnet.evaluation.number.grid import Wanted, run_grid, unit_of
from mobnet.evaluation.number.intervals import mean, summarise
from mobnet.evaluation.number.published import published_row, read_published
from mobnet.evaluation.number.rows import Cell, Score, read_rows, write_rows
from mobnet.evaluation.tables.error_text import TableRow, look_of, table_markdown, table_tex

log = logging.getLogger(__name__)

METRIC = "rmse"  # of a row that names none


def table(config: Mapping[str, Any], name: str, scores: Mapping[str, Path], out_dir: Path) -> None:
    """Write one of Tables 5, 6, 7, 10 and 11, errors by test, method and joint [N m], as CSV, TeX and Markdown.

    Args:
        config: resolved configuration: `robot`, `published`, `evaluation.tables` and what intervals need.
        name: the table's key in `evaluation.tables` and among the published ones; names the files.
        scores: scenario -> its scores.
        out_dir: gets the three files.

    Raises:
        DataError: a run that the table needs is missing.
        ConfigError: the published numbers do not fit the table, or a column is not well formed.
    """
    spec = config["evaluation"]["tables"][name]
    entry = read_published(Path(config["published"]), name)
    rows = table_rows(config, spec, entry, scores)
    write_rows(out_dir / f"{name}.csv", Cell, [cell for row in rows for cell in row.cells])
    look = look_of(spec, entry, config["evaluation"]["confidence"])
    write_text(out_dir / f"{name}.tex", table_tex(rows, look))
    write_text(out_dir / f"{name}.md", table_markdown(rows, look))
    log.info("%s: %d rows", out_dir / f"{name}.csv", len(rows))


def table_rows(
    config: Mapping[str, Any], spec: Mapping[str, Any], entry: Mapping[str, Any], scores: Mapping[str, Path]
) -> list[TableRow]:
    """Return the rows of a table [N m], a row a method of a test, in its order.

    Args:
        config: resolved configuration.
        spec: the table's `columns` and `rows`.
        entry: what the paper prints.
        scores: scenario -> its scores.

    Raises:
        DataError: a run is missing.
        ConfigError: as `table` says.
    """
    columns = columns_of(load_layout(Path(config["robot"])), spec["columns"])
    read = {name: read_rows(scores[name], Score) for name in dict.fromkeys(test["scenario"] for test in spec["rows"])}
    rows = []
    for test in spec["rows"]:
        for method in test["methods"]:
            printed = published_row(entry, test["paper"], method) if "paper" in test else {}
            cells = cells_of(config, columns, test, method, read[test["scenario"]], printed)
            rows.append(TableRow(tuple(test["labels"]), tuple(cells)))
    return rows


def cells_of(
    config: Mapping[str, Any],
    columns: Sequence[Column],
    test: Mapping[str, Any],
    method: str,
    scores: Sequence[Score],
    printed: Mapping[str, float | None],
) -> Iterator[Cell]:
    """Yield the cells [N m] of a method in a test, column by column; without a number where a run has too few pushes.

    Raises:
        DataError: a run is missing.
    """
    run = (test["scenario"], test["level"], method)
    own = [score for score in scores if (score.scenario, score.level, score.method) == run]
    held = {score.metric for score in own}
    for column in columns:
        metrics, known = column.metrics or (test.get("metric", METRIC),), printed.get(column.name)
        what = (*run, column.name)
        if held and not held.issuperset(metrics):
            yield Cell(*what, 0, "+".join(metrics), None, None, None, column.unit, known)
            continue
        wanted = [Wanted(run[0], limb, *run[1:], joint, metric) for limb, joint in column.joints for metric in metrics]
        ours = summarise([run_grid(own, each) for each in wanted], config, mean)
        yield Cell(
            *what, ours.count, "+".join(metrics), ours.value, ours.low, ours.high, unit_of(own, wanted[0]), known
        )
