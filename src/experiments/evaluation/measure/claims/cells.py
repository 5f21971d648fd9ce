"""All results: the runs behind any number of the scores and of the trainings, and the fields of tables."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

import logging
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd

from experiments.evaluation.measure.learning.trainings import MEASURES, read_trainings
from experiments.evaluation.number.frames import read_scores, rows_of
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.scored import CELL, cell_text, members, places_of, robots_of, run_grid
from experiments.intervals.crossed import RunGrid
from experiments.settings.claims import Cell
from experiments.settings.table_columns import RUN
from mobnet.core.errors import ConfigError, DataError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.core.rows import read_texts

log = logging.getLogger(__name__)

METRIC = "rmse"  # of a cell that names none
DIVERGED = "diverged"  # metric of all trainings, 1 of those that diverged; all others are of those that did not
ENDS = {"before": ("before_low", "before_high")}  # column of a table -> those of its interval, where they are not `low`
ALL = "all"  # joints together, in a table
WITH_ENDS = ("value", "ratio", "after", *ENDS)  # columns that have an interval


@dataclass(frozen=True)
class Evidence:
    """Scores by CELL, metrics scored by scenario, level and method, networks, rows of tables."""

    layout: JointLayout
    scores: Mapping[tuple[str, ...], pd.DataFrame]
    metrics: Mapping[tuple[str, ...], set[str]]
    networks: pd.DataFrame
    tables: Mapping[str, Sequence[Mapping[str, str]]] = field(default_factory=dict)

    def grids(self, cell: Cell) -> list[RunGrid] | None:
        """Return the runs of numbers whose mean is meant [unit of the metric]; a training is a network on one walk.

        The cell names a field of a table; a method and a metric of `MEASURES`; or scenario, level, method, joint and
        metric of the scores, where several joints, those of a limb and several metrics have a grid each. None is
        returned where the runs are there, but not what is asked of them: too short a test has no push, and trainings
        may diverge.

        Raises:
            ConfigError: joints are unknown or of unlike units, or something is missing.
            DataError: there is no such run.
        """
        metrics = listed(cell.metric or METRIC)
        if cell.table:
            return self._fields(cell)
        if metrics[0] in (*MEASURES, DIVERGED):
            return self._measured(str(cell.method), metrics[0])
        scenario = cell.scenario
        level = cell.level
        method = cell.method
        names = cell.joint
        if scenario is None or level is None or method is None or names is None:
            raise ConfigError(f"cell {cell}: scenario, level, method and joint are expected")
        scored = self.metrics.get((scenario, level, method))
        if scored is None:
            raise DataError(f"scores: no run of {method} in {scenario}, {level}")
        # The runs are there, but a test may be too short to hold what is asked, such as a push.
        if not scored.issuperset(metrics):
            return None
        joints: list[str] = []
        for name in listed(names):
            joints += members(self.layout, name)
        # A mean over torques and forces has no unit: `places_of` refuses it.
        places = places_of(self.layout, ", ".join(joints), joints)
        grids: list[RunGrid] = []
        for limb, joint in places:
            for metric in metrics:
                place = scenario, limb, level, method, joint, metric
                if place not in self.scores:
                    raise DataError(f"scores: no row for {cell_text(place)}")
                grids.append(run_grid(self.scores[place]))
        return grids

    def _measured(self, method: str, metric: str) -> list[RunGrid] | None:
        """Return a measure of the trainings of a method that did not diverge, (networks, 1); None where all did."""
        trained = rows_of(self.networks, method=method)
        if trained.empty:
            raise DataError(not_accepted("trainings", method, self.networks["method"].unique()))
        if metric == DIVERGED:
            return [RunGrid(trained[["diverged"]].to_numpy(dtype=np.float64))]
        good = trained[~trained["diverged"]]
        if good.empty:
            return None
        robots = robots_of(good["seed"].tolist())
        return [RunGrid(good[[MEASURES[metric][0]]].to_numpy(), method, robots)]

    def entry(self, cell: Cell) -> Number:
        """Return the number in a field of a table [its unit], with its interval; no number where the row has none.

        Raises:
            DataError: the table or a column is missing.
        """
        (row,) = self._rows(cell)
        column = str(cell.column)
        ends = ENDS.get(column, ("low", "high")) if column in WITH_ENDS else ("", "")
        value, low, high = (float(text) if (text := row.get(name)) else None for name in (column, *ends))
        return Number(value, low, high)

    def holds(self, cell: Cell) -> bool:
        """Return whether there is a run, or a row of a table, of what a cell asks for."""
        if cell.table:
            return bool(self._rows(cell))
        method = str(cell.method)
        run = (str(cell.scenario), str(cell.level), method)
        limbs = self.layout.limb_of
        for name in listed(cell.joint or ()):
            for joint in members(self.layout, name):
                for metric in listed(cell.metric or METRIC):
                    if (run[0], limbs[joint], run[1], method, joint, metric) not in self.scores:
                        return False
        return run in self.metrics

    def is_one(self, cell: Cell) -> bool:
        """Return whether one row of a table has what a cell asks for."""
        return len(self._rows(cell)) == 1

    def _fields(self, cell: Cell) -> list[RunGrid] | None:
        """Return the numbers in a column of a table; those of several rows, such as joints, are runs (1, n) [unit]."""
        numbers = [float(text) for row in self._rows(cell) if (text := row[str(cell.column)])]
        if not numbers:
            log.warning("%s: no row with %s has a number", cell.table, dict(cell.where))
        return [RunGrid(np.array([numbers]))] if numbers else None

    def _rows(self, cell: Cell) -> list[Mapping[str, str]]:
        """Return the rows of a table in which columns have the texts that a cell asks for.

        Where it asks for no joint, those of single joints are meant.
        """
        rows = self.tables[str(cell.table)]
        asked = {str(cell.column), *cell.where}
        columns = rows[0].keys() if rows else asked
        for name in sorted(asked - columns):
            raise DataError(not_accepted(f"column of {cell.table}", name, columns))
        # Beside its joints a table has a row for all of them together, which would count each joint twice.
        unasked = () if "joint" in cell.where else (ALL,)
        chosen: list[Mapping[str, str]] = []
        for row in rows:
            is_asked = all(row[key] == text for key, text in cell.where.items())
            if is_asked and row.get("joint") not in unasked:
                chosen.append(row)
        return chosen


def read_results(
    layout: JointLayout, scores: Iterable[Path], folders: Iterable[Path], cells: Sequence[Cell],
    tables: Mapping[str, Path] | None = None,
) -> Evidence:  # fmt: skip
    """Read the results that cells name: of scores, of folders of one limb's trained networks, and of tables."""
    asked: set[tuple[str, ...]] = set()
    for cell in cells:
        for metric in listed(cell.metric or METRIC):
            asked.add((str(cell.scenario), str(cell.level), str(cell.method), metric))
    wanted = pd.DataFrame(sorted(asked), columns=[*RUN, "metric"])
    by_cell: dict[tuple[str, ...], pd.DataFrame] = {}
    metrics: dict[tuple[str, ...], set[str]] = {}
    # Metrics of all runs are noted, so that a run without a metric is told from one that is missing.
    read = read_scores(*scores)
    for run, same in read.groupby(list(RUN), sort=False):
        metrics[tuple(map(str, run))] = set(same["metric"])
    for place, same in read.merge(wanted, on=list(wanted)).groupby(CELL, sort=False):
        by_cell[tuple(map(str, place))] = same
    rows = {name: read_texts(path) for name, path in (tables or {}).items()}
    networks, _ = read_trainings(folders)
    return Evidence(layout, by_cell, metrics, networks, rows)


def listed(names: str | Sequence[str]) -> list[str]:
    """Return one name or several as a list."""
    return [names] if isinstance(names, str) else list(names)
