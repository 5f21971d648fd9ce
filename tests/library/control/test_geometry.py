"""Time laws and rotations against their closed forms."""

import mujoco
import numpy as np
import pytest

from mobnet.control import geometry

SMALL = 1e-6


def test_quintic_has_zero_slope_and_curvature_at_both_ends():
    assert [geometry.rise(x) for x in (-1.0, 0.0, 0.5, 1.0, 2.0)] == [0.0, 0.0, 0.5, 1.0, 1.0]
    assert [geometry.rise_slope(x) for x in (-1.0, 0.0, 1.0, 2.0)] == [0.0] * 4
    for end in (0.0, 1.0):
        inside = end + SMALL * (1 - 2 * end)
        assert geometry.rise_slope(inside) < 1e-9


@pytest.mark.parametrize("x", np.linspace(0.01, 0.99, 9))
def test_slope_is_the_derivative_of_the_quintic(x):
    assert geometry.rise_slope(x) == pytest.approx(
        (geometry.rise(x + SMALL) - geometry.rise(x - SMALL)) / (2 * SMALL), abs=1e-8
    )


def test_quintic_and_cubic_are_symmetric_about_the_middle():
    for x in np.linspace(0, 1, 11):
        assert geometry.rise(x) + geometry.rise(1 - x) == pytest.approx(1, abs=1e-14)
        assert geometry.smoothstep(x) + geometry.smoothstep(1 - x) == pytest.approx(1, abs=1e-14)
    assert [geometry.smoothstep(x) for x in (-1.0, 0.0, 1.0, 2.0)] == [0.0, 0.0, 1.0, 1.0]


def test_dead_band_is_odd_and_clip_keeps_inside():
    for x in np.linspace(-0.5, 0.5, 11):
        assert geometry.dead(-x, 0.2) == -geometry.dead(x, 0.2)
        assert (
            x - geometry.dead(x, 0.2) == geometry.clip(x, -0.2, 0.2) == pytest.approx(np.clip(x, -0.2, 0.2), abs=1e-15)
        )


@pytest.mark.parametrize("turns", [-3, 0, 2])
def test_wrap_is_invariant_to_whole_turns(turns):
    for angle in (-3.1, 0.0, 1.5, 3.1):
        assert geometry.wrap(angle + 2 * np.pi * turns) == pytest.approx(angle, abs=1e-12)


def test_yaw_frame_round_trip_also_in_place():
    vector = np.array([0.3, -0.7])
    there, back = np.zeros(2), vector.copy()
    geometry.to_yaw_frame(vector, 0.8, there)
    geometry.to_world(there, 0.8, there)
    np.testing.assert_allclose(there, vector, atol=1e-15)
    geometry.to_world(back, np.pi / 2, back)
    np.testing.assert_allclose(back, [0.7, 0.3], atol=1e-15)


def test_rotation_matrices_equal_mujoco_s():
    rng = np.random.default_rng(0)
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    quaternion, expected, ours = np.zeros(4), np.zeros(9), np.zeros((3, 3))
    mujoco.mju_axisAngle2Quat(quaternion, axis, 1.1)
    mujoco.mju_quat2Mat(expected, quaternion)
    geometry.quaternion_to_matrix(quaternion, ours)
    np.testing.assert_allclose(ours.ravel(), expected, atol=1e-14)
    geometry.axis_angle_to_matrix(axis, 1.1, ours)
    np.testing.assert_allclose(ours.ravel(), expected, atol=1e-14)


def test_yaw_pitch_roll_is_the_product_of_three_turns():
    yaw, roll, pitch = 0.4, -0.3, 0.7
    turns = [np.zeros((3, 3)) for _ in range(3)]
    for axis, angle, out in zip(np.eye(3), (roll, pitch, yaw), turns, strict=True):
        geometry.axis_angle_to_matrix(axis, angle, out)
    ours = np.zeros((3, 3))
    geometry.yaw_roll_pitch_matrix(yaw, roll, pitch, ours)
    np.testing.assert_allclose(ours, turns[2] @ turns[1] @ turns[0], atol=1e-15)


def test_products_equal_numpy_s():
    rng = np.random.default_rng(1)
    a, b, force = rng.normal(size=(3, 3))
    m, n = rng.normal(size=(2, 3, 3))
    out, product = np.zeros(3), np.zeros((3, 3))
    geometry.cross(a, b, out)
    np.testing.assert_allclose(out, np.cross(a, b), atol=1e-14)
    geometry.rotate(m, a, out)
    np.testing.assert_allclose(out, m @ a, atol=1e-14)
    geometry.multiply(m, n, product)
    np.testing.assert_allclose(product, m @ n, atol=1e-14)
    assert geometry.triple(a, b, force) == pytest.approx(a @ np.cross(b, force), abs=1e-14)


@pytest.mark.parametrize("seed", range(5))
def test_elimination_solves_what_numpy_solves(seed):
    """numpy is the reference; the first pivot is zero."""
    rng = np.random.default_rng(seed)
    matrix, right = rng.normal(size=(6, 6)), rng.normal(size=6)
    matrix[0, 0] = 0.0  # needs a pivot
    expected = np.linalg.solve(matrix, right)
    assert geometry.solve(matrix, right)
    np.testing.assert_allclose(right, expected, rtol=1e-9)
    assert not geometry.solve(np.ones((3, 3)), np.ones(3))  # singular
