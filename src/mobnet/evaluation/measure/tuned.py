"""A detector of a leg with thresholds from a walk that nothing pushes, and its false alarms in that walk."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.detections import (
    CALIBRATION,
    COLLISION,
    HELD_OUT,
    LARGEST,
    FreeSwing,
    Promise,
    Threshold,
)
from mobnet.core.errors import DataError, not_accepted
from mobnet.core.estimator import Estimate
from mobnet.detection.chain import Chain
from mobnet.detection.signals import MEAN, STD, signal_names, signals_of, whitening_of
from mobnet.detection.swings import largest
from mobnet.detection.thresholds import HOUR_S, Calibrated, calibrate
from mobnet.evaluation.measure.watching import Leg, Watched
from mobnet.settings.detection import Detector


@dataclass(frozen=True)
class Tuned:
    """A calibrated detector.

    Attributes:
        name: its name.
        detector: what it watches.
        whitening: of its signals, if it watches their length.
        naming: of the estimated torques (6, 6), for telling links apart.
        scales: of what has a threshold, in each phase (phases, c) [N m], for ratios [-].
        chains: rule -> the chain with its thresholds.
        promises: rule, but that of the paper -> multiple of the scales and expected rate.
    """

    name: str
    detector: Detector
    whitening: Array | None
    naming: Array
    scales: Array
    chains: Mapping[str, Chain]
    promises: Mapping[str, Calibrated]

    def signals(self, estimate: Estimate) -> Array:
        """Return what the detector watches of an estimate, (T, m)."""
        return signals_of(self.detector, estimate, self.whitening)

    def names(self, joints: Sequence[str]) -> list[str]:
        """Return the names of what has a threshold."""
        return signal_names(self.detector, joints)

    def perfect(self, chain: Chain) -> Chain | None:
        """Return the chain of an estimate without error at the same thresholds; None where no torque is watched."""
        if MEAN not in self.detector.signals:
            return None
        joints = len(self.naming)
        return chain if chain.norm else chain._replace(thresholds=np.ascontiguousarray(chain.thresholds[:, :joints]))


def tune(
    leg: Leg, name: str, detector: Detector, walk: Sequence[Watched], estimates: Sequence[Estimate]
) -> Tuned:  # fmt: skip
    """Calibrate a detector on the first swings of a walk that nothing pushes.

    Raises:
        DataError: there are too few swings, or a signal never changes.
    """
    first = calibrating(leg, walk)
    plain = [signals_of(detector, estimate) for estimate in estimates]
    _check_signals(leg, detector, walk, plain)
    whitening = _whitening(leg, walk, plain, first) if detector.norm else None
    naming = _whitening(leg, walk, [one.tau_ext.astype(np.float64) for one in estimates], first)
    signals = plain if whitening is None else [one @ whitening.T for one in plain]
    heights = np.concatenate([_heights(leg, detector, *pair) for pair in zip(walk, signals, strict=True)])[:first]
    numbers = leg.detection.thresholds
    scales = _over_swings(heights, lambda own: float(np.quantile(own, numbers.scale_quantile)))
    chain = leg.chain(scales, norm=detector.norm)
    seen = swing_ratios(walk, chain, signals)[:first]
    promises = {
        kind: calibrate(seen, hours_of(leg, walk) * HOUR_S * first / swing_count(walk), rate, numbers)
        for kind, rate in numbers.rates_per_h.items()
    }
    thresholds = {LARGEST: numbers.margin * _over_swings(heights, np.max)}
    thresholds |= {kind: found.factor * scales for kind, found in promises.items()}
    chains = {kind: leg.chain(own, norm=detector.norm) for kind, own in thresholds.items()}
    return Tuned(name, detector, whitening, naming, scales, chains, promises)


def calibrating(leg: Leg, walk: Sequence[Watched]) -> int:
    """Return how many of the swings of a walk calibrate, the first ones."""
    return int(np.ceil(leg.detection.calibration_share * swing_count(walk)))


def swing_count(walk: Sequence[Watched]) -> int:
    """Return the number of swings of a walk."""
    return sum(len(one.swings) for one in walk)


def hours_of(leg: Leg, walk: Sequence[Watched]) -> float:
    """Return the time that was walked [h]."""
    return sum(one.samples for one in walk) / leg.rate_hz / HOUR_S


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


def promise_rows(leg: Leg, tuned: Tuned, walk: Sequence[Watched]) -> Iterator[Promise]:
    """Yield the rates of false alarms that are to be expected of a detector."""
    first = calibrating(leg, walk)
    hours = hours_of(leg, walk) * first / swing_count(walk)
    for kind, found in tuned.promises.items():
        yield Promise(tuned.name, leg.limb, kind, first, hours, found.factor, found.rate_per_h, found.low, found.high)


def quiet_rows(leg: Leg, tuned: Tuned, walk: Sequence[Watched], estimates: Sequence[Estimate]) -> Iterator[FreeSwing]:
    """Yield the swings of the walk that nothing pushes: those that calibrated the detector, and those held out."""
    signals, first = [tuned.signals(one) for one in estimates], calibrating(leg, walk)
    ratios, largest_ratios = (swing_ratios(walk, tuned.chains[kind], signals) for kind in (COLLISION, LARGEST))
    places = [(one.seed, number, terrain) for one in walk for number, terrain in enumerate(one.terrains, start=1)]
    for k, (seed, number, terrain) in enumerate(places):
        part = CALIBRATION if k < first else HELD_OUT
        numbers = float(ratios[k]), float(largest_ratios[k])
        yield FreeSwing(tuned.name, leg.limb, part, terrain, seed, number, *numbers)


def _check_signals(leg: Leg, detector: Detector, walk: Sequence[Watched], signals: Sequence[Array]) -> None:
    """Raise a DataError if a signal has the same number in all samples."""
    lowest, highest = (np.array([end(own, axis=0) for own in signals]) for end in (np.min, np.max))
    still = np.flatnonzero(lowest.min(axis=0) == highest.max(axis=0))
    if len(still):
        names = [f"{kind}.{joint}" for kind in detector.signals for joint in leg.joints]
        text = not_accepted(f"signal {names[still[0]]}: every number", float(lowest[0, still[0]]), ["numbers that change"])
        raise DataError(f"{walk[0].recording}: {text}")


def _whitening(leg: Leg, walk: Sequence[Watched], signals: Sequence[Array], swings: int) -> Array:
    """Return the whitening (m, m) of signals behind the low-pass, where the leg is watched in the first swings."""
    parts: list[Array] = []
    for one, own in zip(walk, signals, strict=True):
        count = min(len(one.swings), swings)
        end = one.swings[count - 1][1] if count else 0
        parts.append(leg.low_passed(own[:end], _cut(one.segments, end))[one.watch.watched[:end]])
        swings -= count
    return whitening_of(np.concatenate(parts))


def _cut(segments: Sequence[tuple[int, int]], end: int) -> tuple[tuple[int, int], ...]:
    """Return the segments before a row."""
    return tuple((start, min(stop, end)) for start, stop in segments if start < end)


def _heights(leg: Leg, detector: Detector, one: Watched, signals: Array) -> Array:
    """Return the largest held signal in each phase of each swing, (swings, phases, c); nan where it is not watched."""
    whole = leg.chain(np.ones((1, 1)), norm=detector.norm)
    parts = [signals] if detector.norm else np.split(signals, signals.shape[1], axis=1)
    held = np.stack([one.run(whole, np.ascontiguousarray(part)).ratio for part in parts], axis=1)
    part = np.minimum((one.watch.phase * detector.phases).astype(int), detector.phases - 1)
    shown = [np.where((one.watch.watched & (part == k))[:, None], held, np.nan) for k in range(detector.phases)]
    swings = [np.stack([_most(own[start:end]) for own in shown]) for start, end in one.swings]
    return np.array(swings).reshape(len(swings), detector.phases, len(parts))


def _most(values: Array) -> Array:
    """Return the largest numbers of columns (n, c) that are not nan, nan where all are."""
    return np.where(np.isnan(values), -np.inf, values).max(axis=0, initial=-np.inf)


def _over_swings(heights: Array, number) -> Array:
    """Return a number of the heights (swings, phases, c) over the swings that have them, (phases, c).

    A phase that no swing has takes the largest of the other phases.
    """
    found = np.full(heights.shape[1:], np.nan)
    for place in np.ndindex(found.shape):
        own = heights[(slice(None), *place)]
        own = own[np.isfinite(own)]
        if len(own):
            found[place] = number(own)
    return np.where(np.isnan(found), np.nanmax(found, axis=0), found)
