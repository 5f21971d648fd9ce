"""A robot's table as values, and what a robot that walks must have."""

from dataclasses import replace

import pytest

from mobnet.core.errors import ConfigError
from mobnet.robot.description import RobotDescription, for_walking


def test_joints_stand_in_motor_order(robot: RobotDescription) -> None:
    assert tuple(joint.id for joint in robot.joints) == robot.layout.actuated
    assert robot.torque_limits.shape == robot.armature.shape == (robot.layout.nu,)


def test_left_and_right_weigh_the_same(robot: RobotDescription) -> None:
    mass = {body.name: body.mass for body in robot.bodies}
    assert all(mass[name] == mass[name.replace("L_", "R_", 1)] for name in mass if name.startswith("L_"))


def test_unknown_foot_is_named(robot: RobotDescription) -> None:
    with pytest.raises(ConfigError, match="'middle' is not accepted; accepted: left, right"):
        robot.foot("middle")


def test_an_arm_has_no_feet_sensors_or_posture(arm: RobotDescription) -> None:
    assert (arm.floating, arm.base, arm.mass) == (False, "wall", 10.0)
    assert not any((arm.feet, arm.hands, arm.leg, arm.imu, arm.posture.joints, arm.shapes, arm.points))


def test_walking_names_all_that_a_table_lacks(robot: RobotDescription, arm: RobotDescription) -> None:
    needs = (
        "a floating base, feet on both sides, leg geometry .*, hands on both sides, an inertial sensor .*, a posture"
    )
    with pytest.raises(ConfigError, match=f"^robot two-link arm cannot walk; its table lacks: {needs}"):
        for_walking(arm)
    short = {**robot.layout.groups, "LL": robot.layout.groups["LL"][:5]}
    with pytest.raises(ConfigError, match="lacks: legs of 6 joints, legs that come first in `order`"):
        for_walking(replace(robot, layout=replace(robot.layout, groups=short)))
    with pytest.raises(ConfigError, match=r"lacks: an inertial sensor .`imu`.$"):
        for_walking(replace(robot, imu=None))
