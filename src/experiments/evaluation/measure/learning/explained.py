"""What the trial of why a hit is hidden found, as its table has it."""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from experiments.evaluation.number.frames import WHY, read_frame
from experiments.evaluation.number.number import Number
from experiments.intervals.crossed import MEAN, RATIO, RunGrid, summarise
from experiments.settings.runs import Statistics

PATH = "path"  # what the inputs of a network bring in of a hit
ALL = "all"  # robots
FEW = 2  # robots of which the numbers of each are shown: an interval over two would say nothing


NETWORKS = ["data", "method", "way"]  # columns: networks that have these in common differ in their seed and robot alone
Learned = tuple[str, str, str]  # training set, method and way of learning of such networks


def read_why(kept: Path) -> pd.DataFrame:
    """Read the table: columns `WHY`, a row for each network, and one for all robots.

    Raises:
        DataError: the file is missing or damaged; one line for each fault.
    """
    return read_frame(kept, WHY, may_lack=("network", "low", "high"))


def by_network(rows: pd.DataFrame, measure: str) -> dict[Learned, dict[str, list[float]]]:
    """Return the networks of which a measure is known -> robot -> the number of each of them [unit of the measure]."""
    single = rows[(rows["measure"] == measure) & (rows["robot"] != ALL)]
    numbers: dict[Learned, dict[str, list[float]]] = {}
    for (*learned, robot), same in single.groupby([*NETWORKS, "robot"], sort=False):
        data, method, way = map(str, learned)
        numbers.setdefault((data, method, way), {})[str(robot)] = same["value"].tolist()
    return numbers


def by_robot(rows: pd.DataFrame, measure: str) -> dict[Learned, dict[str, float]]:
    """Return the same with a mean over the networks of each robot."""
    means: dict[Learned, dict[str, float]] = {}
    for learned, robots in by_network(rows, measure).items():
        means[learned] = {robot: float(np.mean(values)) for robot, values in robots.items()}
    return means


def spread_of(robots: Sequence[Mapping[str, Sequence[float]]]) -> tuple[int, float, float]:
    """Return how far numbers lie apart that differ in the seed of the network alone, and means of robots.

    Each item has robot -> the numbers of its networks. Of two networks of a robot the spread is a standard deviation,
    over all pairs of them; so it is of the means of two robots. Items without two of both are left out.

    Returns:
        The pairs of networks, the standard deviation over networks of a robot, and that over robots.
    """
    networks: list[float] = []
    means: list[float] = []
    for of_robots in robots:
        whole = [values for values in of_robots.values() if len(values) > 1]
        if len(whole) > 1:
            networks += [float(np.var(values, ddof=1)) for values in whole]
            means.append(float(np.var([np.mean(values) for values in whole], ddof=1)))
    return len(networks), float(np.sqrt(np.mean(networks))), float(np.sqrt(np.mean(means)))


def over_robots(
    values: Sequence[Mapping[str, float]], robots: Sequence[str], statistics: Statistics, unit: str = "-"
) -> Number:
    """Return the mean over robots of a measure [unit], or of two measures the ratio of their means [-].

    It has its interval over robots.
    """
    numbers = np.array([[each[robot] for robot in robots] for each in values])
    rows = tuple(range(len(robots)))
    grids = [RunGrid(each[:, None], robots=rows) for each in numbers]
    return summarise(grids, statistics, MEAN if len(numbers) == 1 else RATIO, unit)


def over_shown_robots(values: Sequence[Mapping[str, float]], robots: Sequence[str], statistics: Statistics) -> Number:
    """Return the same; of a few robots with the smallest and the largest number of one of them as its ends."""
    number = over_robots(values, robots, statistics)
    if len(robots) > FEW:
        return number
    numbers = np.array([[each[robot] for robot in robots] for each in values])
    each = numbers[0] if len(numbers) == 1 else numbers[0] / numbers[1]
    return replace(number, low=float(each.min()), high=float(each.max()))
