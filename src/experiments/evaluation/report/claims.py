"""Table and figure of the claims: made together, because they are judged together."""

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from experiments.evaluation.figures.further.forest import forest
from experiments.evaluation.measure.claims.cells import read_results
from experiments.evaluation.measure.claims.scale import KnownMethods, control_of, stand_ins_of, weaknesses_of
from experiments.evaluation.measure.claims.verdicts import claims_frame, judged, rows_of, score_of
from experiments.evaluation.measure.claims.verdicts import numbers_of as measured_numbers
from experiments.evaluation.tables.further.claims_table import claim_table
from experiments.settings.claims import Cell, Claim, numbers_of
from experiments.settings.runs import Statistics
from mobnet.core.joints import JointLayout
from mobnet.settings.detection import Detection
from mobnet.settings.methods import Method

log = logging.getLogger(__name__)


def claims(
    claims: Mapping[str, Claim],
    statistics: Statistics,
    methods: Mapping[str, Method],
    detection: Detection,
    published: Mapping[str, str],
    layout: JointLayout,
    scores: Sequence[Path],
    folders: Sequence[Path],
    tables: Mapping[str, Path],
    table_dir: Path,
    figure_dir: Path,
) -> None:
    """Judge every claim; write claims.csv, .tex and .md and the figure. A claim that fails is a result, not an error.

    `published` are the methods of the paper, with their places in it.

    Raises:
        ConfigError: a cell of a claim is not well formed.
        DataError: a run that a claim needs is missing.
    """
    rows = list(rows_of(claims))
    known = KnownMethods(methods, detection.detectors, published)
    cells: list[Cell] = []
    for row in rows:
        for claim in (row.claim, *stand_ins_of(row.claim, known).values()):
            for made in numbers_of(claim):
                cells += made.cells
    results = read_results(layout, scores, folders, cells, tables)
    records: list[dict[str, Any]] = []
    for row in rows:
        numbers = measured_numbers(row.claim, results, statistics)
        score = score_of(row.claim, methods)
        control = control_of(row.claim, results, statistics, known)
        weaknesses = weaknesses_of(row.claim, score, numbers.ours, control, known)
        records.append(judged(row, numbers, score, statistics, control, weaknesses))
        log.info("%s: %s, %s %s", row.name, records[-1]["verdict"], *numbers.ours.texts())
    table = claims_frame(records)
    claim_table(table, statistics.confidence, table_dir)
    forest(table, statistics.confidence, figure_dir)
