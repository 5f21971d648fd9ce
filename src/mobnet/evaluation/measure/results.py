"""All results: the runs behind any number, of the scores or of the trainings."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import Score
from mobnet.core.errors import ConfigError, DataError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.evaluation.measure.averages import column_of, members
from mobnet.evaluation.measure.trainings import MEASURES, Training, read_trainings, sound
from mobnet.evaluation.number.grid import Wanted, run_grid
from mobnet.evaluation.number.rows import read_scores
from mobnet.settings.claims import Cell

METRIC = "rmse"  # of a cell that names none


@dataclass(frozen=True)
class Results:
    """Scores by what they are of, metrics scored by scenario, level and method, and trainings by method."""

    layout: JointLayout
    scores: Mapping[Wanted, Sequence[Score]]
    metrics: Mapping[tuple[str, ...], set[str]]
    trainings: Mapping[str, Sequence[Training]]

    def grid(self, cell: Cell) -> NDArray[np.float64] | None:
        """Return the runs of a number (networks, tests) [unit of its metric]; a training is a network on one test.

        The cell names a method and a metric of `MEASURES`; or scenario, level, method, joint and metric of the scores,
        where several joints, those of a limb and several metrics are averaged. None is returned where the runs are
        there, but not what is asked of them: too short a test has no push, and trainings may diverge.

        Raises:
            ConfigError: joints are unknown or of unlike units, or something is missing.
            DataError: there is no such run.
        """
        metrics = listed(cell.metric or METRIC)
        if metrics[0] in MEASURES:
            return self._measured(str(cell.method), metrics[0])
        scenario, level, method, names = cell.scenario, cell.level, cell.method, cell.joint
        if scenario is None or level is None or method is None or names is None:
            raise ConfigError(f"cell {cell}: scenario, level, method and joint are expected")
        held = self.metrics.get((scenario, level, method))
        if held is None:
            raise DataError(f"scores: no run of {method} in {scenario}, {level}")
        if not held.issuperset(metrics):
            return None
        joints = [joint for name in listed(names) for joint in members(self.layout, name)]
        places = column_of(self.layout, ", ".join(joints), joints, metrics).joints
        wanted = [Wanted(scenario, limb, level, method, joint, name) for limb, joint in places for name in metrics]
        return np.mean([run_grid(self.scores.get(each, ()), each) for each in wanted], axis=0)

    def _measured(self, method: str, metric: str) -> NDArray[np.float64] | None:
        """Return a measure of the trainings of a method that did not diverge, (networks, 1); None where all did."""
        if method not in self.trainings:
            raise DataError(not_accepted("trainings", method, self.trainings))
        good = sound(self.trainings[method])
        return np.array([[MEASURES[metric][0](training)] for training in good]) if good else None


def read_results(layout: JointLayout, scores: Iterable[Path], folders: Iterable[Path]) -> Results:
    """Read all results: files of scores, and folders of trained networks of one limb."""
    found: dict[Wanted, list[Score]] = defaultdict(list)
    metrics: dict[tuple[str, ...], set[str]] = defaultdict(set)
    for row in (row for path in scores for row in read_scores(path)):
        found[Wanted(row.scenario, row.limb, row.level, row.method, row.joint, row.metric)].append(row)
        metrics[row.scenario, row.level, row.method].add(row.metric)
    return Results(layout, found, metrics, read_trainings(folders))


def listed(names: str | Sequence[str]) -> list[str]:
    """Return one name or several as a list."""
    return [names] if isinstance(names, str) else list(names)
