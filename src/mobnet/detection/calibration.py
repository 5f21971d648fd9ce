"""A detector of a leg with thresholds from walking that nothing pushes; docs/notes/detection.md has its laws."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.detections import CALIBRATION, COLLISION, HELD_OUT, LARGEST, WALKING, FreeSwing, Promise, Threshold
from mobnet.core.errors import DataError
from mobnet.core.estimator import Estimate
from mobnet.detection.chain import Chain
from mobnet.detection.gate import Spans, episodes_of, largest
from mobnet.detection.signals import MEAN, STD, Watched, slopes_of, whitening_of
from mobnet.detection.thresholds import HOUR_S, Calibrated, calibrate
from mobnet.detection.watch import LegRecording, LegSetup, LimbSetup
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import TailNumbers, WatchedSignals

NEVER = "the leg is watched in none of the swings that calibrate; some are needed in which it is"


class NotWatchedError(DataError):
    """No swing that should calibrate a detector is watched: the gate takes all of them for early contacts."""


@dataclass(frozen=True)
class QuietWalk:
    """A leg in walking that nothing pushes, and a method's estimate of it in each recording.

    `first` is the number of swings that calibrate, the first ones, `hours` how long they took [h].
    """

    scenario: str
    legs: tuple[LegRecording, ...]
    estimates: tuple[Estimate, ...]
    first: int
    hours: float

    @classmethod
    def of(
        cls, setup: LimbSetup, scenario: str, legs: Sequence[LegRecording], estimates: Sequence[Estimate], share: float
    ) -> "QuietWalk":
        """Return a walk of which a share of the swings, the first ones, calibrates."""
        count = sum(len(leg.swings) for leg in legs)
        first = int(np.ceil(share * count))
        walked = sum(leg.samples for leg in legs) / setup.rate_hz / HOUR_S
        return cls(scenario, tuple(legs), tuple(estimates), first, walked * first / max(count, 1))

    def swings_in(self, seconds: float) -> int:
        """Return how many swings a time has [s], one or more."""
        swing_s = self.hours * HOUR_S / max(self.first, 1)
        return max(round(seconds / swing_s), 1)

    def signals(self, watched: Watched) -> list[Array]:
        """Return what is watched of each recording, (T, m)."""
        return [watched.of(estimate, leg.command) for leg, estimate in zip(self.legs, self.estimates, strict=True)]


@dataclass(frozen=True)
class CalibratedDetector:
    """A detector with its thresholds.

    Attributes:
        name: its name.
        watched: what it watches.
        naming: of the estimated torques (6, 6), for telling links apart.
        chains: rule -> the chain with its thresholds.
        promises: rule, but that of the paper -> multiple of the scales and expected rate.
    """

    name: str
    watched: Watched
    naming: Array
    chains: Mapping[str, Chain]
    promises: Mapping[str, Calibrated]

    def perfect(self, chain: Chain, torque: Array, command: NDArray[Any]) -> tuple[Chain, Array] | None:
        """Return chain and signals (T, 6) of an estimate without error, the true torque (T, 6) [N m] itself.

        The thresholds are those of the estimate, so that it is told what the method's error costs and what the filters
        do. There is none where no torque is watched.
        """
        if MEAN not in self.watched.detector.signals:
            return None
        signals = self.watched.relative(torque, command)
        if self.watched.whitening is not None:
            return chain, signals
        # Signals are one kind after the other, the mean first, and the truth has no standard deviation.
        return chain._replace(thresholds=np.ascontiguousarray(chain.thresholds[:, : torque.shape[1]])), signals


def calibrate_detector(
    setup: LegSetup, name: str, detector: WatchedSignals, place: QuietWalk, random: QuietWalk
) -> CalibratedDetector:
    """Calibrate a detector on the first swings of quiet walks, by the paper's rule [5.3] and for rates.

    The paper's rule is read in two ways, with walking in place as its "normal walking" and with random walking.

    Raises:
        DataError: there are too few swings, or a signal never changes.
        NotWatchedError: none of these swings is watched.
    """
    for walk in (place, random):
        check_signals(setup, detector, walk)
    watched = Watched(detector)
    if detector.commanded:
        watched = replace(watched, slopes=_slopes(setup, watched, random))
    if detector.norm:
        watched = replace(watched, whitening=_whitening(setup, random, random.signals(watched)))
    numbers = setup.detection.thresholds
    heights = swing_heights(setup, watched, random)
    scales, promises = rate_scales(setup, watched, random, heights)
    # (D13), the paper's rule.
    in_place = _over_swings(swing_heights(setup, watched, place), np.max)
    walking = usual_largest(heights, random.swings_in(numbers.normal_walk_s))
    thresholds = {LARGEST: numbers.margin * in_place, WALKING: numbers.margin * walking}
    thresholds |= {kind: promise.factor * scales for kind, promise in promises.items()}
    chains = {kind: setup.chain(values, norm=detector.norm) for kind, values in thresholds.items()}
    torques = [estimate.tau_ext.astype(np.float64) for estimate in random.estimates]
    return CalibratedDetector(name, watched, _whitening(setup, random, torques), chains, promises)


def usual_largest(heights: Array, count: int) -> Array:
    """Return the largest heights (phases, c) in so many swings one after the other: the median over all such parts.

    Heights are (swings, phases, c). Of a longer walk the largest height is larger, so that all parts are as long; a
    last one that is shorter is left out where there are others.

    Raises:
        NotWatchedError: no swing is watched.
    """
    last = max(len(heights) - count, 0)
    parts = [_over_swings(heights[first : first + count], np.max) for first in range(0, last + 1, count)]
    return np.median(parts, axis=0)


def rate_scales(
    setup: LimbSetup, watched: Watched, walk: QuietWalk, heights: Array
) -> tuple[Array, dict[str, Calibrated]]:
    """Return the scales of a detector's signals (phases, c), and by rule the multiple of them for its rate.

    Heights are those of `swing_heights`.

    Raises:
        DataError: there are too few swings, or a rate is more than the tail of the swings holds.
        NotWatchedError: none of the swings is watched.
    """
    numbers = setup.detection.thresholds
    # (D14): with one scale for each signal, one number is left to choose, and all signals raise alarms alike. The
    # largest value itself would be a scale that one odd swing decides.
    scales = _over_swings(heights, lambda number: float(np.quantile(number, numbers.scale_quantile)))
    chain = setup.chain(scales, norm=watched.detector.norm)
    seen = swing_ratios(walk.legs, chain, walk.signals(watched))[: walk.first]
    episodes = episodes_of((leg.episodes or leg.segments, leg.swings) for leg in walk.legs)[: walk.first]
    rates = numbers.rates_per_h.items()
    return scales, {
        kind: calibrate(seen, episodes, walk.hours * HOUR_S, rate, as_plain(numbers, TailNumbers))
        for kind, rate in rates
    }


def swing_ratios(legs: Sequence[LegRecording], chain: Chain, signals: Sequence[Array]) -> Array:
    """Return the largest number of a chain in each swing of a walk (k,)."""
    pairs = zip(legs, signals, strict=True)
    return np.concatenate([largest(leg.run(chain, signal).ratio, leg.swings) for leg, signal in pairs])


def threshold_rows(setup: LegSetup, calibrated: CalibratedDetector) -> Iterator[Threshold]:
    """Yield the thresholds of a detector, signal by signal and phase by phase."""
    names = calibrated.watched.names(setup.joints)
    for kind, chain in calibrated.chains.items():
        for phase, row in enumerate(chain.thresholds, start=1):
            for signal, value in zip(names, row.tolist(), strict=True):
                yield Threshold(calibrated.name, setup.limb, kind, signal, phase, value, unit_of(signal))


def unit_of(signal: str) -> str:
    """Return the unit of what has a threshold, by a name of `Watched.names`."""
    return "N m" if signal.startswith((f"{MEAN}.", f"{STD}.")) else "-"


def promise_rows(setup: LegSetup, calibrated: CalibratedDetector, random: QuietWalk) -> Iterator[Promise]:
    """Yield the rates of false alarms that are to be expected of a detector."""
    for kind, promise in calibrated.promises.items():
        numbers = promise.factor, promise.rate_per_h, promise.low, promise.high
        yield Promise(calibrated.name, setup.limb, kind, random.first, random.hours, *numbers)


def quiet_rows(setup: LegSetup, calibrated: CalibratedDetector, walk: QuietWalk) -> Iterator[FreeSwing]:
    """Yield the swings of a walk that nothing pushes: those that calibrated the detector, and those held out."""
    signals = walk.signals(calibrated.watched)
    ratios = [swing_ratios(walk.legs, calibrated.chains[kind], signals) for kind in (COLLISION, LARGEST, WALKING)]
    places = list[tuple[int, int, str]]()
    for leg in walk.legs:
        places += [(leg.seed, number, terrain) for number, terrain in enumerate(leg.terrains, start=1)]
    for k, (seed, number, terrain) in enumerate(places):
        # Thresholds fit the swings that made them, so that a count of false alarms is honest on the others alone.
        part = CALIBRATION if k < walk.first else HELD_OUT
        numbers = [float(values[k]) for values in ratios]
        yield FreeSwing(calibrated.name, setup.limb, walk.scenario, part, terrain, seed, number, *numbers)


def check_signals(setup: LimbSetup, detector: WatchedSignals, walk: QuietWalk) -> None:
    """Raise a DataError if a signal has the same number in all samples of a recording."""
    names = [f"{kind}.{joint}" for kind in detector.signals for joint in setup.joints]
    for leg, signals in zip(walk.legs, walk.signals(Watched(detector)), strict=True):
        for name, column in zip(names, signals.T, strict=True):
            if column.min() == column.max():
                value = float(column[0])
                raise DataError(f"{leg.recording}: signal {name} is always {value}; numbers that change are needed")


def _slopes(setup: LegSetup, watched: Watched, walk: QuietWalk) -> Array:
    """Return by which share signals grow with each part of the command in calibrating swings, (m, 3)."""
    heights = swing_heights(setup, watched, walk).max(axis=1)
    commands = list[Array]()
    for leg in walk.legs:
        starts = [start for start, _ in leg.swings]
        commands.append(leg.command[starts])
    seen = (heights > 0.0).all(axis=1)
    if not seen.any():
        raise NotWatchedError(NEVER)
    known = np.concatenate(commands)[: walk.first]
    return slopes_of(heights[seen], known[seen], setup.detection.thresholds.command_quantile)


def _whitening(setup: LegSetup, walk: QuietWalk, signals: Sequence[Array]) -> Array:
    """Return the whitening (m, m) of signals behind the low-pass, where the leg is watched in calibrating swings."""
    parts = list[Array]()
    left = walk.first
    for leg, of_leg in zip(walk.legs, signals, strict=True):
        count = min(len(leg.swings), left)
        end = leg.swings[count - 1][1] if count else 0
        parts.append(setup.low_passed(of_leg[:end], _cut(leg.segments, end))[leg.gate.watched[:end]])
        left -= count
    watched = np.concatenate(parts)
    if not len(watched):
        raise NotWatchedError(NEVER)
    return whitening_of(watched)


def _cut(segments: Spans, end: int) -> Spans:
    """Return the segments before a row."""
    return tuple((start, min(stop, end)) for start, stop in segments if start < end)


def swing_heights(setup: LimbSetup, watched: Watched, walk: QuietWalk) -> Array:
    """Return the largest held signal in each phase of each calibrating swing, (swings, phases, c).

    It is minus infinity where a swing is not watched.
    """
    # A threshold of 1 leaves signals as they are, and a chain of one signal does not mix them.
    norm = watched.whitening is not None
    phases = watched.detector.phases
    whole = setup.chain(np.ones((1, 1)), norm=norm)
    heights: list[Array] = []
    for leg, signals in zip(walk.legs, walk.signals(watched), strict=True):
        parts = [signals] if norm else np.split(signals, signals.shape[1], axis=1)
        ratios = np.stack([leg.run(whole, np.ascontiguousarray(part)).ratio for part in parts], axis=1)
        phase = np.minimum((leg.gate.phase * phases).astype(int), phases - 1)
        shown = [leg.gate.watched & (phase == k) for k in range(phases)]
        for start, end in leg.swings:
            largest = [ratios[start:end][part_shown[start:end]].max(axis=0, initial=-np.inf) for part_shown in shown]
            heights.append(np.stack(largest))
    if not heights:
        raise NotWatchedError(NEVER)
    return np.array(heights[: walk.first])


def _over_swings(heights: Array, number: Callable[[Array], float]) -> Array:
    """Return a number of the heights (swings, phases, c) over the swings that have them, (phases, c).

    Raises:
        NotWatchedError: no swing is watched.
    """
    numbers = np.full(heights.shape[1:], np.nan)
    for place in np.ndindex(numbers.shape):
        positive = heights[(slice(None), *place)]
        positive = positive[positive > 0.0]
        if len(positive):
            numbers[place] = number(positive)
    if np.isnan(numbers).all(axis=0).any():
        raise NotWatchedError(NEVER)
    # The ends of a swing are watched for too short a time to hold a signal. Alarms there must stay as rare as
    # elsewhere, hence the largest number of the other phases.
    return np.where(np.isnan(numbers), np.nanmax(numbers, axis=0), numbers)
