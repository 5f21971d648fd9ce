"""What the tables and figures of collision detection show, section 5.3: one section for each."""

from typing import Annotated

from pydantic import Field

from experiments.settings.runs import LimbRuns
from mobnet.formats import base
from mobnet.formats.base import Section


class AlarmTable(Section):
    """False alarms of detectors of a leg, by the rules of thresholds for wanted rates and by the paper's.

    `levels` are those at which the detectors are tried.
    """

    levels: base.Distinct[base.WatchedLevelName]
    leg: base.WatchedLegName
    detectors: base.Distinct[base.DetectorName]


class DetectorTable(AlarmTable):
    """Detectors on the collisions of a leg, by a rule of thresholds."""

    kind: base.ThresholdsName


class ReadingTable(AlarmTable):
    """Detectors by several rules of thresholds, such as readings of the paper's; the first one judges its claims."""

    kinds: base.Distinct[base.ThresholdsName]


class FoundByRate(AlarmTable):
    """Collisions that detectors find at each wanted rate of false alarms, the best of them beside another one.

    The same collisions are compared pair by pair with what `reference` finds of them, and found shares at a rate of
    false alarms that is counted, `counted_per_h`.
    """

    beside: base.DetectorName
    reference: base.DetectorName
    counted_per_h: base.Positive


class ThresholdTable(ReadingTable):
    """Thresholds; those of the detector `sized` over the paper's say how large errors are; `ratio` is accepted.

    Robots were sized by its thresholds of the rule `sized_kind`.
    """

    sized_kind: base.ThresholdsName
    sized: base.DetectorName
    ratio: base.Span[base.Positive]


class SmallestForce(DetectorTable):
    """The force that a share of the collisions of each kind must have to be found.

    Laws of the found share have these forces for one half and these steepnesses on a log scale.
    """

    kinds: base.Distinct[base.ThresholdsName]
    share: base.InnerShare
    halves_n: base.Span[base.Positive]
    steepness: base.Span[base.Positive]


class Links(DetectorTable):
    """Which link each collision hit and which one a detector named."""


class Figure13(Section):
    """Snapshots of collisions: the robot's level, the leg, and the cells, `<link> <direction>`."""

    level: base.WatchedLevelName
    leg: base.WatchedLegName
    cells: base.Distinct[base.StruckName]


class Figure14(Section):
    """Histograms of collisions."""

    levels: base.Distinct[base.WatchedLevelName]
    leg: base.WatchedLegName
    bins: base.Whole = Field(ge=2, le=200)


class Figure15(Section):
    """Standard deviations around collisions: of these methods, whose detectors have the thresholds, at one joint."""

    level: base.WatchedLevelName
    leg: base.WatchedLegName
    joint: base.MotorName
    cells: base.Distinct[base.StruckName]
    detectors: dict[base.MethodName, base.DetectorName]
    kind: base.ThresholdsName
    before_s: base.NotNegative = Field(le=10)
    after_s: base.Positive = Field(le=10)


class DetectionCurves(Section):
    """Found share and delay over the rate of false alarms, and the found share over the force."""

    level: base.WatchedLevelName
    leg: base.WatchedLegName
    kind: base.ThresholdsName
    detectors: base.Distinct[base.DetectorName]
    force_bins: base.Whole = Field(ge=2, le=100)


class ContactLine(Section):
    """A line of the table of contact points: torques of a method, or the true ones, and how they are taken.

    `std` are the standard deviations of torques [N m] and of the base's forces [N]; without it, they are those of the
    estimate. With `alone` there are no torques but the leg's, and `after_s` replaces that of the table.
    """

    method: base.MethodName | None = None
    std: tuple[base.NotNegative, base.NotNegative] | None = None
    alone: base.Flag = False
    after_s: base.NotNegative | None = Field(default=None, le=1)


class ContactPoints(LimbRuns):
    """Where collisions of legs meet them: those of at least `least_n`, so long after the alarm of a detector.

    `limbs` are those whose torques are taken; collisions are those of the `legs` among them.
    """

    scenario: base.PushedName
    legs: base.Distinct[base.WatchedLegName]
    detector: base.DetectorName
    kind: base.ThresholdsName
    after_s: base.NotNegative = Field(le=1)
    least_n: base.Newton
    lines: Annotated[dict[base.Text, ContactLine], Field(min_length=1)]
