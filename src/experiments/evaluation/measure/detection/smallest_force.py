"""The smallest force that a detector finds: the law of the found share over the force, and its interval.

The found share is a logistic function of the logarithm of the force. Of many such laws, with forces for one half and
steepnesses spread evenly on a logarithmic scale, each counts as much as it makes what was found likely. The number is
the median over them, and the interval that of the nominal share in their middle. A likeliest law alone would not do:
where all collisions above a force are found and none below it, it is as steep as one allows.
"""

import numpy as np

from experiments.evaluation.number.number import Number
from experiments.settings.detection_tables import SmallestForce
from experiments.settings.runs import Statistics
from mobnet.core.arrays import Array

HALVES, STEPS = 120, 24  # laws along the force for one half, and along the steepness


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


def quantiles(values: Array, weights: Array, shares: tuple[float, ...]) -> list[float]:
    """Return below which of some values (n,) these shares of their weights (n,) lie."""
    order = np.argsort(values)
    sums = np.cumsum(weights[order])
    return [float(values[order[np.searchsorted(sums, share * sums[-1])]]) for share in shares]
