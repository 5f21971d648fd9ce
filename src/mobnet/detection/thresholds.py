"""Thresholds from a walk that nothing pushes: for a wanted rate of false alarms, and what rate to expect.

In each swing a detector's signals have a largest value, over their scale. A rate of one false alarm in an hour is one
in some thousands of swings, more than a lab records, so that a generalised Pareto law is fitted to the tail of these
values (docs/notes/detection.md, section 7). A law that is fitted to few values gives a threshold that is too low about
as often as one that is too high, but the former costs far more alarms. So the fitted law is asked for fewer alarms than
are wanted: for so few that thresholds of walks like this one have the wanted rate on the average.
"""

from collections.abc import Sequence
from dataclasses import astuple, dataclass

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError, not_accepted
from mobnet.kernel.detecting import TailNumbers

HOUR_S = 3600.0
SHAPES = (-0.5, 0.5)  # of the law, between which its moments can be trusted
STRAIGHT = 1e-6  # the shape that stands for that of the exponential law, zero
DIFFER = 0.5  # of the swings in the tail, which have to have largest values of their own
SEED = 0  # of the resampled walks
RARER = 1e-4  # least share of swings that the law is asked for, over the wanted one
HALVINGS = 40  # of the range of these shares on a log scale, down to a part in 1e11


@dataclass(frozen=True)
class Tail:
    """The largest values of swings above a level: the share of swings there, and scale and shape of their law."""

    level: float
    share: float
    scale: float
    shape: float

    def above(self, size: float) -> float:
        """Return the share of swings whose largest value lies above a size, not below the level [-]."""
        return float(_above(np.array(size), np.array(astuple(self))))

    def size(self, share: float) -> float:
        """Return the size above which the largest values of a share of swings [-] lie."""
        return float(_size(share, np.array(astuple(self))))


def _above(size: Array, tails: Array) -> Array:
    """Return the shares of swings above sizes [-], by laws (..., 4): their levels, shares, scales and shapes."""
    level, share, scale, shape = np.moveaxis(tails, -1, 0)
    # (D16), whose limit for a shape of zero, the exponential law, the formula itself cannot give.
    curved = np.where(np.abs(shape) < STRAIGHT, STRAIGHT, shape)
    over = np.maximum(size - level, 0.0) / scale
    return share * np.maximum(1.0 + curved * over, 0.0) ** (-1.0 / curved)


def _size(share: float, tails: Array) -> Array:
    """Return the sizes above which the largest values of a share of swings [-] lie, by laws (..., 4) as above."""
    level, seen, scale, shape = np.moveaxis(tails, -1, 0)
    # (D17), the inverse of (D16). Of a law without a swing above its level it is that level.
    curved = np.where(np.abs(shape) < STRAIGHT, STRAIGHT, shape)
    rarer = np.minimum(share / np.where(seen > 0.0, seen, share), 1.0)
    return level + scale * (rarer**-curved - 1.0) / curved


@dataclass(frozen=True)
class Calibrated:
    """A multiple of the scales for a wanted rate, and the rate that such multiples have, with its interval [1/h].

    Of thresholds that have the rate on the average, `rate_per_h` is the mean over walks like the one that calibrated.
    """

    factor: float
    rate_per_h: float
    low: float
    high: float


def fit_tail(largest: Array, share: float) -> Tail:
    """Return the tail of the largest values of swings (k,): that of a share of them, empty where none lies above."""
    # The law holds for what exceeds a high level, whatever the law below; a share fixes how many swings that leaves.
    level = float(np.quantile(largest, 1.0 - share))
    over = np.sort(largest[largest > level] - level)
    if not len(over):  # a walk drawn anew, whose largest value many swings share
        return Tail(level, 0.0, 1.0, 0.0)
    return Tail(level, len(over) / len(largest), *_moments(over))


def _moments(over: Array) -> tuple[float, float]:
    """Return scale and shape of what exceeds a level (n,), in rising order, by probability-weighted moments."""
    # (D18). Moments and not likelihood: with some tens of swings they err less, and they always give a number.
    rank = (np.arange(1, len(over) + 1) - 0.35) / len(over)
    mean = float(over.mean())
    weighted = float((over * (1.0 - rank)).mean())
    # Ranks weigh large values less: the difference is no less than 0.3 / n of the mean, and the mean is above 0.
    shape = float(np.clip(2.0 - mean / (mean - 2.0 * weighted), *SHAPES))
    return mean * (1.0 - shape), shape


def calibrate(
    largest: Array, episodes: Sequence[int], duration_s: float, rate_per_h: float, numbers: TailNumbers
) -> Calibrated:
    """Return the multiple of the scales for a wanted rate of false alarms.

    Args:
        largest: largest value of each swing over its scale (k,).
        episodes: the episode of each swing (k,); swings of one episode are drawn together.
        duration_s: time that was walked [s].
        rate_per_h: wanted rate [1/h].
        numbers: least number of swings, share of the tail, resamples and confidence.

    Raises:
        DataError: there are too few swings, they do not differ, or the rate is more than the tail holds.
    """
    if len(largest) < numbers.least_swings:
        needed = f"{numbers.least_swings} or more are needed, some minutes of walking"
        raise DataError(f"{len(largest)} swings that calibrate; {needed}")
    if not np.ptp(largest):
        value = float(largest[0])
        raise DataError(f"the largest value of each swing is {value}; numbers that change are needed")
    # (D15): a robot reacts to the first alarm of a swing, so that a swing counts once, however often it crosses.
    per_h = len(largest) * HOUR_S / duration_s
    share = rate_per_h / per_h
    # Below the level there is no law: such a threshold would be a quantile of the swings, and most steps an alarm.
    if share >= numbers.tail_share:
        most = numbers.tail_share * per_h
        raise DataError(not_accepted("rate", f"{rate_per_h:g} per hour", [f"below {most:.0f}, the tail of the swings"]))
    tail = fit_tail(largest, numbers.tail_share)
    _check_tail(largest[largest > tail.level], tail.level)
    # (D19), with the same random numbers for every detector and rate: intervals differ by the swings, not by chance.
    rng = np.random.default_rng(SEED)
    episode = np.asarray(episodes)
    groups = [largest[episode == number] for number in np.unique(episode)]
    others = np.array([astuple(_drawn_anew(groups, tail, numbers, rng)) for _ in range(numbers.resamples)])
    if numbers.on_average:
        asked = _asked_share(share, tail, others)
        rates = _exceeded(asked, tail, others) * per_h
        expected = float(rates.mean())
    else:
        asked = share
        rates = _above(np.array(tail.size(asked)), others) * per_h
        expected = tail.above(tail.size(asked)) * per_h
    low, high = np.quantile(rates, [(1.0 - numbers.confidence) / 2.0, (1.0 + numbers.confidence) / 2.0])
    return Calibrated(tail.size(asked), expected, float(low), float(high))


def _asked_share(share: float, tail: Tail, others: Array) -> float:
    """Return the share of swings [-] for which a fitted law is asked, so that a wanted one is exceeded on the average.

    It is that of the walk with the law `tail` for which thresholds of the laws `others`, of walks drawn anew from it,
    have the wanted share; not below `RARER` of that, where few swings in the tail give no such number.
    """
    low = share * RARER
    high = share
    for _ in range(HALVINGS):
        middle = float(np.sqrt(low * high))
        if _exceeded(middle, tail, others).mean() > share:
            high = middle
        else:
            low = middle
    return low


def _exceeded(share: float, tail: Tail, others: Array) -> Array:
    """Return the shares of the swings of a law above the thresholds that laws (n, 4) have for a share (n,) [-]."""
    return _above(_size(share, others), np.array(astuple(tail)))


def _check_tail(above: Array, level: float) -> None:
    """Check that the largest values above a level (k,) are some, and differ: an estimate that saturates has one value.

    Raises:
        DataError: a law cannot be fitted to them.
    """
    differ = len(np.unique(above))
    wanted = max(DIFFER * len(above), 1.0)
    if differ < wanted:
        what = f"{differ} different largest values above {level:.3g} times their scales"
        needed = f"{wanted:.0f} or more are needed, those of an estimate that does not saturate"
        raise DataError(f"{what}; {needed}")


def _drawn_anew(groups: Sequence[Array], tail: Tail, numbers: TailNumbers, rng: np.random.Generator) -> Tail:
    """Return the law that is fitted to a walk like that of the groups of swings, drawn anew."""
    # Whole episodes: their ground and commands make swings alike, and single swings would look like more than they are.
    drawn = np.concatenate([groups[k] for k in rng.integers(0, len(groups), len(groups))])
    above = np.flatnonzero(drawn > tail.level)
    # The rarest swing decides the fit, and would often be drawn twice or not at all: the law draws another one.
    uniform = rng.uniform(size=len(above))
    shape = tail.shape if abs(tail.shape) > STRAIGHT else STRAIGHT
    drawn[above] = tail.level + tail.scale * (uniform**-shape - 1.0) / shape
    return fit_tail(drawn, numbers.tail_share)


def expected_counts(calibrated: Calibrated, hours: float, confidence: float) -> tuple[int, int]:
    """Return between which numbers of false alarms a walk of some hours should have, by the interval of the rate.

    The ends are those of Poisson's law at the ends of the rate's interval: both may be wrong at once.
    """
    # (D20): both ends of the rate and chance may be against us at once, which makes the span wider than stated.
    from scipy.stats import poisson  # here, as it takes a second to import

    low = poisson.ppf((1.0 - confidence) / 2.0, calibrated.low * hours)
    high = poisson.ppf((1.0 + confidence) / 2.0, calibrated.high * hours)
    return int(low), int(high)
