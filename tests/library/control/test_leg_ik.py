"""Leg kinematics: inverse of the forward kinematics, in and out of reach."""

import numpy as np
import pytest

from mobnet.control.kinematics import update
from mobnet.control.leg_ik import leg_ik
from mobnet.control.steps import SIDES

LOW = np.array([-0.6, -0.4, -1.2, 0.1, -0.8, -0.4])
HIGH = np.array([0.6, 0.4, 0.6, 2.0, 0.4, 0.4])


@pytest.mark.parametrize("k", [0, 1])
@pytest.mark.parametrize("seed", range(10))
def test_round_trip_through_forward_kinematics(walker, random_pose, seed, k):
    q, v = random_pose(seed)
    expected = np.random.default_rng(seed).uniform(LOW, HIGH)
    span = slice(7 + walker.first[k], 13 + walker.first[k])
    q[span] = expected
    update(walker.tree, q, v, walker.gravity, walker.pose)
    pose, found = walker.pose, np.zeros(6)
    foot = walker.feet[k]
    leg_ik(walker.leg, SIDES[k], pose.rotation[0], q[:3], pose.rotation[foot], pose.position[foot], found)
    np.testing.assert_allclose(found, expected, atol=1e-12)


@pytest.mark.parametrize("roll", [np.pi / 2, -np.pi / 2])
def test_a_leg_straight_to_the_side_has_its_angle(walker, random_pose, roll):
    """Its sine is 1 and a rounding more or less; hip yaw and pitch are not told apart there."""
    span = slice(7 + walker.first[0], 13 + walker.first[0])
    foot, pose, found = walker.feet[0], walker.pose, np.zeros(6)
    for seed in range(50):
        q, v = random_pose(seed)
        q[span] = np.random.default_rng(seed).uniform(LOW, HIGH)
        q[span][1] = roll
        update(walker.tree, q, v, walker.gravity, pose)
        leg_ik(walker.leg, SIDES[0], pose.rotation[0], q[:3], pose.rotation[foot], pose.position[foot], found)
        assert found[1] == pytest.approx(roll, abs=1e-6)


def test_mirrored_pose_gives_mirrored_angles(walker):
    left, right = np.zeros(6), np.zeros(6)
    ankle = np.array([0.15, 0.12, -0.75])
    leg_ik(walker.leg, 1.0, np.eye(3), np.zeros(3), np.eye(3), ankle, left)
    leg_ik(walker.leg, -1.0, np.eye(3), np.zeros(3), np.eye(3), ankle * [1, -1, 1], right)
    np.testing.assert_allclose(right, left * [-1, -1, 1, 1, 1, -1], atol=1e-15)


def test_pose_out_of_reach_is_met_with_a_finite_nearly_straight_leg(walker):
    found = np.zeros(6)
    leg_ik(walker.leg, 1.0, np.eye(3), np.zeros(3), np.eye(3), np.array([0.3, 0.1, -1.5]), found)
    assert np.isfinite(found).all()
    assert 0 < found[3] < np.deg2rad(5)


def test_a_foot_too_near_is_met_with_a_knee_bent_as_far_as_it_goes(walker):
    found = np.zeros(6)
    leg_ik(walker.leg, 1.0, np.eye(3), np.zeros(3), np.eye(3), np.array([0.0, 0.1, -0.3]), found)
    assert np.isfinite(found).all()
    assert found[3] == pytest.approx(np.deg2rad(120))
