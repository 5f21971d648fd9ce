"""Feet and hands stand where the geometry of the robot puts them."""

import numpy as np
import pytest

from mobnet.core.joints import NQ_BASE
from mobnet.evaluation.measure.steps import ankle_places
from mobnet.evaluation.measure.upper_body import hand_speeds
from mobnet.robot.description import RobotDescription
from mobnet.robot.nominal import NominalModel

LEG_M = 0.7  # thigh and shank


def posture(robot: RobotDescription, **angles: float) -> np.ndarray:
    """Return generalized positions (1, nq) with some joints turned."""
    q = np.zeros((1, robot.layout.nq))
    q[0, 3] = 1.0
    for joint, angle in angles.items():
        q[0, NQ_BASE + robot.layout.actuated.index(joint)] = angle
    return q


def test_a_straight_leg_has_the_closed_form_of_a_circle_about_the_hip(nominal: NominalModel) -> None:
    rest = ankle_places(nominal, posture(nominal.robot))[0][0]
    pitched = ankle_places(nominal, posture(nominal.robot, LL3=0.3))[0][0]
    np.testing.assert_allclose(pitched[0] - rest[0], [-LEG_M * np.sin(0.3), 0, LEG_M * (1 - np.cos(0.3))], atol=1e-12)
    rolled = ankle_places(nominal, posture(nominal.robot, RL2=-0.2))[0][0]
    np.testing.assert_allclose(rolled[1] - rest[1], [0, -LEG_M * np.sin(0.2), LEG_M * (1 - np.cos(0.2))], atol=1e-12)
    np.testing.assert_allclose(rolled[0], rest[0], atol=1e-12)


def test_the_hips_yaw_is_the_feets_yaw(nominal: NominalModel) -> None:
    yaw = ankle_places(nominal, posture(nominal.robot, LL1=0.25, RL1=-0.4))[1][0]
    np.testing.assert_allclose(yaw, [0.25, -0.4], atol=1e-12)


def test_hand_speed_is_that_of_finite_differences_and_invariant_to_the_base(nominal: NominalModel) -> None:
    robot, rng, step = nominal.robot, np.random.default_rng(3), 1e-6
    q, v = posture(robot), rng.normal(size=(1, robot.layout.nv))
    q[0, NQ_BASE:] = rng.uniform(-0.5, 0.5, robot.layout.nu)
    speed = hand_speeds(nominal, q, v)
    moved = q.copy()
    moved[0, NQ_BASE:] += step * v[0, 6:]
    for k, side in enumerate(("left", "right")):
        places = [_hand(nominal, posture_, f"{side}_hand") for posture_ in (q, moved)]
        assert speed[0, k] == pytest.approx(np.linalg.norm(places[1] - places[0]) / step, rel=1e-4)
    v[0, :6] += 5.0
    np.testing.assert_array_equal(hand_speeds(nominal, q, v), speed)


def _hand(nominal: NominalModel, q: np.ndarray, name: str) -> np.ndarray:
    """Return a hand's place by chaining the table's own transforms, without Pinocchio."""
    robot = nominal.robot
    point = next(point for point in robot.points if point.name == name)
    bodies = {body.name: body for body in robot.bodies}
    place, body = np.asarray(point.pos), bodies[point.body]
    while body.name != robot.base:
        joint = robot.joint_of(body.name)
        if joint is not None:
            angle = q[0, NQ_BASE + robot.layout.actuated.index(joint.id)]
            place = _turn(np.array([np.cos(angle / 2), *(np.sin(angle / 2) * joint.axis)])) @ place
        place = _turn(body.quat) @ place + body.pos
        body = bodies[body.parent]
    return place


def _turn(quat: np.ndarray) -> np.ndarray:
    """Return the rotation of a unit quaternion w x y z by Rodrigues' formula."""
    axis = np.array([[0, -quat[3], quat[2]], [quat[3], 0, -quat[1]], [-quat[2], quat[1], 0]])
    return np.eye(3) + 2 * quat[0] * axis + 2 * axis @ axis
