"""Table of how much of what the tests ask about the training data hold."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from mobnet.core.files import write_text
from mobnet.evaluation.measure.coverage import (
    ALL,
    NEAREST,
    Covered,
    covered,
)
from mobnet.evaluation.number.rows import write_rows
from mobnet.evaluation.tables.layout import RULE, Line, markdown_table, number, span, text_table

log = logging.getLogger(__name__)


def coverage(
    config: Mapping[str, Any],
    training: Mapping[str, Sequence[str]],
    tests: Sequence[Mapping[str, Any]],
    out_dir: Path,
) -> None:
    """Write coverage.csv and, joints together only, coverage.tex and .md.

    Args:
        config: resolved configuration: `evaluation.confidence`, a share [-], and what `covered` needs.
        training: `with RTE` and `without RTE` -> stems of the recordings.
        tests: scenario, level and `recordings`, the stems, of each test.
        out_dir: gets the three files.

    Raises:
        DataError: a file or a column is missing.
    """
    rows, confidence = covered(config, training, tests), config["evaluation"]["confidence"]
    header = ["Test", "Level", "Measure", "With RTE", "Without RTE", "Ratio", f"{confidence:.0%}"]
    lines = coverage_lines([row for row in rows if row.joint == ALL])
    write_rows(out_dir / "coverage.csv", Covered, rows)
    write_text(out_dir / "coverage.tex", text_table("lllrrrr", header, lines))
    write_text(out_dir / "coverage.md", markdown_table(header, lines, left=3))
    log.info("%s: %d rows", out_dir / "coverage.csv", len(rows))


def coverage_lines(rows: Sequence[Covered]) -> list[Line]:
    """Return the rows of text, a rule between tests; shares in %."""
    lines: list[Line] = []
    before = None
    for row in rows:
        first = (row.scenario, row.level) != before
        if first and before is not None:
            lines.append(RULE)
        before = row.scenario, row.level
        names = [row.scenario.replace("_", " "), row.level.replace("_", " ")] if first else ["", ""]
        values = [f"{v:.1%}" if row.measure not in NEAREST else number(v) for v in (row.with_rte, row.without_rte)]
        lines.append([*names, row.measure, *values, number(row.ratio), span(row.low, row.high)])
    return lines
