"""Trials of reactions, read and summarised: falls, forces, delays, directions, and reactions to nothing."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from mobnet.core.reactions import NONE, Trial
from mobnet.core.rows import read_rows, refuse_rows
from mobnet.evaluation.measure.detection.results import MS, mean_of, share_of
from mobnet.evaluation.measure.estimates.changed import HOUR_S
from mobnet.evaluation.number.number import Number
from mobnet.plan.reactions import Reactions
from mobnet.settings.published import PublishedContacts
from mobnet.settings.reaction import Watch
from mobnet.settings.runs import Statistics

FALLS, PEAK, FIRST, IMPULSE, ALARM, WITHIN, BASE_WITHIN, EARLY = (
    "falls", "first_peak", "first_impulse", "impulse", "alarm", "within", "base_within", "early",
)  # fmt: skip
# case, detector, rule, time that a reaction waits [s], wrench of the feet, share of feed-forward
Group = tuple[str, str, str, float, str, float]
MILLI = 1e3  # mm in a metre, mrad in a radian
FALLEN, REACTED = "falls", "false reactions"
VELOCITY, TRACKING, POWER = "error of the base's velocity", "error of the swing leg", "power"


@dataclass(frozen=True)
class Outcome:
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
class Walked:
    """What happened in free walks.

    Attributes:
        hours: that the robots walked as they were told [h].
        events: falls, and reactions to nothing, by name.
        means: of the walks: error of the base's velocity [mm/s], error of the joints of the leg that swings from their
            references [mrad], mechanical power of the motors [W], by name.
    """

    hours: float
    events: Mapping[str, int]
    means: Mapping[str, Number]


def read_trials(reactions: Reactions, cases: Sequence[str]) -> list[Trial]:
    """Return the trials of all robots in some cases."""
    return [row for case in cases for files in reactions.values() for row in read_file(files[case])]


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


def is_early(row: Trial) -> bool:
    """Return whether a robot reacted before it touched anything."""
    return row.reacted_s is not None and (row.contact_s is None or row.reacted_s < row.contact_s)


def outcome_of(trials: Sequence[Trial], within_deg: float, statistics: Statistics) -> Outcome:
    """Return what came of trials; directions are right within an angle [deg]."""
    struck = [row for row in trials if row.contact_s is not None and not is_early(row)]
    delays = [
        MS * (row.alarm_s - row.contact_s) for row in struck if row.alarm_s is not None and row.contact_s is not None
    ]
    forces = {PEAK: "first_peak_n", FIRST: "first_impulse_ns", IMPULSE: "impulse_ns"}
    units = {PEAK: "N", FIRST: "N s", IMPULSE: "N s"}
    means = {
        name: mean_of([getattr(row, column) for row in struck], statistics, units[name])
        for name, column in forces.items()
    }
    numbers = {
        FALLS: share_of([row.fell_s is not None for row in trials], statistics),
        **means,
        ALARM: mean_of(delays, statistics, "ms"),
        WITHIN: share_of(_within([row.angle_deg for row in struck], within_deg), statistics),
        BASE_WITHIN: share_of(_within([row.base_angle_deg for row in struck], within_deg), statistics),
        EARLY: share_of([is_early(row) for row in trials if row.detector != NONE], statistics),
    }
    return Outcome(len(trials), len(struck), numbers)


def walked_of(trials: Sequence[Trial], statistics: Statistics) -> Walked:
    """Return what happened in free walks."""
    events = {
        FALLEN: sum(row.fell_s is not None for row in trials),
        REACTED: sum(row.reacted_s is not None for row in trials),
    }
    values = {
        VELOCITY: ([MILLI * row.velocity_rmse_m_s for row in trials], "mm/s"),
        TRACKING: ([MILLI * row.tracking_rmse_rad for row in trials], "mrad"),
        POWER: ([row.power_w for row in trials], "W"),
    }
    means = {name: mean_of(own, statistics, unit) for name, (own, unit) in values.items()}
    return Walked(sum(row.walked_s for row in trials) / HOUR_S, events, means)


def _within(angles: Sequence[float | None], most: float) -> list[bool]:
    """Return of each angle that there is whether it is at most so large [deg]."""
    return [angle <= most for angle in angles if angle is not None]


def printed_of(published: PublishedContacts, case: str, measure: str) -> float | None:
    """Return what the paper prints of a case [N], [N s]; None where that is nothing."""
    contact = getattr(published, case, None)
    return None if contact is None else {PEAK: contact.force_n, IMPULSE: contact.momentum_ns}.get(measure)
