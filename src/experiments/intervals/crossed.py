"""Intervals over networks and walks that hold what they print, also with few of both (docs/notes/measures.md).

Runs are a grid, every network on every walk: a run's error is a mean, an effect of its network, an effect of its walk
and a rest. The variance of a number is estimated as the sum of two: that of its rows over the networks, for each method
apart because networks of different methods have nothing in common, and that of its columns over the walks, for all
methods together because they share the walks. The sum has the rest twice and so is rather too large than too small.
Of surrogate robots a row is a robot with its networks, and all methods together have the rows, too. Each robot has
walks of its own, whose variance is part of that over the robots' means, which alone counts.

An interval reaches sqrt(sum t^2 s^2 / n) to each side, where each variance s^2 over n has a quantile t of its own of
Student's law with n - 1 degrees of freedom. With normal effects it covers what it prints or more (Banerjee 1960,
Sankhya 22). Errors, which are positive, and their ratios have it on a log scale.
"""

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy  # pyright: ignore[reportMissingTypeStubs]  # its parts are imported where they are used first
from numpy.typing import NDArray

from experiments.intervals.number import Number
from experiments.intervals.rule import IntervalRule

STEP = 1e-6  # of a derivative, as a share of what changes
Array = NDArray[np.float64]
Combine = Callable[[Array], Array]


@dataclass(frozen=True)
class RunGrid:
    """Runs of one number, (networks, walks) [its unit]; a method without networks has one row.

    `rows` says what the rows are: networks of this method, unless `robots` has the seed of each row's robot. Grids with
    the same and with equally many rows have them in common, row by row. Grids with equally many columns have walks of
    the same seeds, column by column, but each of several robots has walks of its own.
    """

    values: Array
    rows: str = ""
    robots: tuple[int, ...] = ()

    @property
    def has_own_walks(self) -> bool:
        """Whether no row has a walk of another one."""
        return len(self.robots) > 1

    def of(self, robots: Sequence[int]) -> "RunGrid":
        """Return the runs of some of the robots."""
        kept = [robot in robots for robot in self.robots]
        return RunGrid(self.values[kept], self.rows, tuple(robots))

    @property
    def mean(self) -> float:
        """The mean over all runs [its unit]."""
        return float(self.values.mean())


@dataclass(frozen=True)
class Formula:
    """How a number is made of K means: it is the least of P parts, of which there is mostly one.

    Attributes:
        parts: makes the parts (P, ...) of the means (K, ...); they are smooth.
        shown: makes a number of each part: it rises or falls everywhere, or folds at zero.
        positive: whether parts of positive means are positive and so have their interval on a log scale.
    """

    parts: Combine
    shown: Combine = lambda parts: parts
    positive: bool = False


@dataclass(frozen=True)
class Effects:
    """Variances of P parts, (P,), over n networks or walks that are drawn together."""

    count: int
    variances: Array


MEAN = Formula(lambda means: means.mean(axis=0, keepdims=True), positive=True)
RATIO = Formula(lambda means: means[:1] / means[1:2], positive=True)


def summarise(grids: Sequence[RunGrid], statistics: IntervalRule, formula: Formula = MEAN, unit: str = "-") -> Number:
    """Return the number that a formula makes of the means of K grids, with its interval [unit].

    With one network and one walk there is no interval, with several of one of them it is over these alone. There is no
    number where the formula gives none, such as a ratio to zero.
    """
    grids = over_common_robots(grids)
    means = np.array([grid.mean for grid in grids])
    # A ratio to zero is no fault of the caller: its number is left out below.
    with np.errstate(divide="ignore", invalid="ignore"):
        parts = formula.parts(means)
        slopes = slopes_of(formula.parts, means)
    crossed = [not grid.has_own_walks for grid in grids]
    networks = effects_of(grids, slopes, 0)
    shared_walks = effects_of([grid for grid in grids if not grid.has_own_walks], slopes[:, crossed], 1)
    walks = [*shared_walks, *own_walks_of(grids, slopes)]
    counts = Number(None, unit=unit, networks=counts_of(networks), walks=counts_of(walks))
    if not np.isfinite(parts).all() or not np.isfinite(slopes).all():
        return counts
    shown = formula.shown(parts)
    least = int(shown.argmin())
    drawn = [each for each in (*networks, *shared_walks) if each.count > 1]
    # Errors and their ratios have their interval on a log scale, which a run of zero or below does not have.
    on_logs = formula.positive and all((grid.values > 0).all() for grid in grids)
    low, high = ends_of(formula, parts, drawn, statistics.confidence, on_logs) if drawn else (None, None)
    # Variances are those of a part; what is shown of it, such as the size of a gap, may change at another rate.
    steepness = abs(float(slopes_of(formula.shown, parts)[least, least]))
    stds = [std_of(each, least) for each in (networks, walks)]
    std_networks, std_walks = (None if std is None else steepness * std for std in stds)
    value = float(shown[least])
    return replace(counts, value=value, low=low, high=high, std_networks=std_networks, std_walks=std_walks)


def over_common_robots(grids: Sequence[RunGrid]) -> list[RunGrid]:
    """Return grids of which those of robots have the robots that all of these have.

    Some robots walk only the tests of a leg, with fewer methods. What robots differ by is no difference between
    methods.
    """
    robots = [set(grid.robots) for grid in grids if grid.robots]
    common: list[int] = sorted(set[int].intersection(*robots)) if robots else []
    return [grid.of(common) if grid.robots else grid for grid in grids]


def slopes_of(made: Combine, at: Array) -> Array:
    """Return the derivatives (P, K) of P numbers that are made of K others, at these (K,) [any unit]."""
    steps = STEP * np.maximum(np.abs(at), STEP)
    both = np.diag(steps)
    return (made(at[:, None] + both) - made(at[:, None] - both)) / (2.0 * steps)


def effects_of(grids: Sequence[RunGrid], slopes: Array, axis: int) -> list[Effects]:
    """Return the variances of parts over networks or robots (axis 0), kind by kind, or over walks (axis 1).

    The slopes (P, K) are those of the parts by the means of the grids.
    """
    groups: dict[tuple[str, int], Array] = {}
    for grid, slope in zip(grids, slopes.T, strict=True):
        means = grid.values.mean(axis=1 - axis)
        # All methods share the walks, and grids with the same rows share these. What they share is drawn once, so its
        # effects are added before they are squared; other rows are drawn apart.
        rows = f"robots {grid.robots}" if grid.robots else grid.rows
        key = ("" if axis else rows, len(means))
        groups[key] = groups.get(key, 0.0) + slope[:, None] * (means - grid.mean)
    return [Effects(count, (apart**2).sum(axis=1) / max(1, count - 1)) for (_, count), apart in groups.items()]


def own_walks_of(grids: Sequence[RunGrid], slopes: Array) -> list[Effects]:
    """Return the variances of parts over walks that are a robot's own, of one walk of each robot."""
    groups: dict[tuple[str, int], Array] = {}
    for grid, slope in zip(grids, slopes.T, strict=True):
        if grid.has_own_walks:
            deviations = grid.values - grid.values.mean(axis=1, keepdims=True)
            key = (str(grid.robots), deviations.shape[1])
            groups[key] = groups.get(key, 0.0) + slope[:, None, None] * deviations
    effects: list[Effects] = []
    for (_, count), deviations in groups.items():
        within = (deviations**2).sum(axis=2) / max(1, count - 1)
        effects.append(Effects(count, within.mean(axis=1) / deviations.shape[1]))
    return effects


def counts_of(effects: Sequence[Effects]) -> tuple[int, ...]:
    """Return how many networks, or walks, each group has."""
    return tuple(each.count for each in effects)


def std_of(effects: Sequence[Effects], part: int) -> float | None:
    """Return the standard deviation of a part if one network of each method, or one walk, were drawn; None of one."""
    drawn = [float(each.variances[part]) for each in effects if each.count > 1]
    return sum(drawn) ** 0.5 if drawn else None


def ends_of(
    formula: Formula, parts: Array, effects: Sequence[Effects], confidence: float, on_logs: bool
) -> tuple[float, float]:
    """Return the ends of the interval of the least of parts (P,) [its unit].

    The lower end is the least of the parts' own. The upper one is that of all P at once (Bonferroni), since any of them
    may be the least.
    """
    at_once = 1.0 - (1.0 - confidence) / len(parts)
    low = shown_range(formula, parts, reach_of(effects, confidence), on_logs)[0]
    high = shown_range(formula, parts, reach_of(effects, at_once), on_logs)[1]
    return float(low.min()), float(high.min())


def reach_of(effects: Sequence[Effects], confidence: float) -> Array:
    """Return how far the intervals of parts reach to each side, (P,) [their unit]."""
    shares = [quantile_of(each.count - 1, confidence) ** 2 * each.variances / each.count for each in effects]
    return np.sqrt(np.sum(shares, axis=0))


@functools.cache
def quantile_of(degrees: int, confidence: float) -> float:
    """Return between which quantile of Student's law and its negative the share `confidence` lies [-]."""
    return float(scipy.special.stdtrit(degrees, (1.0 + confidence) / 2.0))


def shown_range(formula: Formula, parts: Array, reach: Array, on_logs: bool) -> Array:
    """Return the lowest and the highest number (2, P) of parts (P,) within their reach (P,) [their unit]."""
    if on_logs:
        low = parts * np.exp(-reach / parts)
        high = parts * np.exp(reach / parts)
    else:
        low = parts - reach
        high = parts + reach
    # A number that folds at zero, such as the size of a gap, is least there and not at an end.
    shown = np.stack([formula.shown(each) for each in (low, high, np.clip(0.0, low, high))])
    return np.stack([shown.min(axis=0), shown.max(axis=0)])
