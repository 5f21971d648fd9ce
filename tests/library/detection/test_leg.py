"""The force on a foot explains the torques of the leg, and unit torques are those of the Jacobian."""

import numpy as np
import pinocchio as pin
import pytest

from mobnet.core.errors import ConfigError
from mobnet.detection.leg import ancestors, foot_load, make_leg, sole_height, unit_torques
from mobnet.robot.wrench import feet_torque


def position(robot):
    """Return a position of bent joints, the base turned."""
    q = np.zeros(robot.layout.nq)
    q[2], q[3:7] = 0.9, np.array([0.9, 0.1, -0.2, 0.3]) / np.linalg.norm([0.9, 0.1, -0.2, 0.3])
    q[7:] = np.random.default_rng(3).uniform(-0.5, 0.5, robot.layout.nu)
    return q


@pytest.mark.parametrize(("limb", "side"), [("LL", "left"), ("RL", "right")])
def test_the_force_on_the_foot_is_found_again(robot, nominal, limb, side):
    q, leg = position(robot), make_leg(robot, limb)
    wrench = np.array([20.0, -5.0, 60.0, 1.0, -2.0, 0.5])  # foot axes, about the sensor
    tau = feet_torque(nominal, q, {side: wrench})[robot.layout.columns(robot.layout.limb(limb))]
    assert foot_load(leg, q, tau)
    np.testing.assert_allclose(leg.load[:3], leg.pose.rotation[leg.foot] @ wrench[:3], rtol=1e-6)


def test_unit_torques_are_those_of_the_jacobian_of_the_point(robot, nominal):
    q, leg, points = position(robot), make_leg(robot, "LL"), ["left_knee_front", "left_ankle_side", "left_foot_front"]
    found = unit_torques(robot, leg, q, points, -1.0)
    model, data = nominal.model, nominal.model.createData()
    pin.forwardKinematics(model, data, nominal.positions(q[None])[0])
    columns = robot.layout.columns(robot.layout.limb("LL"))
    for row, name in zip(found, points, strict=True):
        point = next(point for point in robot.points if point.name == name)
        body = [body.name for body in robot.bodies].index(point.body)
        axes = leg.pose.rotation[body]
        place = leg.pose.position[body] + axes @ np.array(point.pos)
        force = -axes[:, 0] if name.endswith("front") else -axes[:, 1]
        joint = model.getJointId(robot.joint_of(point.body).id if robot.joint_of(point.body) else "LL6")
        jacobian = pin.computeJointJacobian(model, data, nominal.positions(q[None])[0], joint)
        origin = data.oMi[joint]
        world = origin.toActionMatrix() @ jacobian  # about the world's origin
        expected = world[:3].T @ force + world[3:].T @ np.cross(place, force)
        np.testing.assert_allclose(row, expected[columns], atol=1e-6)


def test_a_point_does_not_load_the_joints_below_it(robot):
    found = unit_torques(robot, make_leg(robot, "LL"), position(robot), ["left_knee_side", "left_ankle_front"], -1.0)
    assert not found[:, 4:].any()
    assert found[:, :4].any(axis=0).all()


def test_left_and_right_are_mirror_images(robot):
    q = np.zeros(robot.layout.nq)
    q[3] = 1.0
    left = unit_torques(robot, make_leg(robot, "LL"), q, ["left_foot_side", "left_foot_front"], -1.0)
    right = unit_torques(robot, make_leg(robot, "RL"), q, ["right_foot_side", "right_foot_front"], 1.0)
    np.testing.assert_allclose(np.abs(left), np.abs(right), atol=1e-9)


def test_what_is_no_leg_or_no_point_is_told(robot):
    with pytest.raises(ConfigError, match=r"leg of 6 joints: 'W' is not accepted; accepted: .*LL.*RL"):
        make_leg(robot, "W")
    with pytest.raises(ConfigError, match="point of the robot: 'left_nose'"):
        unit_torques(robot, make_leg(robot, "LL"), position(robot), ["left_nose"], -1.0)
    assert 0 in ancestors(make_leg(robot, "LL").tree, 5)


def test_the_sole_is_as_high_above_the_other_one_as_its_lowest_corner(robot):
    q, leg = np.zeros(robot.layout.nq), make_leg(robot, "LL")
    q[3], tilt = 1.0, 0.2
    assert foot_load(leg, q, np.zeros(6)) is False  # straight knees
    assert sole_height(leg) == pytest.approx(0.0, abs=1e-12)
    q[7 + robot.layout.actuated.index("LL5")] = tilt  # the ankle's pitch joint: the toes go down
    foot_load(leg, q, np.zeros(6))
    toes, below = robot.sole.box_centre[0] + robot.sole.box_half[0], -robot.sole.height
    assert sole_height(leg) == pytest.approx(below - below * np.cos(tilt) - toes * np.sin(tilt))
