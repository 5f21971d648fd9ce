"""All results at hand: the runs behind any number, of the scores or of the trainings."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import Score
from mobnet.core.config import load_layout
from mobnet.core.errors import ConfigError, DataError, not_accepted
from mobnet.core.joints import JointLayout
from mobnet.evaluation.measure.averages import column_of, members
from mobnet.evaluation.measure.trainings import MEASURES, Training, read_trainings, sound
from mobnet.evaluation.number.files import read_rows
from mobnet.evaluation.number.grid import Wanted, run_grid

METRIC = "rmse"  # of a cell that names none
RUN = ("scenario", "level", "method")


@dataclass(frozen=True)
class Results:
    """Scores and trainings, found by what they are of.

    Attributes:
        layout: joints and limbs.
        scores: what -> rows of its runs.
        metrics: scenario, level and method -> metrics of their scores.
        trainings: method -> its trainings.
    """

    layout: JointLayout
    scores: Mapping[Wanted, Sequence[Score]]
    metrics: Mapping[tuple[str, ...], set[str]]
    trainings: Mapping[str, Sequence[Training]]

    def grid(self, cell: Mapping[str, Any]) -> NDArray[np.float64] | None:
        """Return the runs of a number (networks, tests) [unit of its metric]; a training is a network on one test.

        Args:
            cell: method, and `metric`, a name of `kinds.MEASURES`; or scenario, level, method, `joint` and `metric` of
                the scores, where several joints, those of a limb and several metrics are averaged.

        Returns:
            None where the runs are there, but not what is asked of them: too short a test has no push, and trainings
            may diverge.

        Raises:
            ConfigError: joints are unknown or of unlike units, or something is missing.
            DataError: there is no such run.
        """
        metrics = listed(cell.get("metric", METRIC))
        if metrics[0] in MEASURES:
            return self._measured(cell["method"], metrics[0])
        missing = [key for key in (*RUN, "joint") if key not in cell]
        if missing:
            raise ConfigError(f"cell {dict(cell)}: {missing[0]} is missing")
        scenario, level, method = run = tuple(cell[key] for key in RUN)
        if run not in self.metrics:
            raise DataError(f"scores: no run of {method} in {scenario}, {level}")
        if not self.metrics[run].issuperset(metrics):
            return None
        joints = [joint for name in listed(cell["joint"]) for joint in members(self.layout, name)]
        places = column_of(self.layout, ", ".join(joints), joints, metrics).joints
        wanted = [Wanted(scenario, limb, level, method, joint, name) for limb, joint in places for name in metrics]
        return np.mean([run_grid(self.scores.get(each, ()), each) for each in wanted], axis=0)

    def _measured(self, method: str, metric: str) -> NDArray[np.float64] | None:
        """Return a measure of a method's trainings that did not diverge, (networks, 1) [-]; None where all did."""
        if method not in self.trainings:
            raise DataError(not_accepted("trainings", method, self.trainings))
        good = sound(self.trainings[method])
        return np.array([[MEASURES[metric][0](training)] for training in good]) if good else None


def read_results(robot: Path, scores: Iterable[Path], folders: Iterable[str]) -> Results:
    """Read all results.

    Args:
        robot: table of the robot, for joints and limbs.
        scores: files of scores.
        folders: of trained networks of one limb.

    Raises:
        DataError: a file is missing or damaged.
    """
    found: dict[Wanted, list[Score]] = defaultdict(list)
    metrics: dict[tuple[str, ...], set[str]] = defaultdict(set)
    for row in (row for path in scores for row in read_rows(path, Score)):
        found[Wanted(row.scenario, row.limb, row.level, row.method, row.joint, row.metric)].append(row)
        metrics[row.scenario, row.level, row.method].add(row.metric)
    return Results(load_layout(robot), found, metrics, read_trainings(folders))


def listed(names: str | Sequence[str]) -> list[str]:
    """Return one name or several as a list."""
    return [names] if isinstance(names, str) else list(names)
