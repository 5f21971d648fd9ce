"""Table and figure of the claims: made together, because they are judged together."""

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.figures.further.forest import forest
from experiments.evaluation.measure.claims.cells import read_results
from experiments.evaluation.measure.claims.verdicts import judge, rows_of
from experiments.evaluation.tables.further.claims_table import claim_table
from experiments.settings.claims import Cell, Claim, numbers_of
from experiments.settings.runs import Statistics
from mobnet.core.joints import JointLayout
from mobnet.settings.methods import Method

log = logging.getLogger(__name__)


def claims(
    claims: Mapping[str, Claim],
    statistics: Statistics,
    methods: Mapping[str, Method],
    layout: JointLayout,
    scores: Sequence[Path],
    folders: Sequence[Path],
    tables: Mapping[str, Path],
    table_dir: Path,
    figure_dir: Path,
) -> None:
    """Judge every claim; write claims.csv, .tex and .md and the figure. A claim that fails is a result, not an error.

    Raises:
        ConfigError: a cell of a claim is not well formed.
        DataError: a run that a claim needs is missing.
    """
    rows = list(rows_of(claims))
    cells: list[Cell] = []
    for row in rows:
        for made in numbers_of(row.claim):
            cells += made.cells
    results = read_results(layout, scores, folders, cells, tables)
    judged = [judge(row, results, statistics, methods) for row in rows]
    claim_table(judged, statistics.confidence, table_dir)
    forest(judged, statistics.confidence, figure_dir)
    for each in judged:
        log.info("%s: %s, %s %s", each.row.name, each.verdict, *each.ours.texts())
