"""Numbers and words of detectors and networks: programs write them down, and sections of a configuration give them."""

from dataclasses import dataclass
from typing import Literal

Signal = Literal["mean", "std", "ratio"]
Target = Literal["uncertainty", "external"]  # the torque that a network learns
Strategy = Literal["compliant", "rewind"]  # of stepping: along the force, or back


@dataclass(frozen=True)
class GateNumbers:
    """When a leg is watched: in its swing, away from both ends of it, until it meets the ground too early.

    Attributes:
        lift_off_s: time after lift-off at which the gate opens [s].
        landing_s: time before the planned landing at which it closes [s].
        contact_landing_s: time before the planned landing from which on an early contact may come [s].
        contact_height_m: height of the sole above the other one up to which it may [m].
        contact_n: force on the foot above which it is a contact [N].
        contact_deg: largest angle of this force to the vertical [deg].
        contact_s: time for which it lasts without a gap [s].
    """

    lift_off_s: float
    landing_s: float
    contact_landing_s: float
    contact_height_m: float
    contact_n: float
    contact_deg: float
    contact_s: float


@dataclass(frozen=True)
class TailNumbers:
    """How thresholds for a rate of false alarms follow from the largest values of swings or windows.

    Attributes:
        tail_share: share of them, the largest ones, to which a law is fitted [-].
        on_average: whether thresholds have the rate on the average over recordings like the one that makes them.
        least_swings: least number of swings.
        resamples: number of recordings that are drawn anew for the interval of the rate.
        confidence: of this interval [-].
    """

    tail_share: float
    on_average: bool
    least_swings: int
    resamples: int
    confidence: float


@dataclass(frozen=True)
class WatchedSignals:
    """What a detector watches of an estimate, each signal with a threshold of its own.

    Attributes:
        signals: of each joint: the external torque, its standard deviation, or the first over the second.
        norm: whether the length of all signals together has one threshold.
        phases: number of equal parts of a swing with thresholds of their own.
        commanded: whether thresholds follow what the robot is told to do.
    """

    signals: tuple[Signal, ...]
    norm: bool = False
    phases: int = 1
    commanded: bool = False


@dataclass(frozen=True)
class ContactNumbers:
    """Where on a limb a contact is sought, and what is known of its force and of the torques' errors.

    Attributes:
        spacing_m: distance of the points of the surface [m].
        candidates: number of the likeliest points of which the place follows.
        force_n: size of forces [N].
        friction: largest part of a force along the surface over that into it [-].
        error_nm: error of torques that is added to their standard deviations [N m].
        error_n: the same of the forces V1 to V3 on a floating base [N].
        ground_n: size of the ground's force on a foot that stands [N].
        ground_nm: size of the ground's moment [N m].
    """

    spacing_m: float
    candidates: int
    force_n: float
    friction: float
    error_nm: float
    error_n: float
    ground_n: float
    ground_nm: float
