"""Trials of reactions, read and summarised: falls, forces, delays, directions, and reactions to nothing."""

import statistics as statistics_of
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from experiments.evaluation.measure.detection.results import MS
from experiments.evaluation.measure.estimates.changed import HOUR_S
from experiments.evaluation.number.clusters import ClusterKey, mean_in, rate_in, share_in
from experiments.evaluation.number.number import Number
from experiments.plan.reactions import Reactions
from experiments.settings.published import PublishedContacts
from experiments.settings.reaction_tables import Safety
from experiments.settings.runs import Statistics
from mobnet.core.reactions import NONE, Trial
from mobnet.core.rows import read_rows, refuse_rows
from mobnet.settings.reaction import Watch

FALLS = "falls"
PEAK = "first_peak"
FIRST = "first_impulse"
IMPULSE = "impulse"
MEDIAN = "median_impulse"
HEAVY = "heavy"
NOTICED = "noticed"
ALARM = "alarm"
WITHIN = "within"
BASE_WITHIN = "base_within"
EARLY = "early"
SWING = "{}, in swing"  # a case, of which those walks are meant whose contact began in mid-swing
# case, detector, rule, time that a reaction waits [s], wrench of the feet, share of feed-forward
Group = tuple[str, str, str, float, str, float]
MILLI = 1e3  # mm in a metre, mrad in a radian
FALLEN = "falls"
REACTED = "false reactions"
VELOCITY = "error of the base's velocity"
TRACKING = "error of the swing leg"
POWER = "power"


@dataclass(frozen=True)
class ReactionResult:
    """The trials of a detector in a case, those of all robots.

    Attributes:
        walks: number of walks.
        touched: number of those that met the obstacle before any reaction: the others say nothing about a collision.
        numbers: measure -> its number.
    """

    walks: int
    touched: int
    numbers: Mapping[str, Number]


@dataclass(frozen=True)
class FreeWalks:
    """What happened in free walks.

    Attributes:
        hours: that the robots walked as they were told [h].
        events: falls, and reactions to nothing, by name.
        rates: how many of them there are in an hour [1/h], by name.
        means: of the walks: error of the base's velocity [mm/s], error of the joints of the leg that swings from their
            references [mrad], mechanical power of the motors [W], by name.
    """

    hours: float
    events: Mapping[str, int]
    rates: Mapping[str, Number]
    means: Mapping[str, Number]


def read_trials(reactions: Reactions, cases: Sequence[str]) -> list[Trial]:
    """Return the trials of all robots in some cases."""
    found: list[Trial] = []
    for case in cases:
        for files in reactions.values():
            found += read_file(files[case])
    return found


def read_file(path: Path) -> list[Trial]:
    """Return the trials in a file.

    Raises:
        DataError: the file is missing or damaged, or a time or a force is negative.
    """
    rows = read_rows(path, Trial)
    refuse_rows(path, _faults(rows))
    return rows


def _faults(rows: Sequence[Trial]) -> Iterator[tuple[int, str, object, str]]:
    """Yield numbers below zero, and reactions that come before their alarm."""
    for k, row in enumerate(rows):
        for name, value in vars(row).items():
            if isinstance(value, int | float) and value < 0:
                yield k, name, value, "0 or more"
        if row.reacted_s is not None and (row.alarm_s is None or row.alarm_s > row.reacted_s):
            yield k, "alarm_s", row.alarm_s, f"at most reacted_s, {row.reacted_s}"


def groups_of(trials: Sequence[Trial]) -> dict[Group, list[Trial]]:
    """Return the trials by what they are made with, in the order in which they come."""
    found = dict[Group, list[Trial]]()
    for row in trials:
        key = row.case, row.detector, row.rule, row.wait_s, row.wrench, row.feed_forward
        found.setdefault(key, []).append(row)
    return found


def trials_of(trials: Sequence[Trial], case: str, watch: Watch) -> list[Trial]:
    """Return the trials of a case with what watches it, the wrench of the feet being that of its scenario."""
    asked = case, watch.detector, watch.rule, watch.wait_s
    return [row for row in trials if (row.case, row.detector, row.rule, row.wait_s) == asked]


def in_swing(trials: Sequence[Trial]) -> list[Trial]:
    """Return the walks whose first contact began in mid-swing, where section 5.3 watches a leg."""
    return [row for row in trials if row.in_swing == 1]


def is_early(row: Trial) -> bool:
    """Return whether a robot reacted before it touched anything."""
    return row.reacted_s is not None and (row.contact_s is None or row.reacted_s < row.contact_s)


def place_of(row: Trial) -> ClusterKey:
    """Return the robot and the seed of a walk."""
    return ClusterKey(row.level, row.seed)


def outcome_of(trials: Sequence[Trial], settings: Safety, statistics: Statistics) -> ReactionResult:
    """Return what came of trials; intervals are over robots and walks.

    Impulses lie around two values, those of short contacts and those of a robot that leans on the obstacle, so that
    their mean has the median and the share of large ones beside it. The median has no interval: a few walks of three
    robots do not bound it. What carries a robot has no impulse of a collision.
    """
    # A robot that reacts before it touches anything says nothing about a collision.
    struck = [row for row in trials if row.contact_s is not None and not is_early(row)]
    asked = [row for row in trials if row.detector != NONE]
    watched = [row for row in struck if row.detector != NONE]
    met = [row for row in struck if row.case not in settings.stood_on]
    impulses = [row.impulse_ns for row in met if row.impulse_ns is not None]
    median = statistics_of.median(impulses) if impulses else None
    numbers = {
        FALLS: _share(trials, lambda row: row.fell_s is not None, statistics),
        PEAK: _mean(struck, lambda row: row.first_peak_n, statistics, "N"),
        FIRST: _mean(met, lambda row: row.first_impulse_ns, statistics, "N s"),
        IMPULSE: _mean(met, lambda row: row.impulse_ns, statistics, "N s"),
        MEDIAN: Number(median, unit="N s"),
        HEAVY: _share(met, lambda row: _is_over(row.impulse_ns, settings.heavy_ns), statistics),
        NOTICED: _share(watched, lambda row: row.alarm_s is not None, statistics),
        ALARM: _mean(struck, _delay_ms, statistics, "ms"),
        WITHIN: _share(struck, lambda row: _is_within(row.angle_deg, settings.within_deg), statistics),
        BASE_WITHIN: _share(struck, lambda row: _is_within(row.base_angle_deg, settings.within_deg), statistics),
        EARLY: _share(asked, is_early, statistics),
    }
    return ReactionResult(len(trials), len(struck), numbers)


def walked_of(trials: Sequence[Trial], statistics: Statistics) -> FreeWalks:
    """Return what happened in free walks; intervals are over robots and walks."""
    flags = {
        FALLEN: [row.fell_s is not None for row in trials],
        REACTED: [row.reacted_s is not None for row in trials],
    }
    hours = [row.walked_s / HOUR_S for row in trials]
    places = [place_of(row) for row in trials]
    rates: dict[str, Number] = {}
    for name, own in flags.items():
        counts = [int(flag) for flag in own]
        rates[name] = rate_in(counts, hours, places, statistics)
    means = {
        VELOCITY: _mean(trials, lambda row: MILLI * row.velocity_rmse_m_s, statistics, "mm/s"),
        TRACKING: _mean(trials, lambda row: MILLI * row.tracking_rmse_rad, statistics, "mrad"),
        POWER: _mean(trials, lambda row: row.power_w, statistics, "W"),
    }
    return FreeWalks(sum(hours), {name: sum(own) for name, own in flags.items()}, rates, means)


def _mean(
    trials: Sequence[Trial], value_of: Callable[[Trial], float | None], statistics: Statistics, unit: str
) -> Number:
    """Return the mean over the walks that have a value [unit]."""
    found = [(value, place_of(row)) for row in trials if (value := value_of(row)) is not None]
    return mean_in([value for value, _ in found], [place for _, place in found], statistics, unit)


def _share(trials: Sequence[Trial], is_so: Callable[[Trial], bool | None], statistics: Statistics) -> Number:
    """Return the share of walks of which something holds [-], among those of which it is known."""
    found = [(flag, place_of(row)) for row in trials if (flag := is_so(row)) is not None]
    return share_in([flag for flag, _ in found], [place for _, place in found], statistics)


def _delay_ms(row: Trial) -> float | None:
    return None if row.alarm_s is None or row.contact_s is None else MS * (row.alarm_s - row.contact_s)


def _is_over(impulse_ns: float | None, most_ns: float) -> bool | None:
    return None if impulse_ns is None else impulse_ns > most_ns


def _is_within(angle_deg: float | None, most_deg: float) -> bool | None:
    return None if angle_deg is None else angle_deg <= most_deg


def printed_of(published: PublishedContacts, case: str, measure: str) -> float | None:
    """Return what the paper prints of a case [N], [N s]; None where that is nothing."""
    contact = getattr(published, case, None)
    return None if contact is None else {PEAK: contact.force_n, IMPULSE: contact.momentum_ns}.get(measure)
