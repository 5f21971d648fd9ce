"""Detection of collisions with a swinging leg, section 5.3: filters, gate, thresholds and detectors."""

from typing import Annotated

from pydantic import AfterValidator, Field

from mobnet.formats import base
from mobnet.formats.base import Section
from mobnet.kernel.detecting import Signal as Signal


class SwingGate(Section):
    """When a leg is watched; `method` is the one whose estimate tells of an early contact with the ground."""

    method: base.MethodName
    lift_off_s: base.NotNegative = Field(le=1)
    landing_s: base.NotNegative = Field(le=1)
    contact_landing_s: base.NotNegative = Field(le=1)
    contact_height_m: base.NotNegative = Field(le=1)
    contact_n: base.Newton
    contact_deg: base.Real = Field(gt=0, le=90)
    contact_s: base.Real = Field(ge=0.001, le=1)


class Thresholds(Section):
    """How thresholds follow from walks that nothing pushes: by the paper's rule, and for rates of false alarms."""

    margin: base.Real = Field(ge=1, le=10)
    normal_walk_s: base.Real = Field(ge=10, le=3600)
    scale_quantile: base.InnerShare
    command_quantile: base.InnerShare
    tail_share: base.Real = Field(ge=0.01, le=0.5)
    on_average: base.Flag
    least_swings: base.Whole = Field(ge=20, le=100_000)
    resamples: base.Whole = Field(ge=50, le=100_000)
    confidence: base.Real = Field(ge=0.5, lt=1)
    rates_per_h: Annotated[dict[base.LowerName, base.Positive], Field(min_length=1)]


class Sensitivity(Section):
    """For which collisions `./reproduce calibrate` tells the smallest force that is found."""

    contact_s: base.Real = Field(ge=0.001, le=1)
    poses: base.Whole = Field(ge=1, le=100_000)
    share: base.InnerShare


class CurveGrid(Section):
    """Multiples of the thresholds at which curves have points, on a log scale between two ends."""

    factors: base.Span[base.Positive]
    count: base.Whole = Field(ge=2, le=1000)


class DetectorSettings(Section):
    """A detector: signals of a method's estimate, each with a threshold of its own, or with `norm` one of all.

    Thresholds follow the phase of the swing in so many `phases`, and where it is `commanded` what the robot is told.
    """

    method: base.MethodName
    signals: Annotated[base.Some[Signal], AfterValidator(base.distinct)]
    norm: base.Flag = False
    phases: base.Whole = Field(default=1, ge=1, le=100)
    commanded: base.Flag = False


class Detection(Section):
    """Detectors, how they are calibrated, and the walks on which they are tried."""

    low_pass_hz: base.LowPassHz
    hold_s: base.Real = Field(ge=0.001, le=1)
    window_s: base.Real = Field(ge=0.01, le=60)
    gate: SwingGate
    thresholds: Thresholds
    collisions: base.PushedName
    sweep: base.PushedName
    place: base.QuietName
    random: base.QuietName
    calibration_share: base.InnerShare
    late_s: base.NotNegative = Field(le=1)
    onset_n: base.Newton
    levels: base.Distinct[base.LevelName]
    legs: base.Distinct[base.LegName]
    curve: CurveGrid
    sensitivity: Sensitivity
    detectors: Annotated[dict[base.RowName, DetectorSettings], Field(min_length=1)]


class ContactPoint(Section):
    """Where on a limb a contact is sought, and what is known of its force and of the torques' errors.

    docs/notes/contact.md has the reasons.

    Points of the surface are `spacing_m` apart, and the place follows from the likeliest `candidates` of them. Forces
    have the size `force_n`, and their part along the surface is at most `friction` times that into it. Errors of this
    size are added to the standard deviations of torques: `error_nm`, of V1..V3 `error_n`. The wrench of the ground on a
    foot that stands is of any size up to about `ground_n` and `ground_nm`.
    """

    spacing_m: base.Real = Field(ge=0.002, le=0.1)
    candidates: base.Whole = Field(ge=1, le=2000)
    force_n: base.Positive = Field(le=5000)
    friction: base.Real = Field(ge=0.01, le=2)
    error_nm: base.NotNegative = Field(le=200)
    error_n: base.NotNegative = Field(le=1000)
    ground_n: base.Positive = Field(le=100_000)
    ground_nm: base.Positive = Field(le=100_000)
