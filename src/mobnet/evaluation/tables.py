"""Tables of the paper, ours beside the printed numbers."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from mobnet.core.files import write_text
from mobnet.evaluation.intervals import summarise
from mobnet.evaluation.markup import GAP, RULE, Line, markdown_table, number, span, text_table
from mobnet.evaluation.published import published_value, read_published
from mobnet.evaluation.rows import Cell, Score, read_rows, write_rows
from mobnet.evaluation.runs import Wanted, run_grid, unit_of
from mobnet.evaluation.scores import AVERAGE

log = logging.getLogger(__name__)


def table_05(config: Mapping[str, Any], scores_csv: Path, out_dir: Path) -> None:
    """Write Table 5: RMSE [N m] of the left leg by uncertainty level and method, as CSV, TeX and Markdown.

    Args:
        config: resolved configuration: `evaluation.table_05`, `published`.
        scores_csv: scores of its scenario.
        out_dir: gets table_05.csv, .tex and .md.

    Raises:
        DataError: a run that the table needs is missing.
        ConfigError: the published numbers do not fit the table.
    """
    entry = read_published(Path(config["published"]), "table_05")
    cells = table_cells(config, config["evaluation"]["table_05"], entry, read_rows(scores_csv, Score))
    write_rows(out_dir / "table_05.csv", Cell, cells)
    write_text(out_dir / "table_05.tex", table_tex(cells, entry, config["evaluation"]["confidence"]))
    write_text(out_dir / "table_05.md", table_markdown(cells, entry, config["evaluation"]["confidence"]))
    log.info("%s: %d cells", out_dir / "table_05.csv", len(cells))


def table_cells(
    config: Mapping[str, Any], layout: Mapping[str, Any], entry: Mapping[str, Any], scores: Sequence[Score]
) -> list[Cell]:
    """Return the cells of a table of levels x methods x joints, in its order.

    Args:
        config: resolved configuration.
        layout: the table's `scenario`, `limb` and `levels` (level -> methods).
        entry: what the paper prints; names the joints.
        scores: rows of that scenario.

    Raises:
        DataError: a run is missing.
    """
    cells = []
    for level, methods in layout["levels"].items():
        for method in methods:
            for joint in entry["joints"]:
                wanted = Wanted(layout["scenario"], layout["limb"], level, method, joint, entry["metric"])
                ours = summarise([run_grid(scores, wanted)], config)
                known = published_value(entry, level, method, joint)
                cells.append(Cell(
                    wanted.scenario, level, method, joint, ours.count, wanted.metric,
                    ours.value, ours.low, ours.high, unit_of(scores, wanted), known,
                ))  # fmt: skip
    return cells


def table_tex(cells: Sequence[Cell], entry: Mapping[str, Any], confidence: float) -> str:
    """Return the table [N m] as a TeX tabular, laid out as in the paper; `confidence` is a share [-]."""
    header = ["Uncertainty level", "Method", "", *entry["joints"]]
    return text_table("lll" + "r" * len(entry["joints"]), header, _lines(cells, entry, confidence))


def table_markdown(cells: Sequence[Cell], entry: Mapping[str, Any], confidence: float) -> str:
    """Return the table [N m] as Markdown, laid out as in the paper; `confidence` is a share [-]."""
    header = ["Uncertainty level", "Method", "", *entry["joints"]]
    return markdown_table(header, _lines(cells, entry, confidence), left=len(header) - len(entry["joints"]))


def _lines(cells: Sequence[Cell], entry: Mapping[str, Any], confidence: float) -> list[Line]:
    """Return the rows of text, level by level and method by method."""
    lines: list[Line] = []
    seen: list[str] = []
    for level, method in dict.fromkeys((cell.level, cell.method) for cell in cells):
        row = [cell for cell in cells if (cell.level, cell.method) == (level, method)]
        first = level not in seen
        if seen:
            lines.append(RULE if first else GAP)
        over = _floor(cells, entry) if entry["floor"]["level"] in seen and level != entry["floor"]["level"] else None
        seen.append(level)
        lines += _method_lines(row, entry["labels"].get(level, level) if first else "", over, confidence)
    return lines


def _method_lines(row: Sequence[Cell], label: str, over: Cell | None, confidence: float) -> list[Line]:
    """Return a method's rows of text: ours, then its interval and the paper's numbers, if there are any."""
    lines: list[Line] = [[label, row[0].method, "ours", *_values(row, over, "value")]]
    if any(cell.low is not None for cell in row):
        lines.append(["", "", f"{confidence:.0%}", *(span(cell.low, cell.high) for cell in row)])
    if any(cell.published is not None for cell in row):
        lines.append(["", "", "paper", *_values(row, over, "published")])
    return lines


def _values(row: Sequence[Cell], over: Cell | None, field: str) -> list[str]:
    """Return the numbers of a row; the average carries its increase over a floor, as the paper prints it."""
    texts = [number(getattr(cell, field)) for cell in row]
    value, base = getattr(row[-1], field), getattr(over, field, None)
    if row[-1].joint == AVERAGE and value is not None and base is not None:
        texts[-1] += f" ({value - base:+.2f})"
    return texts


def _floor(cells: Sequence[Cell], entry: Mapping[str, Any]) -> Cell | None:
    """Return the average that later rows are compared with, or None if the table lacks it."""
    wanted = (entry["floor"]["level"], entry["floor"]["method"], AVERAGE)
    return next((cell for cell in cells if (cell.level, cell.method, cell.joint) == wanted), None)
