"""Rows of the files of a robot's detectors on walks with collisions: what is pushed, and what each detector finds."""

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from mobnet.core.detections import CALIBRATION, HELD_OUT, LARGEST, WALKING, FreeSwing, Promise, Threshold


@dataclass(frozen=True)
class Collision:
    """A push of a leg in a recording, counted from 1; times are from the beginning of the recording.

    `onset_s` is when its force first exceeds that of `detection.onset_n`, None if it never does; `force_n` its largest
    force [N], `impulse_ns` its impulse [N s]; `swing_share` is the share of the swing at which it begins [-].
    """

    scenario: str
    seed: int
    number: int
    push: str
    leg: str
    link: str
    direction: str
    start_s: float
    onset_s: float | None
    end_s: float
    force_n: float
    impulse_ns: float
    swing_share: float


@dataclass(frozen=True)
class Detected:
    """What a detector says of a collision.

    `ratio` is its largest signal over the threshold, `delay_s` the time from the collision's start to the alarm, None
    if there is none, `perfect_s` that of an estimate without error at the same thresholds; `link` and `direction` are
    those that it names, `named_n` the force [N], and `signal` is what crosses first.
    """

    scenario: str
    seed: int
    leg: str
    number: int
    detector: str
    kind: str
    ratio: float
    delay_s: float | None
    perfect_s: float | None
    signal: str
    link: str
    direction: str
    named_n: float | None


@dataclass(frozen=True)
class CurvePoint:
    """Collisions that a detector finds at a multiple of its thresholds, and the sum of their delays [s]."""

    detector: str
    leg: str
    factor: float
    found: int
    collisions: int
    delay_sum_s: float


UNNAMED = ("signal", "link", "direction")  # texts that are empty where a detector finds nothing
UNPUSHED = "unpushed"  # part of a free swing between the collisions of a walk
PARTS = (CALIBRATION, HELD_OUT, UNPUSHED)
READINGS = {WALKING: "random walking", LARGEST: "in place"}  # what the paper's "normal walking" may be -> as text
FILES: Mapping[str, type[Any]] = {  # name of a file of detectors -> its rows
    "collisions": Collision,
    "thresholds": Threshold,
    "promises": Promise,
    "detected": Detected,
    "swings": FreeSwing,
    "curves": CurvePoint,
}


def columns_of(name: str) -> tuple[str, ...]:
    """Return the columns of a file of detectors."""
    return tuple(field.name for field in fields(FILES[name]))
