"""Table of how much of what the tests ask about the training data hold."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd

from experiments.evaluation.measure.data.coverage import ALL, NEAREST, WIDTH, WITHOUT, covered
from experiments.evaluation.number.frames import records_of, rows_of
from experiments.evaluation.number.number import interval_text, number_text
from experiments.evaluation.tables.layout import Line, Table, in_blocks, write_table
from experiments.settings.measures import Coverage
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import COVERAGE
from mobnet.core.joints import JointLayout
from mobnet.formats.network import Limb


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
    parts: list[pd.DataFrame] = []
    for name, explored in training.items():
        if name != WITHOUT:
            rows = covered(settings, layout, ports, statistics, explored, training[WITHOUT], tests)
            parts.append(rows.assign(training=name))
    compared = pd.concat(parts)
    header = ["Training", "Test", "Level", "Measure", "With", "Without", "Ratio", f"{statistics.confidence:.0%}"]
    lines = coverage_lines(rows_of(compared, joint=ALL))
    write_table(table_dir / "coverage", Table(COVERAGE, records_of(compared, COVERAGE), header, lines, left=4))


def coverage_lines(compared: pd.DataFrame) -> list[Line]:
    """Return the rows of text, a rule between explorations; shares in %."""
    numbers = (*NEAREST, *WIDTH.values())
    blocks: list[tuple[list[str], list[list[str]]]] = []
    for (name, scenario, level), same in compared.groupby(["training", "scenario", "level"], sort=False):
        labels = [str(name), str(scenario).replace("_", " "), str(level).replace("_", " ")]
        lines: list[list[str]] = []
        for row in same.to_dict("records"):
            values = row["with_rte"], row["without_rte"]
            texts = [number_text(value) if row["measure"] in numbers else f"{value:.1%}" for value in values]
            lines.append([row["measure"], *texts, number_text(row["ratio"]), interval_text(row["low"], row["high"])])
        blocks.append((labels, lines))
    return in_blocks(blocks, nested=True)
