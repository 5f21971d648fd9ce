"""A robot's table as values: unit quaternions, mirror images, a posture in motor order, and what walking takes."""

from dataclasses import replace

import numpy as np
import pytest

from mobnet.core.errors import ConfigError
from mobnet.formats.parts import PointRow, ShapeRow
from mobnet.robot.description import MIRROR_Y, describe, for_walking, with_mirrored

HAND = PointRow(name="left_hand", body="L_Wrist2_Link", pos=(0.1, 0.2, 0.3))
HEAD = PointRow(name="head", body="Head_Link")
SEGMENT = (0.1, 0.2, 0.3, -0.4, 0.5, 0.6)
ARM = ShapeRow(name="left_arm", body="L_Arm_Link", type="capsule", size=(0.1,), segment=SEGMENT, tone="light")


def test_joints_stand_in_motor_order(robot):
    assert tuple(joint.id for joint in robot.joints) == robot.layout.actuated
    assert robot.torque_limits.shape == robot.armature.shape == (robot.layout.nu,)


def test_left_and_right_weigh_the_same_and_look_the_same(robot):
    mass = {body.name: body.mass for body in robot.bodies}
    assert all(mass[name] == mass[name.replace("L_", "R_", 1)] for name in mass if name.startswith("L_"))
    shapes = {shape.name: shape for shape in robot.shapes}
    for left in (shape for name, shape in shapes.items() if name.startswith("left_")):
        right = shapes[left.name.replace("left_", "right_", 1)]
        assert right.size == left.size
        np.testing.assert_allclose(right.pos, left.pos * MIRROR_Y)


def test_right_side_is_the_mirror_image_of_the_left_and_the_middle_has_none():
    """Left and right are symmetric in y; mirroring twice is the identity."""
    left, right, middle = with_mirrored([HAND, HEAD])
    assert (left, middle) == (HAND, HEAD)
    assert (right.name, right.body, right.pos) == ("right_hand", "R_Wrist2_Link", (0.1, -0.2, 0.3))
    _, right = with_mirrored([ARM])
    assert right.segment == (0.1, -0.2, 0.3, -0.4, -0.5, 0.6)
    assert with_mirrored([right.model_copy(update={"name": "left_arm"})])[1].segment == SEGMENT


def test_quaternions_are_brought_to_unit_length(robot_table):
    off = robot_table.bodies[0].model_copy(update={"quat": (0.0, 0.0, 0.600001, 0.8)})
    body = describe(robot_table.model_copy(update={"bodies": (off, *robot_table.bodies[1:])})).bodies[0]
    assert np.linalg.norm(body.quat) == pytest.approx(1, abs=1e-15)


def test_posture_stands_in_motor_order_whatever_the_order_of_the_limbs(robot):
    posture = robot.posture
    assert posture.joints == robot.layout.actuated[12:]
    here = [posture.joints.index(name) for name in robot.layout.limb("LA")]
    np.testing.assert_array_equal(posture.angle[here], [0.3, 0.3, 1.5, -1.27, -1.0, 0.0, -1.0, 0.0])
    np.testing.assert_array_equal(posture.damping[here][:2], [10.0, 20.0])


def test_an_arm_has_no_feet_sensors_or_posture(arm):
    assert (arm.floating, arm.base, arm.mass) == (False, "wall", 10.0)
    assert not any((arm.feet, arm.sole, arm.hands, arm.leg, arm.imu, arm.posture.joints, arm.shapes, arm.points))


def test_walking_names_all_that_a_table_lacks(robot, arm):
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
