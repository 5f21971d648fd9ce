"""Table of how much of what the tests ask about the training data hold."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from mobnet.core.columns import COVERAGE
from mobnet.evaluation.measure.coverage import ALL, NEAREST, Covered, covered
from mobnet.evaluation.number.number import number_text
from mobnet.evaluation.tables.layout import Line, Table, in_blocks, write_table


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
    records = [
        (row.scenario, row.level, row.measure, row.joint, row.block_count, row.with_rte, row.without_rte,
         *row.ratio.with_ends)
        for row in rows
    ]  # fmt: skip
    header = ["Test", "Level", "Measure", "With RTE", "Without RTE", "Ratio", f"{confidence:.0%}"]
    lines = coverage_lines([row for row in rows if row.joint == ALL])
    write_table(out_dir / "coverage", Table(COVERAGE, records, header, lines, left=3))


def coverage_lines(rows: Sequence[Covered]) -> list[Line]:
    """Return the rows of text, a rule between tests; shares in %."""
    blocks: dict[tuple[str, str], list[list[str]]] = {}
    for row in rows:
        values = row.with_rte, row.without_rte
        texts = [number_text(value) if row.measure in NEAREST else f"{value:.1%}" for value in values]
        labels = row.scenario.replace("_", " "), row.level.replace("_", " ")
        blocks.setdefault(labels, []).append([row.measure, *texts, row.ratio.text(), row.ratio.interval()])
    return in_blocks(blocks.items())
