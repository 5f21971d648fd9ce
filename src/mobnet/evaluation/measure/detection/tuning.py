"""A detector of a leg with thresholds from a walk that nothing pushes, and its false alarms in that walk."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.detections import CALIBRATION, COLLISION, HELD_OUT, LARGEST, FreeSwing, Promise, Threshold
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.estimator import Estimate
from mobnet.detection.chain import Chain
from mobnet.detection.signals import MEAN, STD, signal_names, signals_of, whitening_of
from mobnet.detection.swings import episodes_of, largest
from mobnet.detection.thresholds import HOUR_S, Calibrated, calibrate
from mobnet.evaluation.measure.detection.watching import Leg, Watched
from mobnet.settings.detection import Detector

NEVER = not_accepted("swings in which the leg is watched", "none", ["some of those that calibrate"])


class NotWatchedError(DataError):
    """No swing that should calibrate a detector is watched: the gate takes all of them for early contacts."""


@dataclass(frozen=True)
class Quiet:
    """A leg in a walk that nothing pushes, and a method's estimate of it.

    `first` is the number of swings that calibrate, the first ones, `hours` how long they took [h].
    """

    scenario: str
    walk: tuple[Watched, ...]
    estimates: tuple[Estimate, ...]
    first: int
    hours: float


@dataclass(frozen=True)
class Tuned:
    """A calibrated detector.

    Attributes:
        name: its name.
        detector: what it watches.
        whitening: of its signals, if it watches their length.
        naming: of the estimated torques (6, 6), for telling links apart.
        chains: rule -> the chain with its thresholds.
        promises: rule, but that of the paper -> multiple of the scales and expected rate.
    """

    name: str
    detector: Detector
    whitening: Array | None
    naming: Array
    chains: Mapping[str, Chain]
    promises: Mapping[str, Calibrated]

    def signals(self, estimate: Estimate) -> Array:
        """Return what the detector watches of an estimate, (T, m)."""
        return signals_of(self.detector, estimate, self.whitening)

    def names(self, joints: Sequence[str]) -> list[str]:
        """Return the names of what has a threshold."""
        return signal_names(self.detector, joints)

    def whitened(self, torque: Array) -> Array:
        """Return what a detector of the mean watches of a torque (T, 6) [N m] that is no estimate."""
        return torque if self.whitening is None else torque @ self.whitening.T

    def perfect(self, chain: Chain) -> Chain | None:
        """Return the chain of an estimate without error at the same thresholds; None where no torque is watched."""
        if MEAN not in self.detector.signals:
            return None
        joints = len(self.naming)
        return chain if chain.norm else chain._replace(thresholds=np.ascontiguousarray(chain.thresholds[:, :joints]))


def tune(leg: Leg, name: str, detector: Detector, place: Quiet, random: Quiet) -> Tuned:
    """Calibrate a detector on the first swings of walks that nothing pushes: in place by the paper's rule, else rates.

    Raises:
        DataError: there are too few swings, or a signal never changes.
        NotWatchedError: none of these swings is watched.
    """
    for walk in (place, random):
        _check_signals(leg, detector, walk)
    plain = [signals_of(detector, estimate) for estimate in random.estimates]
    whitening = _whitening(leg, random, plain) if detector.norm else None
    torques = [estimate.tau_ext.astype(np.float64) for estimate in random.estimates]
    numbers = leg.detection.thresholds
    heights = _heights(leg, detector, whitening, random)
    scales = _over_swings(heights, lambda own: float(np.quantile(own, numbers.scale_quantile)))
    watched = [signals_of(detector, estimate, whitening) for estimate in random.estimates]
    seen = swing_ratios(random.walk, leg.chain(scales, norm=detector.norm), watched)[: random.first]
    episodes = episodes_of((one.segments, one.swings) for one in random.walk)
    promises = {
        kind: calibrate(seen, episodes[: random.first], random.hours * HOUR_S, rate, numbers)
        for kind, rate in numbers.rates_per_h.items()
    }
    thresholds = {LARGEST: numbers.margin * _over_swings(_heights(leg, detector, whitening, place), np.max)}
    thresholds |= {kind: found.factor * scales for kind, found in promises.items()}
    chains = {kind: leg.chain(own, norm=detector.norm) for kind, own in thresholds.items()}
    return Tuned(name, detector, whitening, _whitening(leg, random, torques), chains, promises)


def quiet_of(leg: Leg, scenario: str, walk: Sequence[Watched], estimates: Sequence[Estimate]) -> Quiet:
    """Return a walk that nothing pushes, of which a share of the swings, the first ones, calibrates."""
    count = swing_count(walk)
    first = int(np.ceil(leg.detection.calibration_share * count))
    walked = sum(one.samples for one in walk) / leg.rate_hz / HOUR_S
    return Quiet(scenario, tuple(walk), tuple(estimates), first, walked * first / max(count, 1))


def swing_count(walk: Sequence[Watched]) -> int:
    """Return the number of swings of a walk."""
    return sum(len(one.swings) for one in walk)


def swing_ratios(walk: Sequence[Watched], chain: Chain, signals: Sequence[Array]) -> Array:
    """Return the largest number of a chain in each swing of a walk (k,)."""
    pairs = zip(walk, signals, strict=True)
    return np.concatenate([largest(one.run(chain, own).ratio, one.swings) for one, own in pairs])


def threshold_rows(leg: Leg, tuned: Tuned) -> Iterator[Threshold]:
    """Yield the thresholds of a detector, signal by signal and phase by phase."""
    names = tuned.names(leg.joints)
    for kind, chain in tuned.chains.items():
        for phase, row in enumerate(chain.thresholds, start=1):
            for signal, value in zip(names, row.tolist(), strict=True):
                unit = "N m" if signal.startswith((f"{MEAN}.", f"{STD}.")) else "-"
                yield Threshold(tuned.name, leg.limb, kind, signal, phase, value, unit)


def promise_rows(leg: Leg, tuned: Tuned, random: Quiet) -> Iterator[Promise]:
    """Yield the rates of false alarms that are to be expected of a detector."""
    for kind, found in tuned.promises.items():
        numbers = found.factor, found.rate_per_h, found.low, found.high
        yield Promise(tuned.name, leg.limb, kind, random.first, random.hours, *numbers)


def quiet_rows(leg: Leg, tuned: Tuned, quiet: Quiet) -> Iterator[FreeSwing]:
    """Yield the swings of a walk that nothing pushes: those that calibrated the detector, and those held out."""
    signals = [tuned.signals(one) for one in quiet.estimates]
    ratios, others = (swing_ratios(quiet.walk, tuned.chains[kind], signals) for kind in (COLLISION, LARGEST))
    places = [(one.seed, number, terrain) for one in quiet.walk for number, terrain in enumerate(one.terrains, start=1)]
    for k, (seed, number, terrain) in enumerate(places):
        part = CALIBRATION if k < quiet.first else HELD_OUT
        numbers = float(ratios[k]), float(others[k])
        yield FreeSwing(tuned.name, leg.limb, quiet.scenario, part, terrain, seed, number, *numbers)


def _check_signals(leg: Leg, detector: Detector, quiet: Quiet) -> None:
    """Raise a DataError if a signal has the same number in all samples of a walk."""
    signals = [signals_of(detector, estimate) for estimate in quiet.estimates]
    lowest, highest = (np.array([end(own, axis=0) for own in signals]) for end in (np.min, np.max))
    still = np.flatnonzero(lowest.min(axis=0) == highest.max(axis=0))
    if len(still):
        name = [f"{kind}.{joint}" for kind in detector.signals for joint in leg.joints][still[0]]
        accepted = ["numbers that change"]
        where = f"{quiet.walk[0].recording}: signal {name}: every number"
        raise DataError(not_accepted(where, float(lowest[0, still[0]]), accepted))


def _whitening(leg: Leg, quiet: Quiet, signals: Sequence[Array]) -> Array:
    """Return the whitening (m, m) of signals behind the low-pass, where the leg is watched in calibrating swings."""
    parts, left = list[Array](), quiet.first
    for one, own in zip(quiet.walk, signals, strict=True):
        count = min(len(one.swings), left)
        end = one.swings[count - 1][1] if count else 0
        parts.append(leg.low_passed(own[:end], _cut(one.segments, end))[one.watch.watched[:end]])
        left -= count
    watched = np.concatenate(parts)
    if not len(watched):
        raise NotWatchedError(NEVER)
    return whitening_of(watched)


def _cut(segments: Sequence[tuple[int, int]], end: int) -> tuple[tuple[int, int], ...]:
    """Return the segments before a row."""
    return tuple((start, min(stop, end)) for start, stop in segments if start < end)


def _heights(leg: Leg, detector: Detector, whitening: Array | None, quiet: Quiet) -> Array:
    """Return the largest held signal in each phase of each calibrating swing, (swings, phases, c).

    It is minus infinity where a swing is not watched.
    """
    whole = leg.chain(np.ones((1, 1)), norm=detector.norm)
    found: list[Array] = []
    for one, estimate in zip(quiet.walk, quiet.estimates, strict=True):
        signals = signals_of(detector, estimate, whitening)
        parts = [signals] if detector.norm else np.split(signals, signals.shape[1], axis=1)
        held = np.stack([one.run(whole, np.ascontiguousarray(part)).ratio for part in parts], axis=1)
        phase = np.minimum((one.watch.phase * detector.phases).astype(int), detector.phases - 1)
        shown = [one.watch.watched & (phase == k) for k in range(detector.phases)]
        found += [
            np.stack([held[start:end][own[start:end]].max(axis=0, initial=-np.inf) for own in shown])
            for start, end in one.swings
        ]
    return np.array(found[: quiet.first])


def _over_swings(heights: Array, number: Callable[[Array], float]) -> Array:
    """Return a number of the heights (swings, phases, c) over the swings that have them, (phases, c).

    A phase in which no swing is watched for long enough takes the largest number of the others.

    Raises:
        NotWatchedError: no swing is watched.
    """
    found = np.full(heights.shape[1:], np.nan)
    for place in np.ndindex(found.shape):
        own = heights[(slice(None), *place)]
        own = own[own > 0.0]
        if len(own):
            found[place] = number(own)
    if np.isnan(found).all(axis=0).any():
        raise NotWatchedError(NEVER)
    return np.where(np.isnan(found), np.nanmax(found, axis=0), found)
