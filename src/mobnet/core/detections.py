"""Rows of the files of a detector's thresholds, and of the swings that calibrate them."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Threshold:
    """The threshold of a signal of a detector, in a phase of the swing, counted from 1; `kind` says by which rule."""

    detector: str
    leg: str
    kind: str
    signal: str
    phase: int
    value: float
    unit: str


@dataclass(frozen=True)
class Promise:
    """The rate of false alarms [1/h] that a detector's thresholds should have, with its interval.

    `swings` in `hours` of walking calibrated them; `factor` is the multiple of the signals' scales.
    """

    detector: str
    leg: str
    kind: str
    swings: int
    hours: float
    factor: float
    rate_per_h: float
    low: float
    high: float


@dataclass(frozen=True)
class FreeSwing:
    """A swing that nothing pushes: the largest signal over the threshold for one false alarm an hour, and the paper's.

    `ratio_largest` is over those of walking in place, `ratio_walking` over those of random walking. `part` says whether
    it calibrated the detector, was held out, or lies between the collisions of a walk.
    """

    detector: str
    leg: str
    scenario: str
    part: str
    terrain: str
    seed: int
    number: int
    ratio: float
    ratio_largest: float
    ratio_walking: float


CALIBRATION, HELD_OUT = "calibration", "held out"  # values of `part`
# Values of `kind`: by the paper's rule from walking in place and from random walking, and for one false alarm an hour.
LARGEST, WALKING, COLLISION = "largest", "walking", "collision"
