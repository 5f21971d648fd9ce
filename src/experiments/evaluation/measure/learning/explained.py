"""What the trial of why a hit is hidden found, as its table has it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from experiments.evaluation.number.number import Number
from experiments.intervals.crossed import MEAN, RATIO, RunGrid, summarise
from experiments.settings.runs import Statistics
from mobnet.core.rows import read_rows

PATH = "path"  # what the inputs of a network bring in of a hit
ALL = "all"  # robots
FEW = 2  # robots of which the numbers of each are shown: an interval over two would say nothing


@dataclass(frozen=True)
class HitNumber:
    """A row of the table: a number of a method by its training set and way of learning.

    It is of one of the robots and there of one `network`, counted from 0 in the order of seeds, or of `all` robots,
    with the interval over them. `inputs` are those that bring in a hit.
    """

    data: str
    method: str
    way: str
    measure: str
    inputs: str
    robot: str
    network: int | None
    value: float
    low: float | None
    high: float | None
    unit: str


class LearnedCell(NamedTuple):
    """Networks that differ in their seed and robot alone: training set, method and way of learning."""

    data: str
    method: str
    way: str


def read_why(kept: Path) -> list[HitNumber]:
    """Read the rows of the table.

    Raises:
        DataError: the file is missing or damaged; one line for each fault.
    """
    return read_rows(kept, HitNumber)


def by_network(rows: Sequence[HitNumber], measure: str) -> dict[LearnedCell, dict[str, list[float]]]:
    """Return the networks of which a measure is known -> robot -> the number of each of them [unit of the measure]."""
    found: dict[LearnedCell, dict[str, list[float]]] = {}
    for row in rows:
        if row.measure == measure and row.robot != ALL:
            cell = LearnedCell(row.data, row.method, row.way)
            found.setdefault(cell, {}).setdefault(row.robot, []).append(row.value)
    return found


def by_robot(rows: Sequence[HitNumber], measure: str) -> dict[LearnedCell, dict[str, float]]:
    """Return the same with a mean over the networks of each robot."""
    found: dict[LearnedCell, dict[str, float]] = {}
    for cell, robots in by_network(rows, measure).items():
        found[cell] = {robot: float(np.mean(values)) for robot, values in robots.items()}
    return found


def spread_of(robots: Sequence[Mapping[str, Sequence[float]]]) -> tuple[int, float, float]:
    """Return how far numbers lie apart that differ in the seed of the network alone, and means of robots.

    Each item has robot -> the numbers of its networks. Of two networks of a robot the spread is a standard deviation,
    over all pairs of them; so it is of the means of two robots. Items without two of both are left out.

    Returns:
        The pairs of networks, the standard deviation over networks of a robot, and that over robots.
    """
    networks: list[float] = []
    means: list[float] = []
    for own in robots:
        whole = [values for values in own.values() if len(values) > 1]
        if len(whole) > 1:
            networks += [float(np.var(values, ddof=1)) for values in whole]
            means.append(float(np.var([np.mean(values) for values in whole], ddof=1)))
    return len(networks), float(np.sqrt(np.mean(networks))), float(np.sqrt(np.mean(means)))


def over_robots(values: Sequence[Mapping[str, float]], robots: Sequence[str], statistics: Statistics) -> Number:
    """Return the mean over robots of a measure [its unit], or of two measures the ratio of their means [-].

    It has its interval over robots, or, of a few robots, the smallest and the largest number of one of them.
    """
    own = np.array([[each[robot] for robot in robots] for each in values])
    rows = tuple(range(len(robots)))
    grids = [RunGrid(each[:, None], robots=rows) for each in own]
    number = summarise(grids, statistics, MEAN if len(own) == 1 else RATIO)
    if len(robots) > FEW:
        return number
    each = own[0] if len(own) == 1 else own[0] / own[1]
    return replace(number, low=float(each.min()), high=float(each.max()))
