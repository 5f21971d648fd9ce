"""A push is named by the torques that it makes, whatever its size, and forces are those that reach a threshold."""

import numpy as np
import pytest

from mobnet.detection.points import name_push, smallest_forces

UNITS = np.array([[0.5, 0.0, 0.7, 0.0, 0.0, 0.0], [0.4, 0.0, 0.6, 0.3, 0.0, 0.0], [0.0, 0.8, 0.0, 0.0, 0.0, 0.1]])


@pytest.mark.parametrize("candidate", range(len(UNITS)))
def test_each_push_is_named_with_its_force(candidate):
    found = name_push(40.0 * UNITS[candidate], UNITS, np.eye(6))
    assert found.candidate == candidate
    assert found.force_n == pytest.approx(40.0)


def test_joints_that_are_noisy_in_walking_count_less():
    torque = 40.0 * UNITS[1] + np.array([0.0, 0.0, 0.0, -12.0, 0.0, 0.0])  # LL4 hides what tells the two apart
    assert name_push(torque, UNITS, np.eye(6)).candidate == 0
    noisy_hips = np.diag([0.01, 1.0, 0.01, 1.0, 1.0, 1.0])
    assert name_push(40.0 * UNITS[1], UNITS, noisy_hips).candidate == 1


def test_a_push_does_not_pull():
    found = name_push(-40.0 * UNITS[2], UNITS, np.eye(6))
    assert found.force_n == 0.0


def test_the_smallest_force_is_that_of_the_joint_that_is_over_first():
    thresholds = np.array([10.0, 8.0, 7.0, 3.0, 1.0, 2.0])
    np.testing.assert_allclose(smallest_forces(UNITS, thresholds, 0.5), [20.0, 20.0, 20.0])
