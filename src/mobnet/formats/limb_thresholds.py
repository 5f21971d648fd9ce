"""The thresholds of one limb, which `./reproduce calibrate --out FILE` writes and `detect` and `export` read."""

from typing import Annotated, Literal

from pydantic import Field

from mobnet.formats.base import (
    Distinct,
    GainHz,
    LowPassHz,
    NotNegative,
    PartName,
    Positive,
    RateHz,
    Section,
    Share,
    Some,
    Text,
    Threshold,
    TorqueKind,
)
from mobnet.kernel.detecting import Signal


class LimbThresholds(Section):
    """Thresholds of a limb's joints, what they were made with, and the false alarms to expect.

    Attributes:
        robot: name of its table.
        limb: limb of the robot.
        joints: names of its joints, (n,).
        method: whose estimate is watched: that of the observer alone, or with a network.
        network: fingerprint of the network, as its run.json has it; none of the observer alone.
        signal: what is watched of each joint: `mean`, the external torque [N m], `std`, its standard deviation
            [N m], or `ratio`, the first over the second [-].
        thresholds: of each joint (n,) [N m], of a ratio [-].
        watched: when: in the `swing` of a leg (`detection.gate`), or `always`.
        settle_s: time after the start of the estimate in which nothing is watched, as observer and network start from
            zero [s].
        low_pass_hz: cut-off frequency of the first-order low-pass of every signal [Hz].
        hold_s: time for which a signal must lie above its threshold [s].
        rate_hz: samples per second of the estimate [Hz].
        gain_hz: gain K_0 of the observer [1/s].
        torque: whether the log's torques are samples at the ticks or means over the intervals before them.
        drives: digest of the friction and the rotors that the observer knew; none of a table without friction.
        rate_per_h: false alarms that were wanted [1/h].
        expected_per_h, low_per_h, high_per_h: those to expect, and the interval of this number [1/h].
        confidence: nominal one of the interval.
    """

    robot: Text
    limb: Text
    joints: Distinct[PartName]
    method: Literal["MOB", "MOB-Net"]
    network: Text | None = None
    signal: Signal
    thresholds: Some[Threshold]
    watched: Literal["always", "swing"]
    settle_s: Annotated[NotNegative, Field(le=60)] = 0.0
    low_pass_hz: LowPassHz
    hold_s: Annotated[NotNegative, Field(le=1)]
    rate_hz: RateHz
    gain_hz: GainHz
    torque: TorqueKind
    drives: Text | None = None
    rate_per_h: Positive
    expected_per_h: NotNegative
    low_per_h: NotNegative
    high_per_h: NotNegative
    confidence: Share
