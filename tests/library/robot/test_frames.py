"""The one conversion, and both models put the base the same way round."""

import mujoco
import numpy as np
import pinocchio as pin

from mobnet.core.arrays import rotation
from mobnet.robot.frames import to_pinocchio


def test_the_quaternion_s_real_part_goes_last_over_a_batch(random_state):
    q = np.stack([random_state(seed)[0] for seed in range(4)])
    order = [0, 1, 2, 4, 5, 6, 3, *range(7, q.shape[1])]
    np.testing.assert_allclose(to_pinocchio(q), q[:, order], atol=1e-15)
    longer = q * np.where(np.isin(np.arange(q.shape[1]), range(3, 7)), 1.01, 1.0)
    before = longer.copy()
    np.testing.assert_allclose(to_pinocchio(longer), to_pinocchio(q), atol=1e-15, err_msg="not of unit length")
    np.testing.assert_array_equal(longer, before, err_msg="the argument is not left alone")


def test_rotation_matches_both_libraries(nominal, random_state):
    q, _ = random_state(1)
    matrix = np.empty(9)
    mujoco.mju_quat2Mat(matrix, q[3:7])
    pin.forwardKinematics(nominal.model, nominal.data, to_pinocchio(q))
    np.testing.assert_allclose(rotation(q[3:7]), matrix.reshape(3, 3), atol=1e-14)
    np.testing.assert_allclose(rotation(q[3:7]), nominal.data.oMi[2].rotation, atol=1e-14)


def test_rotation_of_a_batch_is_orthonormal(random_state):
    quats = np.stack([random_state(seed)[0][3:7] for seed in range(5)])
    matrices = rotation(quats)
    identity = np.broadcast_to(np.eye(3), matrices.shape)
    np.testing.assert_allclose(matrices @ matrices.transpose(0, 2, 1), identity, atol=1e-14)


def test_rotation_of_one_sample_is_to_the_bit_that_of_a_batch():
    quats = np.random.default_rng(0).normal(size=(500, 4))
    for exact in (quats, quats.astype(np.float32)):
        matrices = rotation(exact)
        for quat, matrix in zip(exact, matrices, strict=True):
            np.testing.assert_array_equal(rotation(quat), matrix)
