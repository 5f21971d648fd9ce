"""Readings of Table 3: the observer's errors under sensor noise alone, reading by reading, beside the paper's.

How far a reading is from the paper is one number for each limb, and one for all joints: the factor exp(mean |ln(ours /
paper)|), 1 where they agree. A factor, because joints differ by a hundred; of each joint, because an average hides it.
"""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.number.grid import Column, Wanted, columns_of, number_of
from experiments.evaluation.number.number import Number, number_text, published_row
from experiments.evaluation.number.rows import read_scores
from experiments.evaluation.tables.layout import RULE, Line, Table, write_table
from experiments.settings.published import PublishedTable
from experiments.settings.runs import Statistics
from experiments.settings.tables import NoiseTable
from mobnet.core.columns import ERRORS
from mobnet.core.joints import JointLayout

METRIC = "rmse"
FACTOR = "factor"
ALL = "all"
Readings = Mapping[str, tuple[Sequence[Number], Mapping[str, Number]]]  # label -> errors by joint, factors by limb


def noise(
    settings: NoiseTable,
    statistics: Statistics,
    layout: JointLayout,
    printed: Mapping[str, PublishedTable],
    scores: Sequence[Path],
    table_dir: Path,
) -> None:
    """Write noise.csv, .tex and .md: RMSE [N m] of each joint by reading, V1..V3 [N], and each reading's factors [-].

    Raises:
        DataError: a run that the table needs is missing.
    """
    read = read_scores(*scores)
    columns = columns_of(layout, settings.joints)
    readings = {}
    # A reading of the noise is a level of its own, with one method.
    records = []
    for test in settings.tests:
        run = test.scenario, test.level, test.methods[0]
        paper: dict[str, float | None] = {}
        for table, place in settings.paper.items():
            paper |= published_row(printed[table], place, run[2])
        wanted: list[Wanted] = []
        for column in columns:
            wanted += [Wanted(run[0], limb, *run[1:], joint) for limb, joint in column.joints]
        errors = [number_of(read, [one], statistics, published=paper.get(one.joint)) for one in wanted]
        by_limb = factors(columns, errors)
        readings[test.label] = errors, by_limb
        named = [*((one.joint, METRIC) for one in wanted), *((limb, FACTOR) for limb in by_limb)]
        numbers = [*errors, *by_limb.values()]
        records += [
            (*run, name, metric, *ours.with_ends, *ours.spread, ours.unit, ours.published)
            for (name, metric), ours in zip(named, numbers, strict=True)
        ]
    header = ["Joint", "Unit", "Paper", *readings]
    write_table(table_dir / "noise", Table(ERRORS, records, header, noise_lines(columns, readings), left=2))


def factors(columns: Sequence[Column], errors: Sequence[Number]) -> dict[str, Number]:
    """Return limb -> exp(mean |ln(ours / paper)|) [-] of errors, one for each column, and ALL -> that of all joints."""
    logs: dict[str, list[float]] = {}
    for column, ours in zip(columns, errors, strict=True):
        if ours.value and ours.published:
            logs.setdefault(column.joints[0][0], []).append(abs(math.log(ours.value / ours.published)))
    logs[ALL] = [each for own in logs.values() for each in own]
    return {limb: Number(math.exp(sum(own) / len(own))) for limb, own in logs.items() if own}


def noise_lines(columns: Sequence[Column], readings: Readings) -> list[Line]:
    """Return the lines of text, a joint each and a rule between limbs, then the factors."""
    lines: list[Line] = []
    before = columns[0].joints[0][0]
    for column, own in zip(columns, zip(*(errors for errors, _ in readings.values()), strict=True), strict=True):
        limb = column.joints[0][0]
        lines += [RULE] if limb != before else []
        lines.append([column.name, column.unit, number_text(own[0].published), *(ours.text() for ours in own)])
        before = limb
    lines.append(RULE)
    found = [of for _, of in readings.values()]
    for limb in found[0]:
        lines.append([f"factor, {limb}", "-", "", *(of[limb].text() for of in found)])
    return lines
