"""When a hint is given; section `robotlog` of a configuration says what each number means."""

from dataclasses import dataclass


@dataclass(frozen=True)
class HintBounds:
    """Sizes from which something looks wrong with a log.

    Attributes:
        gap_intervals: a pause of more than so many sample intervals ends a segment.
        jitter: standard deviation of the intervals over their median, above which the clock is named.
        window_s: length of the stretches in which momentum and torque are compared [s].
        windows: how many of them.
        least_torque: a joint whose motor gives less than this share of its largest torque tells nothing of it.
        suspect: share of a joint's torque that the motion does not explain, as squares, from which it is looked at.
        small: the same where only another side of gravity and a wrong torque constant are looked for.
        few: so many such joints are tried with each other, and so many tell of a delay.
        explained: one mistake is named if it takes this share of the square error away.
        good: after which the error is below this share of the torque, both as squares.
        floor: shares of square torque that a mistake leaves are alike below this one.
        number: how much each number that is chosen counts against a change.
        close: of two changes that differ by less in their sums both are told.
        offset: largest offset of a motor's torque that is no mistake, as a share of its largest torque.
        factor: known factors between two units are recognised within this share.
        clipped: share of the samples at a torque's own largest value above which it is called clipped.
        held: share of samples that repeat the one before while a joint moves, above which it is called stale.
        delay_s: largest delay that is looked for [s].
        gravity: share of gravity by which a resting accelerometer may differ.
        weight: share of the robot's weight by which the feet's mean vertical force may differ.
    """

    gap_intervals: float
    jitter: float
    window_s: float
    windows: int
    least_torque: float
    suspect: float
    small: float
    few: int
    explained: float
    good: float
    floor: float
    number: float
    close: float
    offset: float
    factor: float
    clipped: float
    held: float
    delay_s: float
    gravity: float
    weight: float
