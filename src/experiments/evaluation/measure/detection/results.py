"""What detectors found, read from the files of robots: the robots of a level are taken together."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TypeVar

import numpy as np

from experiments.evaluation.number.clusters import ClusterKey, mean_in, share_in
from experiments.evaluation.number.number import Number
from experiments.plan.detection import Detections
from experiments.settings.detection_tables import AlarmTable, SmallestForce
from experiments.settings.runs import Statistics
from mobnet.core.arrays import Array
from mobnet.core.detections import Collision, CurvePoint, Detected, FreeSwing, Promise
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.rows import read_rows

Row = TypeVar("Row")
MS = 1000.0
LINKS, DIRECTIONS = ("foot", "ankle", "knee"), ("front", "side")  # in the paper's order
CELLS = tuple(f"{link} {direction}" for link, direction in product(LINKS, DIRECTIONS))
ALL = "all"  # cells together
HALF = 0.5  # share of the collisions whose force ranks detectors
HALVES, STEPS = 120, 24  # laws along the force for one half, and along the steepness


@dataclass(frozen=True)
class Try:
    """A collision of a robot and what a detector said of it."""

    robot: str
    collision: Collision
    detected: Detected

    @property
    def place(self) -> ClusterKey:
        """The robot and the walk, which collisions have in common."""
        return ClusterKey(self.robot, self.collision.seed)

    @property
    def cell(self) -> str:
        """What was hit from where."""
        return f"{self.collision.link} {self.collision.direction}"

    @property
    def is_found(self) -> bool:
        """Whether the detector found it."""
        return self.detected.delay_s is not None

    @property
    def named(self) -> str:
        """What the detector says was hit from where; empty where it found nothing."""
        return f"{self.detected.link} {self.detected.direction}".strip()


def owners(detections: Detections, level: str, levels: Sequence[str]) -> list[str]:
    """Return the robots of a level of the fleet, or the level itself where it is that of one plant.

    Raises:
        DataError: nobody was tried at the level.
    """
    found = [level] if level in detections else [name for name in detections if name not in levels]
    if not found:
        raise DataError(not_accepted("level of detectors", level, detections))
    return found


def rows_of(detections: Detections, names: Sequence[str], file: str, kind: type[Row], /, **held: str) -> list[Row]:
    """Return the rows of a file of some robots whose fields hold what is given."""
    found: list[Row] = []
    for name in names:
        for row in read_rows(detections[name][file], kind):
            if all(getattr(row, field) == value for field, value in held.items()):
                found.append(row)
    return found


def tries_of(detections: Detections, names: Sequence[str], scenario: str, leg: str, kind: str) -> dict[str, list[Try]]:
    """Return what each detector said of the collisions of a leg in a scenario, by a rule of thresholds."""
    found: dict[str, list[Try]] = {}
    for name in names:
        rows = rows_of(detections, [name], "collisions", Collision, scenario=scenario, leg=leg)
        collisions = {(row.seed, row.number): row for row in rows}
        for row in rows_of(detections, [name], "detected", Detected, scenario=scenario, leg=leg, kind=kind):
            found.setdefault(row.detector, []).append(Try(name, collisions[row.seed, row.number], row))
    return found


def shown_tries(
    settings: AlarmTable, detections: Detections, scenario: str, kind: str
) -> Iterator[tuple[str, dict[str, list[Try]]]]:
    """Yield each level of a table with what those of its detectors that were tried said, as `tries_of` does."""
    for level in settings.levels:
        tries = tries_of(detections, owners(detections, level, settings.levels), scenario, settings.leg, kind)
        yield level, {name: tries[name] for name in settings.detectors if name in tries}


def found_share(tries: Sequence[Try], statistics: Statistics) -> Number:
    """Return the share of collisions that a detector finds [-], with its interval."""
    return share_of(tries, lambda one: one.is_found, statistics)


def share_of(tries: Sequence[Try], is_so: Callable[[Try], bool], statistics: Statistics) -> Number:
    """Return the share of collisions of which something holds [-], with its interval over robots and walks."""
    return share_in([is_so(one) for one in tries], [one.place for one in tries], statistics)


def mean_of(tries: Sequence[Try], value_of: Callable[[Try], float | None], statistics: Statistics) -> Number:
    """Return the mean of times of collisions [ms] that have one [s], with its interval over robots and walks."""
    found = [(MS * value, one.place) for one in tries if (value := value_of(one)) is not None]
    return mean_in([value for value, _ in found], [place for _, place in found], statistics, "ms")


def delay_of(one: Try) -> float | None:
    """Return the delay of a collision that was found [s]."""
    return one.detected.delay_s


def median_of(values: Sequence[float], statistics: Statistics, unit: str) -> Number:
    """Return the median of values of collisions, with the interval between two of them that every law keeps [unit].

    It has no ends where there are too few values for such an interval.
    """
    if not values:
        return Number(None, unit=unit)
    from scipy.stats import quantile_test  # here, as it takes a second to import

    ends = quantile_test(values, p=0.5).confidence_interval(statistics.confidence)
    low, high = (None if np.isnan(end) else float(end) for end in (ends.low, ends.high))
    return Number(float(np.median(values)), low, high, unit=unit)


def hours_per_swing(promises: Sequence[Promise]) -> float:
    """Return how long a swing of a walk takes [h], the other leg's and the steps between included."""
    return sum(row.hours for row in promises) / max(sum(row.swings for row in promises), 1)


def alarms_in(swings: Sequence[FreeSwing], over: float = 1.0) -> int:
    """Return in how many swings a signal lies above a multiple of the threshold for one false alarm an hour."""
    return sum(row.ratio > over for row in swings)


def only_one(first: Sequence[Try], second: Sequence[Try]) -> dict[str, tuple[int, int]]:
    """Return robot -> how many collisions the first detector alone finds, and the second one alone."""
    found = {(one.place, one.collision.number): one.is_found for one in second}
    pairs: dict[str, tuple[int, int]] = {}
    for one in first:
        alone, other = pairs.get(one.robot, (0, 0))
        by_second = found[one.place, one.collision.number]
        pairs[one.robot] = alone + (one.is_found and not by_second), other + (by_second and not one.is_found)
    return pairs


def sign_test(first: int, second: int) -> float:
    """Return the exact two-sided probability of counts of discordant pairs, or of less equal ones, by chance [-].

    It takes collisions as independent of each other, as McNemar's test (1947, Psychometrika 12) does.
    """
    if not first + second:
        return 1.0
    from scipy.stats import binomtest  # here, as it takes a second to import

    return float(binomtest(first, first + second).pvalue)


def at_counted_rate(
    points: Mapping[str, Sequence[CurvePoint]], quiet: Sequence[FreeSwing], hours: float, rate_per_h: float
) -> dict[str, CurvePoint]:
    """Return robot -> what a detector finds at the lowest thresholds with at most a counted rate of false alarms [1/h].

    Points are those of each robot at multiples of its thresholds, and false alarms are counted in swings of all of
    them, which took so many hours. It is empty where all thresholds have more.
    """
    for factor in sorted({row.factor for rows in points.values() for row in rows}):
        if alarms_in(quiet, factor) <= rate_per_h * hours:
            return {robot: row for robot, rows in points.items() for row in rows if row.factor == factor}
    return {}


# The found share is a logistic function of the logarithm of the force. Of many such laws, with forces for one half and
# steepnesses spread evenly on a logarithmic scale, each counts as much as it makes what was found likely. The number is
# the median over them, and the interval that of the nominal share in their middle. A likeliest law alone would not do:
# where all collisions above a force are found and none below it, it is as steep as one allows.
def smallest_force(force: Array, found: Array, settings: SmallestForce, statistics: Statistics) -> Number:
    """Return the force of which a share of collisions is found [N], with its interval.

    Forces (n,) [N] are the largest ones of the collisions, found (n,) is 1 or 0. Where the force lies below or above
    all that were tried there is no number, but that end as `low` or as `high`; else the interval is cut there.
    """
    # (D23). A grid and no sampler: two unknowns, and the same bytes at every run.
    halves = np.geomspace(*settings.halves_n, HALVES)
    steepness = np.geomspace(*settings.steepness, STEPS)
    half, steep = (grid.ravel() for grid in np.meshgrid(halves, steepness, indexing="ij"))
    slope = steep * (np.log(force)[:, None] - np.log(half))
    # The logarithm of a share near 0 or 1 would be lost in rounding if the share came first.
    likely = -np.logaddexp(0.0, np.where(found[:, None] > 0, -slope, slope)).sum(axis=0)
    wanted = half * (settings.share / (1.0 - settings.share)) ** (1.0 / steep)
    tail = (1.0 - statistics.confidence) / 2.0
    low, value, high = quantiles(wanted, np.exp(likely - likely.max()), (tail, 0.5, 1.0 - tail))
    # Beyond the forces that were tried the number would be that of the assumed laws and not of the collisions.
    least = float(force.min())
    most = float(force.max())
    if not least <= value <= most:
        return Number(None, *((least, None) if value < least else (None, most)), unit="N")
    return Number(value, max(low, least), min(high, most), unit="N")


def half_force(tries: Sequence[Try], settings: SmallestForce, statistics: Statistics) -> Number:
    """Return the largest force of collisions of which a detector finds one half [N]: the mean over robots.

    Its interval is over robots; of one robot it has none. Where one robot's lies below or above all forces that were
    tried there is no number, but that end as `low` or as `high`.
    """
    of_half = settings.model_copy(update={"share": HALF})
    robots = sorted({one.robot for one in tries})
    found: list[Number] = []
    for robot in robots:
        own = [one for one in tries if one.robot == robot]
        force = np.array([one.collision.force_n for one in own])
        is_found = np.array([one.is_found for one in own], dtype=np.float64)
        found.append(smallest_force(force, is_found, of_half, statistics))
    values = [number.value for number in found if number.value is not None]
    if values and len(values) == len(found):
        return mean_in(values, [ClusterKey(robot, 0) for robot in robots], statistics, "N")
    without = [number for number in found if number.value is None]
    most = [number.high for number in without if number.high is not None]
    least = [number.low for number in without if number.low is not None]
    if most:
        return Number(None, None, max(most), unit="N")
    return Number(None, min(least, default=None), None, unit="N")


def force_text(number: Number) -> str:
    """Return a force with its interval as text; where it lies beyond all that were tried, beyond which of them."""
    if number.value is None:
        return f"< {number.low:.0f}" if number.low is not None else f"> {number.high:.0f}" if number.high else "-"
    return f"{number.text(0)} {number.interval(0)}".strip()


def quantiles(values: Array, weights: Array, shares: tuple[float, ...]) -> list[float]:
    """Return below which of some values (n,) these shares of their weights (n,) lie."""
    order = np.argsort(values)
    sums = np.cumsum(weights[order])
    return [float(values[order[np.searchsorted(sums, share * sums[-1])]]) for share in shares]
