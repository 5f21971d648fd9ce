"""What must hold between rates, robot and walking controller."""

from collections.abc import Iterator
from itertools import chain
from math import isclose

from experiments.settings.settings import Settings
from mobnet.core.errors import misfit
from mobnet.formats.faults import as_many, at_least, at_most, below, within
from mobnet.formats.reading import Problem

LEG_JOINTS = 6
WALKS = "a floating base, two feet with six joints each, first in `order`, leg, hands, imu, posture of all other joints"
SOLREF_STEPS = 2  # MuJoCo: the time constant of a contact is at least two steps


def walking_problems(settings: Settings) -> Iterator[Problem]:
    """Yield what does not fit between rates, robot and controller."""
    yield from _rate_problems(settings)
    yield from _controller_problems(settings)
    yield from _robot_problems(settings)
    if settings.robot.sole and settings.robot.leg and "left" in settings.robot.feet:
        yield from _body_problems(settings)
        yield from _leg_problems(settings)


def _robot_problems(settings: Settings) -> Iterator[Problem]:
    """Yield what walking takes and the robot's table lacks."""
    robot = settings.robot
    legs = [robot.groups[robot.feet[side].limb] for side in ("left", "right") if side in robot.feet]
    above = robot.order.actuated[sum(map(len, legs)) :]
    joints = set(chain.from_iterable(robot.groups[limb] for limb in robot.posture))
    needed = {
        "base": robot.base == "floating", "feet": len(legs) == 2 and all(len(leg) == LEG_JOINTS for leg in legs),
        "order": [*robot.order.actuated[: len(sum(legs, ()))]] == [*sum(legs, ())], "leg": robot.leg,
        "hands": len(robot.hands) == 2, "imu": robot.imu, "posture": joints == set(above),
    }  # fmt: skip
    for key, there in needed.items():
        if not there:
            yield ("robot", key), misfit(f"`{key}` of a robot that cannot walk", WALKS)


def is_whole(value: float) -> bool:
    """Return whether a number is whole, up to rounding, and at least 1."""
    return round(value) >= 1 and isclose(value, round(value), rel_tol=1e-9)


def _rate_problems(settings: Settings) -> Iterator[Problem]:
    """Yield rates that do not divide each other, durations of no whole number of samples, and filters too fast."""
    rates = settings.rates
    recording = settings.recording
    plant = settings.plant
    if not is_whole(rates.plant_hz / rates.data_hz):
        yield ("rates", "plant_hz"), misfit(rates.plant_hz, f"a whole multiple of data_hz, {rates.data_hz}")
    if not is_whole(rates.data_hz / recording.clearance_hz):
        text = misfit(recording.clearance_hz, f"data_hz, {rates.data_hz}, divided by a whole number")
        yield ("recording", "clearance_hz"), text
    for name in ("chunk_s", "episode_s", "settle_s", "dropped_before_fall_s"):
        value = getattr(recording, name)
        if value and not is_whole(value * rates.data_hz):
            yield ("recording", name), misfit(value, f"a whole number of samples at {rates.data_hz} Hz")
    least = SOLREF_STEPS / rates.plant_hz
    most = rates.data_hz / 2
    place = ("plant", "loss_time_constant_s")
    yield from at_least(place, plant.loss_time_constant_s, least, "two steps of the plant")
    yield from at_most(("observer", "gain_hz"), settings.observer.gain_hz, most, "half of data_hz")
    for name in ("chunk_s", "dropped_before_fall_s"):
        yield from below(("recording", name), getattr(recording, name), recording.episode_s, "episode_s")


def _controller_problems(settings: Settings) -> Iterator[Problem]:
    """Yield numbers of the controller that stand in the wrong order."""
    walking = settings.walking
    shortest = min(settings.commands.duration_s)
    slow = max(settings.commands.duration_s)
    limits = {
        "step_min_s": shortest, "double_support_share": walking.swing_xy_share, "swing_apex": walking.swing_level_share,
        "late_max_s": walking.step_min_s, "early_max_s": walking.step_min_s, "timing_freeze_s": walking.step_min_s,
        "timing_soonest_s": walking.step_min_s, "foothold_freeze_s": walking.step_min_s, "step_shorter_max_s": slow,
        "step_longer_max_s": slow, "com_height_min_m": walking.pelvis_height_m,
        "stumble_sunk_m": walking.pelvis_height_m - settings.recording.fall_height_m,
        "timing_band_m": walking.timing_ankle_m, "ankle_leak_hz": walking.ankle_integral_hz,
    }  # fmt: skip
    for name, most in limits.items():
        if getattr(walking, name) > most:
            yield ("walking", name), misfit(getattr(walking, name), f"at most {most:g}")
    yield from below(("walking", "swing_apex"), walking.swing_apex, walking.swing_xy_share, "swing_xy_share")
    yield from within(("walking", "foot_spacing_m"), walking.foot_spacing_m, walking.foothold_y_m, "foothold_y_m")
    sideways = walking.foothold_y_m[1] - walking.foot_spacing_m
    for name, reach in (("step_x_m", walking.foothold_x_max_m), ("step_y_m", sideways)):
        for index, value in enumerate(getattr(settings.commands, name)):
            yield from within(("commands", name, index), value, (-reach, reach), "where a foot may stand")
    fallen = settings.recording.fall_height_m
    most = walking.pelvis_height_m
    yield from below(("recording", "fall_height_m"), fallen, most, "walking.pelvis_height_m")


def _body_problems(settings: Settings) -> Iterator[Problem]:
    """Yield numbers of the controller that do not fit legs, soles and motors of the robot."""
    walking = settings.walking
    robot = settings.robot
    sole = robot.sole
    assert sole is not None
    joints = robot.groups[robot.feet["left"].limb]
    for name in ("leg_stiffness_nm_rad", "leg_damping_nms_rad"):
        yield from as_many(("walking", name), len(getattr(walking, name)), len(joints), "one for each joint of a leg")
    (middle, *_) = sole.box_centre
    half = sole.box_half
    for index, value in enumerate(walking.sole_x_m):
        ends = middle - half[0], middle + half[0]
        yield from within(("walking", "sole_x_m", index), value, ends, "the robot's sole")
    for index, value in enumerate(walking.stand_shift_m):
        ends = -half[index], half[index]
        yield from within(("walking", "stand_shift_m", index), value, ends, "half the robot's sole")
    yield from at_most(("walking", "sole_y_m"), walking.sole_y_m, half[1], "half the robot's sole")
    nearest = walking.foothold_y_m[0]
    width = 2 * half[1]
    yield from at_least(("walking", "foothold_y_m", 0), nearest, width, "the width of the robot's sole")


def _leg_problems(settings: Settings) -> Iterator[Problem]:
    """Yield numbers of the controller that legs, weight or motors of the robot do not allow."""
    walking = settings.walking
    robot = settings.robot
    sole = robot.sole
    leg = robot.leg
    assert sole is not None
    assert leg is not None
    joints = robot.groups[robot.feet["left"].limb]
    reach = 2 * leg.link_length
    longest = reach - sole.height - leg.hip_pos[2]
    yield from below(("walking", "pelvis_height_m"), walking.pelvis_height_m, longest, "of stretched legs")
    yield from below(("walking", "leg_reach_m"), walking.leg_reach_m, reach, "of stretched legs")
    weight = sum(body.mass for body in robot.bodies) * settings.plant.gravity_m_s2
    yield from below(("walking", "touch_force_n"), walking.touch_force_n, weight / 2, "half the weight")
    place = ("walking", "joint_speed_max_rad_s")
    fastest = walking.joint_speed_max_rad_s
    slowest = min(joint.velocity_limit for joint in robot.joints if joint.id in joints)
    yield from at_most(place, fastest, slowest, "the velocity limit of a leg's joint")
