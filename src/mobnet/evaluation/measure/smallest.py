"""The smallest force that a detector finds: the law of the found share over the force, and its interval.

The found share is a logistic function of the logarithm of the force. The likeliest of many such laws counts, weighed by
a broad law of the steepness, without which collisions that are all found above a force and none below it would leave
the steepness open. The interval is that of collisions drawn anew.
"""

import numpy as np

from mobnet.core.arrays import Array
from mobnet.evaluation.number.number import Number
from mobnet.settings.evaluation import SmallestForce, Statistics

HALVES, STEPS = 120, 24  # laws along the force for one half, and along the steepness
BREADTH = 1.0  # standard deviation of the logarithm of the steepness, about the middle of its range
SEED = 0


def smallest_force(force: Array, found: Array, settings: SmallestForce, statistics: Statistics) -> Number:
    """Return the force of which a share of collisions is found [N], with its interval.

    Forces (n,) [N] are the largest ones of the collisions, found (n,) is 1 or 0. Where the force lies below or above
    all that were tried there is no number, but that end as `low` or as `high`; else the interval is cut there.
    """
    halves, steepness = np.geomspace(*settings.halves_n, HALVES), np.geomspace(*settings.steepness, STEPS)
    half, steep = (grid.ravel() for grid in np.meshgrid(halves, steepness, indexing="ij"))
    slope = steep * (np.log(force)[:, None] - np.log(half))
    likely = -np.logaddexp(0.0, np.where(found[:, None] > 0, -slope, slope))  # (n, laws)
    middle = np.sqrt(settings.steepness[0] * settings.steepness[1])
    prior = -0.5 * (np.log(steep / middle) / BREADTH) ** 2
    wanted = half * (settings.share / (1.0 - settings.share)) ** (1.0 / steep)
    value = float(wanted[np.argmax(likely.sum(axis=0) + prior)])
    rng, count = np.random.default_rng(SEED), len(force)
    weights = rng.multinomial(count, np.full(count, 1.0 / count), settings.resamples).astype(np.float64)
    drawn = wanted[np.argmax(weights @ likely + prior, axis=1)]
    tail = (1.0 - statistics.confidence) / 2.0
    low, high = np.quantile(drawn, [tail, 1.0 - tail])
    least, most = float(force.min()), float(force.max())
    if not least <= value <= most:
        return Number(None, *((least, None) if value < least else (None, most)), unit="N")
    return Number(value, max(float(low), least), min(float(high), most), unit="N")
