"""A robot of a table that moves without walking, `./reproduce motion`: its motion, what its plant hides, its pushes."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from mobnet.formats import base
from mobnet.formats.base import Section


class HiddenBody(Section):
    """How links of the plant differ from those of the table.

    Attributes:
        mass_share: largest share by which the mass of a link differs.
        com_m: largest distance by which its centre of mass is off along each axis [m].
    """

    mass_share: base.Share
    com_m: base.Length


class HiddenJoints(Section):
    """Friction and motors of the plant, which the table does not have; torques are shares of a joint's largest torque.

    Attributes:
        coulomb_share: dry friction of a joint that moves.
        static_share: share of the dry friction that comes on top of it where the joint nearly rests.
        stribeck_rad_s: speed over which that falls by a factor of e [rad/s].
        smoothing_rad_s: sgn(v) is tanh(v / this) [rad/s].
        viscous_share: friction that grows with the speed, at the largest speed of the motion.
        load_share: friction for each torque of the motor.
        constant_share: largest share by which the torque of a motor differs from what it reports.
        torque_noise_share: standard deviation of the reported torque.
    """

    coulomb_share: base.Share
    static_share: base.Share
    stribeck_rad_s: Annotated[base.Positive, Field(le=100)]
    smoothing_rad_s: Annotated[base.Positive, Field(le=1)]
    viscous_share: base.Share
    load_share: base.Share
    constant_share: base.Share
    torque_noise_share: base.Share


class LinkPushes(Section):
    """Forces on links at drawn times, with pauses between them; each is long or short, in a drawn direction.

    Attributes:
        pause_s: time between two pushes, lowest and highest [s].
        short_s: duration of a short one [s].
        long_s: duration of a long one [s].
        ramp_s: over which a force grows and fades [s], at most half its duration.
        torque_share: largest torque that it makes at a joint, as a share of the largest torque of that joint.
        weight_share: a force is no larger than this share of the robot's weight.
    """

    pause_s: base.Range[base.Seconds]
    short_s: base.Range[base.Seconds]
    long_s: base.Range[base.Seconds]
    ramp_s: base.Seconds
    torque_share: base.Range[base.Share]
    weight_share: base.Positive = Field(le=10)


class FreeMotion(Section):
    """A smooth random motion of all joints, the base held in the air.

    Attributes:
        knot_s: time between two points of the curve [s].
        span_share: share of a joint's range, around its middle, in which the points lie.
        speed_share: share of a joint's largest speed that the motion may take, and
        speed_max_rad_s: the largest speed of any joint [rad/s].
        torque_share: share of a motor's largest torque that the motion may take by the table.
        clearance_m: least distance between two shapes of the robot [m].
        tracking_rad_s: corner frequency at which deviations from the motion are controlled [rad/s].
        hold_s: time constant of what holds a floating base, MuJoCo's solref [s].
    """

    knot_s: base.Seconds
    span_share: base.InnerShare
    speed_share: base.InnerShare
    speed_max_rad_s: Annotated[base.Positive, Field(le=100)]
    torque_share: base.InnerShare
    clearance_m: base.Length
    tracking_rad_s: Annotated[base.Positive, Field(le=1000)]
    hold_s: base.Seconds
    body: HiddenBody
    joints: HiddenJoints
    pushes: LinkPushes
