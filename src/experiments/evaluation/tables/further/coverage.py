"""Table of how much of what the tests ask about the training data hold."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.measure.data.coverage import ALL, NEAREST, WIDTH, WITHOUT, Covered, covered
from experiments.evaluation.number.number import number_text
from experiments.evaluation.tables.layout import Line, Table, in_blocks, write_table
from experiments.settings.measures import Coverage
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import COVERAGE
from mobnet.core.joints import JointLayout
from mobnet.settings.networks import Limb


def coverage(
    settings: Coverage,
    layout: JointLayout,
    ports: Limb,
    statistics: Statistics,
    training: Mapping[str, Sequence[Path]],
    tests: Sequence[Sequence[Path]],
    table_dir: Path,
) -> None:
    """Write coverage.csv and, joints together only, coverage.tex and .md.

    `training` has the recordings `without RTE` and those of each exploration with which they are compared, such as
    `with RTE`; `tests` those of each test.
    """
    compared: list[tuple[str, Covered]] = []
    for name, explored in training.items():
        if name != WITHOUT:
            rows = covered(settings, layout, ports, statistics, explored, training[WITHOUT], tests)
            compared += [(name, row) for row in rows]
    records = [
        (
            name,
            row.scenario,
            row.level,
            row.measure,
            row.joint,
            row.block_count,
            row.with_rte,
            row.without_rte,
            *row.ratio.with_ends,
        )
        for name, row in compared
    ]
    header = ["Training", "Test", "Level", "Measure", "With", "Without", "Ratio", f"{statistics.confidence:.0%}"]
    lines = coverage_lines([(name, row) for name, row in compared if row.joint == ALL])
    write_table(table_dir / "coverage", Table(COVERAGE, records, header, lines, left=4))


def coverage_lines(compared: Sequence[tuple[str, Covered]]) -> list[Line]:
    """Return the rows of text, a rule between explorations; shares in %."""
    blocks: dict[tuple[str, str, str], list[list[str]]] = {}
    numbers = (*NEAREST, *WIDTH.values())
    for name, row in compared:
        values = row.with_rte, row.without_rte
        texts = [number_text(value) if row.measure in numbers else f"{value:.1%}" for value in values]
        labels = name, row.scenario.replace("_", " "), row.level.replace("_", " ")
        blocks.setdefault(labels, []).append([row.measure, *texts, row.ratio.text(), row.ratio.interval()])
    return in_blocks(blocks.items(), nested=True)
