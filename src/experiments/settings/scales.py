"""Sizes of the tests and of the trainings."""

from typing import Annotated

from pydantic import Field

from mobnet.formats.base import (
    Count,
    LowerName,
    NotNegative,
    Positive,
    Rising,
    ScenarioName,
    Section,
    Seeds,
    Share,
    SweepName,
    Whole,
)
from mobnet.settings.data import Recordings, RecordingSeconds, TestRecordings


class Length(Section):
    """How long networks are trained; an epoch is all training samples or `epoch_samples` of them."""

    epochs: Whole = Field(ge=1, le=1000)
    epoch_samples: Annotated[Count, Field(le=100_000_000)] | None = None


class Experiment(Length):
    """How long and how often networks are trained."""

    seeds: Seeds


class RobotLength(Length):
    """The same on a robot of the fleet, which trains one network with a seed of its own, or one with each of these."""

    seeds: Seeds | None = None


class ReactionSizes(Section):
    """How often a robot walks, and for how long.

    Attributes:
        runs: number of walks with our detector.
        compared: number of walks with each other detector.
        longest_s: time after which a walk ends at the latest.
    """

    runs: Annotated[Count, Field(le=10_000)]
    compared: Annotated[Count, Field(le=10_000)]
    longest_s: Annotated[Positive, Field(ge=1, le=600)]


class Reactions(Section):
    """Walks into something or with a push, in each case, and walks that nothing stands in the way of.

    `cases` has other sizes of single cases, by name.
    """

    pushed: ReactionSizes
    free: ReactionSizes
    cases: dict[LowerName, ReactionSizes] = {}


class Scale(Section):
    """One size of every test and of every training; the last five replace numbers of other sections.

    `decides` says that the claims are judged by it: some outcome of its walks must then meet the bounds of each.

    `durations_s` gives the duration [s] of tests whose recordings are longer or shorter than the others; `robots` has
    the experiments that take another length on the robots of the fleet or more than one network of each, `fleet` how
    many of these robots there are, the first ones, `fleet_whole` how many of them, again the first ones, walk more than
    the tests of a leg, and `fleet_shards` how many recordings of each test each of them makes; all of them, and as many
    as elsewhere, without these. `sweeps` has the values of a sweep that are tried, where not all of them are.
    """

    decides: bool
    test: TestRecordings
    durations_s: dict[ScenarioName, RecordingSeconds] = {}
    development: Recordings
    experiments: dict[LowerName, Experiment] = Field(min_length=1)
    robots: dict[LowerName, RobotLength] = {}
    sweeps: dict[SweepName, Rising[Count]] = {}
    fleet: Annotated[Count, Field(le=100)] | None = None
    fleet_whole: Annotated[Count, Field(le=100)] | None = None
    fleet_shards: Annotated[Count, Field(le=100)] | None = None
    reactions: Reactions
    least_swings: Annotated[Count, Field(le=100_000)] | None = None
    batch_size: Annotated[Count, Field(le=4096)] | None = None
    stream_s: Annotated[Positive, Field(ge=0.05, le=600)] | None = None
    rate_decay_share: Share | None = None
    figure_start_s: Annotated[NotNegative, Field(le=3600)] | None = None
