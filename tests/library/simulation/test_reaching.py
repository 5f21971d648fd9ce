"""Reaching: hands get to targets that can be had, stop before the robot itself, and keep the joints' limits."""

import numpy as np
import pytest

from mobnet.simulation.motion import working_range
from mobnet.simulation.reaching import Reacher, leg_space

KNOTS = 150
ASIDE = np.array([[0.35, 0.45, 0.1], [0.35, -0.45, 0.1]])  # both hands in the chest's frame [m]
INSIDE = np.array([[0.0, 0.0, 0.2], [0.0, 0.0, 0.2]])  # amid the chest
THROUGH = np.array([[0.4, -0.15, 0.1], [0.4, 0.15, 0.1]])  # each where only crossed arms reach
TOLERANCE = 1e-6  # [rad] to which DAQP keeps the limits of one knot's step
KNEES = np.array([[0.25, 0.1, -0.5], [0.25, -0.1, -0.5]])  # where thighs are when knees are lifted


@pytest.fixture
def posture(robot):
    return robot.posture.angle


@pytest.fixture
def reacher(robot, motion, posture):
    return Reacher(robot, motion, working_range(motion), posture)


def knots_to(reacher, hands, posture):
    """Return the knots (T, n) on the way to hands that stand still."""
    return np.array([reacher.step(hands, posture) for _ in range(KNOTS)])


def test_hands_come_to_targets_that_are_free(reacher, posture):
    before = np.linalg.norm(reacher.hand_positions() - ASIDE, axis=1)
    knots_to(reacher, ASIDE, posture)
    assert before.min() > 0.25
    assert np.linalg.norm(reacher.hand_positions() - ASIDE, axis=1).max() < 0.02


@pytest.mark.parametrize("hands", [INSIDE, THROUGH, KNEES], ids=["chest", "each other", "knees"])
def test_hands_stop_before_the_robot(reacher, posture, motion, hands):
    nearest, _ = reacher.look(knots_to(reacher, hands, posture))
    assert motion.clearance_m - 0.015 < nearest.min() < motion.clearance_m + 0.01


def test_joints_keep_their_limits(reacher, posture, motion, robot):
    limits = working_range(motion)
    knots = np.concatenate([knots_to(reacher, hands, posture) for hands in (-2 * ASIDE, 3 * ASIDE, INSIDE)])
    assert (knots >= limits[:, 0] - TOLERANCE).all()
    assert (knots <= limits[:, 1] + TOLERANCE).all()
    limit = motion.speed_share * np.array([joint.velocity_limit for joint in robot.joints[-knots.shape[1] :]])
    speed = np.abs(np.diff(knots, axis=0)).max(axis=0) * motion.knot_hz
    assert (speed <= limit + TOLERANCE * motion.knot_hz).all()
    assert (speed / limit).max() == pytest.approx(1.0, abs=0.01)


def test_a_mirrored_target_gives_a_mirrored_motion(robot, motion, posture):
    """Left hand aside and right hand down, and the other way round."""
    hands = np.array([[0.35, 0.45, 0.1], [0.1, -0.4, -0.2]])
    ends = []
    for target in (hands, hands[::-1] * [1, -1, 1]):
        ends.append(knots_to(Reacher(robot, motion, working_range(motion), posture), target, posture)[-1])
    left, right, waist = slice(3, 11), slice(13, 21), slice(0, 3)
    np.testing.assert_allclose(ends[0][left], -ends[1][right], atol=1e-4)
    np.testing.assert_allclose(ends[0][waist], ends[1][waist] * [-1, 1, -1], atol=1e-4)


def test_the_space_of_the_legs_holds_lifted_knees(robot):
    """A thigh raised to the horizontal has its knee one link before the hip, on both sides."""
    capsules = leg_space(robot, [[0.0, 0.0, -np.pi / 2, 0.0]])
    for side in (1.0, -1.0):
        knee = np.multiply(robot.leg.hip_pos, [1, side, 1]) + [robot.leg.link_length, 0, 0]
        middles = [(ends[:3] + ends[3:]) / 2 for ends, _ in capsules]
        assert min(np.linalg.norm(middle - knee) for middle in middles) < 1e-9
