"""Readings of Table 3: the observer's errors under sensor noise alone, reading by reading, beside the paper's.

How far a reading is from the paper is one number for each limb, and one for all joints: the factor exp(mean |ln(ours /
paper)|), 1 where they agree. A factor, because joints differ by a hundred; of each joint, because an average hides it.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from experiments.evaluation.number.frames import read_scores, records_of
from experiments.evaluation.number.laws import fields_of, measured
from experiments.evaluation.number.number import Number, number_text, published_row
from experiments.evaluation.number.scored import columns_of, number_of, runs_of
from experiments.evaluation.tables.layout import RULE, Line, Table, write_table
from experiments.settings.published import PublishedTable
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import ERRORS, RUN
from experiments.settings.tables import NoiseTable
from mobnet.core.joints import JointLayout

METRIC = "rmse"
FACTOR = "factor"
ALL = "all"


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
    # A reading of the noise is a level of its own, with one method.
    readings = pd.DataFrame([(test.label, test.scenario, test.level, *test.methods) for test in settings.tests])
    readings.columns = ["label", *RUN]
    cells = readings.merge(columns_of(layout, settings.joints), how="cross").assign(metric=METRIC)
    runs = runs_of(read_scores(*scores), cells)
    place = ["cell", "label", *RUN, "limb", "joint", "metric"]
    errors = measured(runs, place, {METRIC: lambda same: number_of(same, statistics)})
    paper: dict[str, float | None] = {}
    for table, printed_at in settings.paper.items():
        paper |= published_row(printed[table], printed_at, readings["method"].iloc[0])
    errors["published"] = errors["joint"].map(paper).astype(float)
    by_reading = factors(errors)
    rows = pd.concat([errors, by_reading.assign(joint=by_reading["limb"], metric=FACTOR)])
    rows = pd.concat([rows[rows["label"] == label] for label in readings["label"]])
    header = ["Joint", "Unit", "Original", *readings["label"]]
    lines = noise_lines(errors, by_reading)
    write_table(table_dir / "noise", Table(ERRORS, records_of(rows, ERRORS), header, lines, left=2))


def factors(errors: pd.DataFrame) -> pd.DataFrame:
    """Return a row for each reading and limb, and for all joints: exp(mean |ln(ours / paper)|) [-] of its errors."""
    known = errors[(errors["value"] > 0) & (errors["published"] > 0)]
    known = known.assign(log=np.abs(np.log(known["value"] / known["published"])))
    rows: list[dict[str, object]] = []
    for run, reading in known.groupby(["label", *RUN], sort=False):
        logs = {str(limb): errors_of_limb["log"].mean() for limb, errors_of_limb in reading.groupby("limb", sort=False)}
        logs[ALL] = reading["log"].mean()
        for limb, log in logs.items():
            factor = fields_of(Number(float(np.exp(log))))
            rows.append({**dict(zip(["label", *RUN], run, strict=True)), "limb": limb, **factor})
    return pd.DataFrame(rows, columns=["label", *RUN, "limb", *fields_of(Number(None))])


def noise_lines(errors: pd.DataFrame, factors_by_reading: pd.DataFrame) -> list[Line]:
    """Return the lines of text, a joint each and a rule between limbs, then the factors."""
    lines: list[Line] = []
    for _, limb in errors.groupby("limb", sort=False):
        for joint, of_joint in limb.groupby("joint", sort=False):
            unit, published = of_joint[["unit", "published"]].iloc[0]
            lines.append([str(joint), unit, number_text(published), *map(number_text, of_joint["value"])])
        lines.append(RULE)
    for limb, of_limb in factors_by_reading.groupby("limb", sort=False):
        lines.append([f"factor, {limb}", "-", "", *map(number_text, of_limb["value"])])
    return lines
