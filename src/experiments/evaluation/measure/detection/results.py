"""What detectors found, read from the files of robots: the robots of a level are taken together."""

from collections.abc import Sequence
from itertools import product

import numpy as np
import pandas as pd

from experiments.evaluation.number.frames import ordered, read_detection, read_hits
from experiments.evaluation.number.number import Number, interval_text, is_missing, number_text
from experiments.intervals.clusters import ClusterKey, mean_in
from experiments.plan.detection import Detections
from experiments.settings.detection_tables import AlarmTable, SmallestForce
from experiments.settings.runs import Statistics
from mobnet.core.arrays import Array
from mobnet.core.errors import DataError, not_accepted

MS = 1000.0
LINKS, DIRECTIONS = ("foot", "ankle", "knee"), ("front", "side")  # in the paper's order
CELLS = tuple(f"{link} {direction}" for link, direction in product(LINKS, DIRECTIONS))
ALL = "all"  # cells together
HALF = 0.5  # share of the collisions whose force ranks detectors
HALVES, STEPS = 120, 24  # laws along the force for one half, and along the steepness


def owners(detections: Detections, level: str, levels: Sequence[str]) -> list[str]:
    """Return the robots of a level of the fleet, or the level itself where it is that of one plant.

    Raises:
        DataError: nobody was tried at the level.
    """
    robots = [level] if level in detections else [name for name in detections if name not in levels]
    if not robots:
        raise DataError(not_accepted("level of detectors", level, detections))
    return robots


def read_of_leg(settings: AlarmTable, detections: Detections, name: str) -> pd.DataFrame:
    """Return the rows of a file of detectors for a table: its levels, leg and detectors, in its order of them."""
    parts: list[pd.DataFrame] = []
    for level in settings.levels:
        robots = owners(detections, level, settings.levels)
        parts.append(read_detection(detections, robots, name).assign(level=level))
    rows = pd.concat(parts, ignore_index=True)
    return ordered(rows[rows["leg"] == settings.leg], level=settings.levels, detector=settings.detectors)


def hits_of(settings: AlarmTable, detections: Detections, scenario: str, kinds: Sequence[str]) -> pd.DataFrame:
    """Return what the detectors of a table said of the collisions in a scenario, by some rules of thresholds.

    Beside columns `HITS` there are `level`, `cell` and `named`, what was hit from where and what the detector names,
    and times [ms]: `delay_ms` and `perfect_ms` from the beginning on, `onset_ms` from when the force exceeds that of
    the second definition of a beginning. Level, kind, detector and cell are in the order of the table.
    """
    parts: list[pd.DataFrame] = []
    for level in settings.levels:
        robots = owners(detections, level, settings.levels)
        parts.append(read_hits(detections, robots).assign(level=level))
    hits = pd.concat(parts, ignore_index=True)
    hits = hits[(hits["scenario"] == scenario) & (hits["leg"] == settings.leg)]
    hits = ordered(hits, level=settings.levels, kind=kinds, detector=settings.detectors)
    hits["cell"] = pd.Categorical(hits["link"] + " " + hits["direction"], list(CELLS))
    hits["named"] = (hits["named_link"] + " " + hits["named_direction"]).str.strip()
    hits["delay_ms"] = MS * hits["delay_s"]
    hits["perfect_ms"] = MS * hits["perfect_s"]
    hits["onset_ms"] = MS * (hits["delay_s"] - (hits["onset_s"] - hits["start_s"]))
    return hits


def with_all(hits: pd.DataFrame) -> pd.DataFrame:
    """Return the hits, and all of them again as those of all cells together.

    Both parts have the same cells: a concatenation of others would lose their order.
    """
    cells = [*CELLS, ALL]
    in_cells = hits.assign(cell=hits["cell"].cat.set_categories(cells))
    every = hits.assign(cell=pd.Categorical([ALL] * len(hits), cells))
    return pd.concat([in_cells, every], ignore_index=True)


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


def hours_per_swing(promises: pd.DataFrame) -> float:
    """Return how long a swing of a walk takes [h], the other leg's and the steps between included."""
    return float(promises["hours"].sum()) / max(int(promises["swings"].sum()), 1)


def alarms_in(swings: pd.DataFrame, over: float = 1.0) -> int:
    """Return in how many swings a signal lies above a multiple of the threshold for one false alarm an hour."""
    return int((swings["ratio"] > over).sum())


def only_one(first: pd.DataFrame, second: pd.DataFrame) -> pd.DataFrame:
    """Return how many collisions of each robot the first detector alone finds, and the second one: `first`, `second`.

    The index has the robots.
    """
    of = ["robot", "seed", "number"]
    pairs = first.merge(second, on=of, suffixes=("", "_by_second"), validate="1:1")
    pairs["first"] = pairs["found"] & ~pairs["found_by_second"]
    pairs["second"] = pairs["found_by_second"] & ~pairs["found"]
    return pairs.groupby("robot", sort=False)[["first", "second"]].sum()


def sign_test(first: int, second: int) -> float:
    """Return the exact two-sided probability of counts of discordant pairs, or of less equal ones, by chance [-].

    It takes collisions as independent of each other, as McNemar's test (1947, Psychometrika 12) does.
    """
    if not first + second:
        return 1.0
    from scipy.stats import binomtest  # here, as it takes a second to import

    return float(binomtest(first, first + second).pvalue)


def at_counted_rate(points: pd.DataFrame, quiet: pd.DataFrame, hours: float, rate_per_h: float) -> pd.DataFrame:
    """Return what a detector finds at the lowest thresholds with at most a counted rate of false alarms [1/h].

    Points are those of each robot at multiples of its thresholds, and false alarms are counted in swings of all of
    them, which took so many hours. It is empty where all thresholds have more.
    """
    for factor in sorted(points["factor"].unique()):
        if alarms_in(quiet, factor) <= rate_per_h * hours:
            return points[points["factor"] == factor]
    return points.iloc[:0]


def found_at(points: pd.DataFrame) -> tuple[list[bool], list[ClusterKey]]:
    """Return whether each collision behind some points is found, and its cluster: all walks of a robot together."""
    flags: list[bool] = []
    places: list[ClusterKey] = []
    for robot, found_count, count in points[["robot", "found", "collisions"]].itertuples(index=False):
        flags += [True] * found_count + [False] * (count - found_count)
        places += [ClusterKey(robot, 0)] * count
    return flags, places


# The found share is a logistic function of the logarithm of the force. Of many such laws, with forces for one half and
# steepnesses spread evenly on a logarithmic scale, each counts as much as it makes what was found likely. The number is
# the median over them, and the interval that of the nominal share in their middle. A likeliest law alone would not do:
# where all collisions above a force are found and none below it, it is as steep as one allows.
def smallest_force(force: Array, is_found: Array, settings: SmallestForce, statistics: Statistics) -> Number:
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
    likely = -np.logaddexp(0.0, np.where(is_found[:, None] > 0, -slope, slope)).sum(axis=0)
    wanted = half * (settings.share / (1.0 - settings.share)) ** (1.0 / steep)
    tail = (1.0 - statistics.confidence) / 2.0
    low, value, high = quantiles(wanted, np.exp(likely - likely.max()), (tail, 0.5, 1.0 - tail))
    # Beyond the forces that were tried the number would be that of the assumed laws and not of the collisions.
    least = float(force.min())
    most = float(force.max())
    if not least <= value <= most:
        return Number(None, *((least, None) if value < least else (None, most)), unit="N")
    return Number(value, max(low, least), min(high, most), unit="N")


def half_force(hits: pd.DataFrame, settings: SmallestForce, statistics: Statistics) -> Number:
    """Return the largest force of collisions of which a detector finds one half [N]: the mean over robots.

    Its interval is over robots; of one robot it has none. Where one robot's lies below or above all forces that were
    tried there is no number, but that end as `low` or as `high`.
    """
    of_half = settings.model_copy(update={"share": HALF})
    robots: list[str] = []
    forces: list[Number] = []
    for robot, of_robot in hits.groupby("robot"):
        robots.append(str(robot))
        forces.append(force_of(of_robot, of_half, statistics))
    values = [number.value for number in forces if number.value is not None]
    if values and len(values) == len(forces):
        return mean_in(values, [ClusterKey(robot, 0) for robot in robots], statistics, "N")
    without = [number for number in forces if number.value is None]
    most = [number.high for number in without if number.high is not None]
    least = [number.low for number in without if number.low is not None]
    if most:
        return Number(None, None, max(most), unit="N")
    return Number(None, min(least, default=None), None, unit="N")


def force_of(hits: pd.DataFrame, settings: SmallestForce, statistics: Statistics) -> Number:
    """Return the force of which a share of some hits is found [N], as `smallest_force` does; none of no hit."""
    if hits.empty:
        return Number(None, unit="N")
    is_found = hits["found"].to_numpy(np.float64)
    return smallest_force(hits["force_n"].to_numpy(), is_found, settings, statistics)


def force_text(value: float | None, low: float | None, high: float | None) -> str:
    """Return a force with its interval as text; where it lies beyond all that were tried, beyond which of them."""
    if not is_missing(value):
        return f"{number_text(value, 0)} {interval_text(low, high, 0)}".strip()
    if not is_missing(low):
        return f"< {low:.0f}"
    return f"> {high:.0f}" if not is_missing(high) else "-"


def quantiles(values: Array, weights: Array, shares: tuple[float, ...]) -> list[float]:
    """Return below which of some values (n,) these shares of their weights (n,) lie."""
    order = np.argsort(values)
    sums = np.cumsum(weights[order])
    return [float(values[order[np.searchsorted(sums, share * sums[-1])]]) for share in shares]
