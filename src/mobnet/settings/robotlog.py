"""How a robot's log becomes a recording, when a hint says that something is wrong with it, and what is learned."""

from typing import Annotated

from pydantic import Field

from mobnet.formats.base import (
    Count,
    Flag,
    InnerShare,
    NetworkName,
    Positive,
    Rising,
    Seconds,
    Section,
    Share,
)


class LogLearning(Section):
    """How a network learns from a log of one's own, `./reproduce learn`, and when the log suffices.

    Attributes:
        cell: network of configs/networks.yaml whose cell a limb takes that has none there.
        epochs: number of epochs.
        epoch_samples: samples of an epoch, which goes through the log as often as that takes.
        updates: least number of updates of an epoch; of a log that is shorter fewer lanes learn at once.
        held_out: share of the log, its end, on which the network is tried and that it never sees.
        margin: share of an input's range in training by which it may lie outside.
        outside: share of the samples held out with an input further outside above which the log does not suffice.
        worse: the same for the error on what is held out over that on as long a part that trained it.
        rises: the same for the validation loss (22) of the last epoch less that of the one kept.
        sigma: the same for the share of the errors within sigma, by which it differs from that of a Gaussian.
    """

    cell: NetworkName
    epochs: Count
    epoch_samples: Count
    updates: Count
    held_out: Annotated[InnerShare, Field(ge=0.02, le=0.5)]
    margin: Share
    outside: InnerShare
    worse: Annotated[Positive, Field(ge=1)]
    rises: Positive
    sigma: InnerShare


class WrenchEstimate(Section):
    """How an external wrench follows from torques of joints (docs/notes/contact.md).

    Attributes:
        torque_error: error of an external torque without a standard deviation, as a share of its motor's largest one.
        force_n, moment_nm: a force and a moment that are large, beside which others are small [N], [N m].
        told: share of a component that comes from the torques, below which it counts as not told.
    """

    torque_error: InnerShare
    force_n: Annotated[Positive, Field(ge=10, le=1e5)]
    moment_nm: Annotated[Positive, Field(ge=1, le=1e4)]
    told: InnerShare


class Identification(Section):
    """How a log becomes a joint's numbers.

    Attributes:
        low_pass_hz: corner of the low-pass without delay behind which everything is fitted [Hz].
        window_s: length of the windows, one of which at a time is left out for the intervals [s].
        least_windows: fewest windows with which anything is identified.
        held_out: share of the windows, the last ones of each log, on which the fit is tried that does not know them.
        folds: parts of the other windows, each of which is held out once to choose the smooth sign of a joint.
        smoothing_rad_s: widths of the smooth sign of which a joint takes the best [rad/s].
        breakaway_rad: angles of Dahl's law, the same [rad].
        gain: share by which Dahl's law must lower the error on the parts held out.
        mass_share: standard deviation of the share by which a link's mass and inertia differ from those of the table.
        com_m: the same of its centre of mass, along each axis [m].
        payload_kg_m3: density of a payload, which is taken for a ball [kg/m^3].
        least_speed_rad_s: root mean square speed below which a joint did not move [rad/s].
        confidence: nominal one of the intervals.
    """

    low_pass_hz: Annotated[Positive, Field(le=1000)]
    window_s: Seconds
    least_windows: Annotated[Count, Field(ge=10)]
    held_out: Annotated[InnerShare, Field(le=0.5)]
    folds: Annotated[Count, Field(ge=2, le=50)]
    smoothing_rad_s: Rising[Annotated[Positive, Field(ge=1e-4, le=20)]]
    breakaway_rad: Rising[Annotated[Positive, Field(ge=1e-5, le=1)]]
    gain: InnerShare
    mass_share: InnerShare
    com_m: Annotated[Positive, Field(le=1)]
    payload_kg_m3: Annotated[Positive, Field(ge=10, le=30_000)]
    least_speed_rad_s: Positive
    confidence: InnerShare


class RobotLog(Section):
    """How a log becomes a recording, and when a hint is given; hints are no errors.

    Attributes:
        gap_intervals: a pause of more than so many sample intervals ends a segment.
        backward: share of the times of a table that may not be after the one before.
        ticks: samples of the recording for each one of the log, above which it is refused.
        jitter: standard deviation of the intervals over their median, above which the clock is named.
        even: the same, below which samples are taken as they are, without interpolation.
        apart_s: difference between stamps and times of recording from which clocks count as apart [s].
        window_s: length of the stretches in which momentum and torque are compared [s].
        windows: how many of them.
        least_torque: a joint whose motor gives less than this share of its largest torque tells nothing of it.
        suspect: share of a joint's torque that the motion does not explain, as squares, from which it is looked at.
        small: the same where only another side of gravity and a wrong torque constant are looked for.
        few: so many such joints are tried with each other, and so many tell of a delay.
        explained: one mistake is named if it takes this share of the square error away.
        good: after which the error is below this share of the torque, both as squares.
        floor: shares of square torque that a mistake leaves are alike below this one.
        number: how much each number that is chosen counts against a change, beside the sum of the logarithms of what it
            leaves.
        close: of two changes that differ by less in that sum both are told.
        offset: largest offset of a motor's torque that is no mistake, as a share of its largest torque.
        factor: known factors between two units are recognised within this share.
        clipped: share of the samples at a torque's own largest value above which it is called clipped.
        held: share of samples that repeat the one before while a joint moves, above which it is called stale.
        delay_s: largest delay that is looked for [s].
        gravity: share of gravity by which a resting accelerometer may differ.
        weight: share of the robot's weight by which the feet's mean vertical force may differ.
        learn: how a network learns from it.
        identify: how friction and rotor inertia are found in it.
        wrench: how an external wrench follows from torques.
        planted: so many pushes at least are planted into logs of free motion, to see which detector finds most.
        settle_s: time after the start of a segment in which a limb without swings is not watched [s].
        flag_gap_s: two stretches above a threshold that are closer are one flag [s].
        percentiles: share of the rates of false alarms of recordings drawn anew that the interval of a limb that is
            watched all the time holds.
        scale_quantile: as that of section `detection`, for `./reproduce calibrate`.
        on_average: the same.
    """

    gap_intervals: Annotated[Positive, Field(ge=1.5, le=1000)]
    backward: InnerShare
    ticks: Annotated[Positive, Field(ge=1, le=1000)]
    jitter: Share
    even: Share
    apart_s: Seconds
    window_s: Seconds
    windows: Annotated[int, Field(ge=20, le=10_000)]
    least_torque: InnerShare
    suspect: InnerShare
    small: InnerShare
    few: Count
    explained: InnerShare
    good: InnerShare
    floor: InnerShare
    number: Positive
    close: Positive
    offset: InnerShare
    factor: InnerShare
    clipped: InnerShare
    held: InnerShare
    delay_s: Seconds
    gravity: InnerShare
    weight: InnerShare
    learn: LogLearning
    identify: Identification
    wrench: WrenchEstimate
    planted: Count
    percentiles: InnerShare
    scale_quantile: InnerShare
    on_average: Flag
    settle_s: Seconds
    flag_gap_s: Seconds
