"""Table of how much of what the tests ask about the training data hold."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from mobnet.core.columns import COVERAGE
from mobnet.core.joints import JointLayout
from mobnet.evaluation.measure.data.coverage import ALL, NEAREST, WIDTH, Covered, covered
from mobnet.evaluation.number.number import number_text
from mobnet.evaluation.tables.layout import Line, Table, in_blocks, write_table
from mobnet.settings.evaluation import Coverage, Statistics
from mobnet.settings.networks import Limb


def coverage(
    settings: Coverage, layout: JointLayout, ports: Limb, statistics: Statistics,
    training: Mapping[str, Sequence[Path]], tests: Sequence[Sequence[Path]], table_dir: Path,
) -> None:  # fmt: skip
    """Write coverage.csv and, joints together only, coverage.tex and .md.

    `training` has the recordings `with RTE` and `without RTE`, `tests` those of each test.
    """
    rows = covered(settings, layout, ports, statistics, training, tests)
    records = [
        (row.scenario, row.level, row.measure, row.joint, row.block_count, row.with_rte, row.without_rte,
         *row.ratio.with_ends)
        for row in rows
    ]  # fmt: skip
    header = ["Test", "Level", "Measure", "With RTE", "Without RTE", "Ratio", f"{statistics.confidence:.0%}"]
    lines = coverage_lines([row for row in rows if row.joint == ALL])
    write_table(table_dir / "coverage", Table(COVERAGE, records, header, lines, left=3))


def coverage_lines(rows: Sequence[Covered]) -> list[Line]:
    """Return the rows of text, a rule between tests; shares in %."""
    blocks: dict[tuple[str, str], list[list[str]]] = {}
    numbers = (*NEAREST, *WIDTH.values())
    for row in rows:
        values = row.with_rte, row.without_rte
        texts = [number_text(value) if row.measure in numbers else f"{value:.1%}" for value in values]
        labels = row.scenario.replace("_", " "), row.level.replace("_", " ")
        blocks.setdefault(labels, []).append([row.measure, *texts, row.ratio.text(), row.ratio.interval()])
    return in_blocks(blocks.items())
