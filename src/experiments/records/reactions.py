"""Rows of the files of a robot's reactions: walks into obstacles, or without one (sections 5.4 and 7)."""

from dataclasses import dataclass, fields


@dataclass(frozen=True)
class Trial:
    """A walk, into an obstacle or free, with a detector and a reaction or without.

    Times are from the beginning of the walk [s]; None is what did not happen.

    Attributes:
        case: what is walked, a key of `reaction.cases`.
        level: the robot.
        seed: of the walk.
        detector: the detector, `none` where the robot does not react.
        rule: of its thresholds.
        wait_s: time that the reaction waits after an alarm [s].
        wrench: of the feet that the controller gets, `sensed` or `estimated`.
        feed_forward: share of the learned uncertainty torque that motors of the leg that swings make up for.
        walked_s: time that the robot walks as told, watched: until it reacts, is pushed or falls, or to the end.
        velocity_rmse_m_s: error of the base's velocity in this time [m/s], the root of the sum of its three squares.
        tracking_rmse_rad: error of the joints of the leg that swings from their references in this time [rad].
        power_w: mean of the sum of `|motor torque x joint velocity|` in this time [W].
        contact_s: first contact with the obstacle.
        in_swing: 1 if it began in mid-swing, where section 5.3 watches the leg in front of the obstacle, else 0; None
            without a contact, or where the obstacle is in front of no leg.
        alarm_s: the alarm.
        limb: the limb that was watched.
        reacted_s: the reaction.
        angle_deg: angle between the direction of the reaction and the force of the obstacle until then, horizontal.
        base_angle_deg: the same of the unexpected force on the base, (24).
        first_peak_n: largest force of the first contact [N].
        first_impulse_ns: its impulse [N s].
        peak_n: largest force [N].
        impulse_ns: impulse of all contacts [N s].
        contacts: number of contacts.
        fell_s: the fall.
        stopped: 1 if the robot stands at the end.
    """

    case: str
    level: str
    seed: int
    detector: str
    rule: str
    wait_s: float
    wrench: str
    feed_forward: float
    walked_s: float
    velocity_rmse_m_s: float
    tracking_rmse_rad: float
    power_w: float
    contact_s: float | None
    in_swing: int | None
    alarm_s: float | None
    limb: str
    reacted_s: float | None
    angle_deg: float | None
    base_angle_deg: float | None
    first_peak_n: float | None
    first_impulse_ns: float | None
    peak_n: float | None
    impulse_ns: float | None
    contacts: int
    fell_s: float | None
    stopped: int


TRIALS = tuple(field.name for field in fields(Trial))
NONE, FORCE_SENSORS = "none", "force sensors"  # detectors of a robot that does not react, or by its feet's sensors
